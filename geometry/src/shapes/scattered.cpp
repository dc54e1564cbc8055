/// Many outlines in every layer: islands and cut-out letters.

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "shapes/random.hpp"
#include "shapes/shapes.hpp"
#include "shapes/stacked.hpp"

namespace routebench::shapes {
namespace {

constexpr double kArcMm = 0.8;

/// A regular polygon, or with `notch` below 1 a star.
Ring star(Point2 centre, double radius, int corners, double notch, double turn) {
  Ring ring;
  for (int i = 0; i < 2 * corners; ++i) {
    if (notch >= 1 && i % 2 == 1) continue;
    const double angle = turn + std::numbers::pi * i / corners;
    const double r = i % 2 == 1 ? radius * notch : radius;
    ring.push_back({centre.x + r * std::cos(angle), centre.y + r * std::sin(angle)});
  }
  return ring;
}

/// Lines of a sign, each from one of six points to another: a grid of two columns and three rows,
/// with a middle point.
///
///     0---1      8 is the middle of 2-3, as 9 is of 0-1 and 10 of 4-5
///     |\|/|
///     2-8-3
///     |/|\|
///     4---5
enum Segment : std::uint16_t {
  kTop = 1U << 0U,
  kUpperLeft = 1U << 1U,
  kUpperRight = 1U << 2U,
  kMiddleLeft = 1U << 3U,
  kMiddleRight = 1U << 4U,
  kLowerLeft = 1U << 5U,
  kLowerRight = 1U << 6U,
  kBottom = 1U << 7U,
  kUpperStem = 1U << 8U,
  kLowerStem = 1U << 9U,
  kFallingUpper = 1U << 10U,  ///< from 0 to the middle
  kRisingUpper = 1U << 11U,   ///< from the middle to 1
  kRisingLower = 1U << 12U,   ///< from 4 to the middle
  kFallingLower = 1U << 13U,  ///< from the middle to 5
};

constexpr unsigned kLeft = kUpperLeft | kLowerLeft;
constexpr unsigned kRight = kUpperRight | kLowerRight;
constexpr unsigned kMiddle = kMiddleLeft | kMiddleRight;
constexpr unsigned kStem = kUpperStem | kLowerStem;

/// The segments of a sign; 0 for a blank.
struct Glyph {
  char sign;
  unsigned segments;
};

constexpr std::array<Glyph, 38> kGlyphs{{
    {' ', 0},
    {'-', kMiddle},
    {'0', kTop | kBottom | kLeft | kRight | kRisingUpper | kRisingLower},
    {'1', kRight | kRisingUpper},
    {'2', kTop | kUpperRight | kMiddle | kLowerLeft | kBottom},
    {'3', kTop | kRight | kMiddleRight | kBottom},
    {'4', kUpperLeft | kMiddle | kRight},
    {'5', kTop | kUpperLeft | kMiddle | kLowerRight | kBottom},
    {'6', kTop | kLeft | kMiddle | kLowerRight | kBottom},
    {'7', kTop | kRisingUpper | kLowerStem},
    {'8', kTop | kBottom | kLeft | kRight | kMiddle},
    {'9', kTop | kBottom | kUpperLeft | kRight | kMiddle},
    {'A', kTop | kLeft | kRight | kMiddle},
    {'B', kTop | kBottom | kRight | kMiddleRight | kStem},
    {'C', kTop | kBottom | kLeft},
    {'D', kTop | kBottom | kRight | kStem},
    {'E', kTop | kBottom | kLeft | kMiddle},
    {'F', kTop | kLeft | kMiddle},
    {'G', kTop | kBottom | kLeft | kLowerRight | kMiddleRight},
    {'H', kLeft | kRight | kMiddle},
    {'I', kTop | kBottom | kStem},
    {'J', kBottom | kRight | kLowerLeft},
    {'K', kLeft | kMiddleLeft | kRisingUpper | kFallingLower},
    {'L', kLeft | kBottom},
    {'M', kLeft | kRight | kFallingUpper | kRisingUpper},
    {'N', kLeft | kRight | kFallingUpper | kFallingLower},
    {'O', kTop | kBottom | kLeft | kRight},
    {'P', kTop | kLeft | kUpperRight | kMiddle},
    {'Q', kTop | kBottom | kLeft | kRight | kFallingLower},
    {'R', kTop | kLeft | kUpperRight | kMiddle | kFallingLower},
    {'S', kTop | kBottom | kUpperLeft | kMiddle | kLowerRight},
    {'T', kTop | kStem},
    {'U', kLeft | kRight | kBottom},
    {'V', kLeft | kRisingLower | kRisingUpper},
    {'W', kLeft | kRight | kRisingLower | kFallingLower},
    {'X', kFallingUpper | kRisingUpper | kRisingLower | kFallingLower},
    {'Y', kFallingUpper | kRisingUpper | kLowerStem},
    {'Z', kTop | kBottom | kRisingUpper | kRisingLower},
}};

/// The ends of the segments in a cell one wide and two high, by bit.
constexpr std::array<std::pair<Point2, Point2>, 14> kEnds{{
    {{0, 2}, {1, 2}},
    {{0, 1}, {0, 2}},
    {{1, 1}, {1, 2}},
    {{0, 1}, {0.5, 1}},
    {{0.5, 1}, {1, 1}},
    {{0, 0}, {0, 1}},
    {{1, 0}, {1, 1}},
    {{0, 0}, {1, 0}},
    {{0.5, 1}, {0.5, 2}},
    {{0.5, 0}, {0.5, 1}},
    {{0, 2}, {0.5, 1}},
    {{0.5, 1}, {1, 2}},
    {{0, 0}, {0.5, 1}},
    {{0.5, 1}, {1, 0}},
}};

/// A slot along a segment with pointed ends, short enough to leave bridges between slots: the
/// slanting ones meet the others at a narrow angle.
Ring slot(Point2 from, Point2 to, double half_width) {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  const Point2 along{(to.x - from.x) / length, (to.y - from.y) / length};
  const Point2 left{-along.y * half_width, along.x * half_width};
  const bool slants = from.x != to.x && from.y != to.y;
  const double tip = (slants ? 5 : 2.2) * half_width;
  const double shoulder = tip + half_width;
  const auto at = [&](Point2 end, double distance, double side) {
    return Point2{end.x + along.x * distance + left.x * side,
                  end.y + along.y * distance + left.y * side};
  };
  return {at(from, tip, 0), at(from, shoulder, -1), at(to, -shoulder, -1),
          at(to, -tip, 0),  at(to, -shoulder, 1),   at(from, shoulder, 1)};
}

}  // namespace

/// Pillars of different sections on a square grid, by request on a common plate.
Mesh make_islands(ShapeQuery& query) {
  const int count = query.count("count", 36, 1, 100'000);
  const double pitch = query.mm("pitch", 10, 0.5, 1000);
  const double height = query.mm("height", 10);
  const double plate = query.number("plate", 0, 0, 1000);
  const std::uint64_t seed = query.seed();
  const std::size_t triangles = query.triangles(static_cast<std::size_t>(count) * 40);
  query.finish();
  if (plate >= height) query.refuse("the plate must be lower than the pillars (height)");
  const int columns = static_cast<int>(std::ceil(std::sqrt(count)));
  const int rows = (count + columns - 1) / columns;
  return refined(triangles, kArcMm, [&](double arc) {
    Random random(seed);
    std::vector<Wall> walls;
    if (plate > 0) {
      walls.push_back({rectangle({0, 0}, {columns * pitch, rows * pitch}), 0, plate});
    }
    for (int i = 0; i < count; ++i) {
      const double radius = pitch * random.between(0.2, 0.42);
      const double slack = pitch * 0.45 - radius;
      const Point2 centre{(i % columns + 0.5) * pitch + random.between(-slack, slack),
                          (i / columns + 0.5) * pitch + random.between(-slack, slack)};
      const int corners = 3 + static_cast<int>(random.below(6));
      const double turn = random.between(0, 2 * std::numbers::pi);
      const std::uint64_t kind = random.below(3);
      walls.push_back({kind == 0   ? circle(centre, radius, arc)
                       : kind == 1 ? star(centre, radius, corners, 1, turn)
                                   : star(centre, radius, corners, 0.5, turn),
                       plate, height});
    }
    Mesh mesh = stack(walls);
    if (plate > 0) return mesh;
    double left = mesh.vertices.front().x;
    double front = mesh.vertices.front().y;
    for (const Point3& p : mesh.vertices) {
      left = std::min(left, p.x);
      front = std::min(front, p.y);
    }
    for (Point3& p : mesh.vertices) p = {p.x - left, p.y - front, p.z};
    return mesh;
  });
}

/// A plate with letters cut through, drawn with straight slots that leave bridges.
Mesh make_text(ShapeQuery& query) {
  const std::string text = query.text("text", "ROUTE");
  const double letter = query.mm("letter", 20, 1, 1000);
  const double z = query.mm("z", 2);
  const std::size_t triangles = query.triangles(12);
  query.finish();
  constexpr std::size_t kLongest = 200;
  if (text.size() > kLongest) query.refuse("the text has more than 200 letters");
  const double half = letter / 2;  // a cell is half a letter wide
  const double advance = half * 1.6;
  const double margin = half * 0.6;
  std::vector<Wall> walls{
      {rectangle({0, 0},
                 {2 * margin + advance * static_cast<double>(text.size()) - (advance - half),
                  2 * margin + letter}),
       0, z}};
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char sign = static_cast<char>(std::toupper(static_cast<unsigned char>(text[i])));
    const auto* const glyph = std::find_if(kGlyphs.begin(), kGlyphs.end(),
                                           [&](const Glyph& g) { return g.sign == sign; });
    if (glyph == kGlyphs.end()) query.refuse("the text may have letters A-Z, digits, - and blanks");
    const Point2 at{margin + advance * static_cast<double>(i), margin};
    for (std::size_t bit = 0; bit < kEnds.size(); ++bit) {
      if ((glyph->segments >> bit & 1U) == 0) continue;
      const auto& [from, to] = kEnds[bit];
      walls.push_back({reversed(slot({at.x + from.x * half, at.y + from.y * half},
                                     {at.x + to.x * half, at.y + to.y * half}, letter / 40)),
                       0, z});
    }
  }
  return refined(triangles, kArcMm, [&](double) { return stack(walls); });
}

}  // namespace routebench::shapes
