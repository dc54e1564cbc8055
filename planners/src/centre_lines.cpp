#include "routebench/planning/centre_lines.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "chordal_axis.hpp"
#include "middle_lines.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/simplify.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/planning/walls.hpp"

namespace routebench {
namespace {

constexpr double kWidthRatio = 1.25;  // of the places that one stroke takes
// The same if the stroke, as wide as the narrowest of them, would leave more open than so many of
// its widths squared: there a further stroke costs little.
constexpr double kOpenRatio = 1.07;
constexpr double kOpenShare = 0.25;
constexpr double kStraightMm = 0.002;
constexpr double kTouchMm = 0.004;
// Places just wide enough must leave a core that offsets do not take for noise.
constexpr double kCoreMm = 0.01;
// A part is compact if it is at most so many of the greatest widths long.
constexpr double kCompact = 2;
constexpr int kAxisSteps = 12;  // either way from its centre
constexpr int kHalvings = 8;
// A dot is so much narrower than its place, so that it has a length.
constexpr double kDotShare = 0.8;
constexpr double kDotSamples = 8;

/// The centre of a ring's area and the direction in which it is longest.
void axis_of(const Ring& ring, Point2& centre, Point2& along) {
  const Point2 base = ring.front();
  double area = 0, xx = 0, xy = 0, yy = 0;
  Point2 sum;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    const Point2 a = ring[i] - base, b = ring[i + 1] - base, c = a + b;
    const double part = cross(a, b);
    area += part;
    sum = sum + part / 3 * c;
    xx += part * (a.x * a.x + b.x * b.x + c.x * c.x) / 12;
    xy += part * (a.x * a.y + b.x * b.y + c.x * c.y) / 12;
    yy += part * (a.y * a.y + b.y * b.y + c.y * c.y) / 12;
  }
  const Point2 middle = (1 / area) * sum;
  centre = base + middle;
  xx -= area * middle.x * middle.x;
  xy -= area * middle.x * middle.y;
  yy -= area * middle.y * middle.y;
  const double angle = std::atan2(2 * xy, xx - yy) / 2;
  along = {std::cos(angle), std::sin(angle)};
}

bool encloses(const Ring& ring, Point2 p) {
  bool inside = false;
  Point2 a = ring.back();
  for (const Point2 b : ring) {
    if ((a.y <= p.y) != (b.y <= p.y)) inside ^= (cross(b - a, p - a) > 0) == (b.y > a.y);
    a = b;
  }
  return inside;
}

/// Makes strokes of the middle lines of one polygon.
class StrokeCutter {
 public:
  StrokeCutter(const CentreLineRule& rule, const Room& room, Point2 origin,
               std::vector<Stroke>& strokes)
      : rule_(rule), room_(room), origin_(origin), strokes_(strokes) {}

  void cut(const MiddleLine& line) {
    std::size_t begin = 0;
    for (std::size_t i = 0; i <= line.points.size(); ++i) {
      if (i < line.points.size() && 2 * line.radii_mm[i] >= rule_.min_width_mm) continue;
      if (i > begin) cut_by_width(line, begin, i - 1);
      begin = i + 1;
    }
  }

  /// Lays the largest bead on the long axis of a compact part; false if it is none.
  bool cut_compact(const Polygon& core, double inwards_mm) {
    if (rule_.width != CentreLineWidth::kInscribed || !core.holes.empty()) return false;
    const Box2 box = bounding_box(core);
    const double extent_mm = distance(box.lower, box.upper) + 2 * inwards_mm;
    if (extent_mm > kCompact * rule_.max_width_mm) return false;
    Point2 centre, along;
    axis_of(core.outer, centre, along);
    if (!encloses(core.outer, centre)) return false;
    MiddleLine line;
    line.free_front = line.free_back = true;
    for (int i = -kAxisSteps; i <= kAxisSteps; ++i) {
      const Point2 p = centre + (extent_mm / 2 * i / kAxisSteps) * along;
      if (!encloses(core.outer, p)) {
        if (i > 0) break;
        line.points.clear();
        line.radii_mm.clear();
        continue;
      }
      line.points.push_back(p);
      line.radii_mm.push_back(width_at(p) / 2);
    }
    if (line.points.size() < 2) return false;
    const std::size_t before = strokes_.size();
    const auto [first, last] = largest_bead(line);
    line.points = {line.points[first], line.points[last]};
    line.radii_mm = {line.radii_mm[first], line.radii_mm[last]};
    cut(line);
    return strokes_.size() > before;
  }

  /// Lays a dot at the place that is farthest from the boundary, if that is wide enough.
  void dot(const Polygon& core, double inwards_mm) {
    const Box2 box = bounding_box(core);
    const double extent_mm = distance(box.lower, box.upper) + 2 * inwards_mm;
    if (extent_mm < rule_.min_dot_mm) return;
    Point2 deepest = core.outer.front();
    double radius_mm = 0;
    for (const ChordalAxis::Chord& chord : chordal_axis(core, extent_mm / kDotSamples).chords) {
      const double mm =
          room_.radius_mm(chord.middle, rule_.max_width_mm).value_or(rule_.max_width_mm);
      if (mm <= radius_mm) continue;
      radius_mm = mm;
      deepest = chord.middle;
    }
    if (2 * radius_mm < rule_.min_dot_mm) return;
    const double width_mm = std::min(2 * kDotShare * radius_mm, rule_.max_width_mm);
    const bool is_level = box.upper.x - box.lower.x >= box.upper.y - box.lower.y;
    // Both ends are inside: a bead has this much room around the place.
    const double half_mm = radius_mm - width_mm / 2;
    const Point2 half = is_level ? Point2{half_mm, 0} : Point2{0, half_mm};
    strokes_.push_back(
        {{snap(deepest - half) + origin_, snap(deepest + half) + origin_}, width_mm});
  }

 private:
  [[nodiscard]] double width_at(const MiddleLine& line, std::size_t i) const {
    return std::min(2 * line.radii_mm[i], rule_.max_width_mm);
  }

  /// Cuts the points first..last, all wide enough, where their width changes.
  void cut_by_width(const MiddleLine& line, std::size_t first, std::size_t last) {
    double length = 0;
    for (std::size_t i = first; i < last; ++i)
      length += distance(line.points[i], line.points[i + 1]);
    // A free end is half a width short of its part's end.
    if (line.free_front && first == 0) length += line.radii_mm[first];
    if (line.free_back && last + 1 == line.points.size()) length += line.radii_mm[last];
    if (length < rule_.min_length_mm) return;
    std::size_t begin = first;
    double least = width_at(line, first), most = least, piece_mm = 0, piece_mm2 = 0;
    for (std::size_t i = first + 1; i <= last; ++i) {
      const double before = width_at(line, i - 1), width = width_at(line, i);
      const double narrow = std::min(least, width), wide = std::max(most, width);
      const double open_mm2 = piece_mm2 - narrow * piece_mm;
      // A piece shorter than half its width is under the round end of its neighbour anyway.
      if ((wide > kWidthRatio * narrow && piece_mm > most / 2) ||
          (wide > kOpenRatio * narrow && open_mm2 > kOpenShare * most * most)) {
        lay(line, begin, i - 1);
        begin = i - 1;
        least = most = before;
        piece_mm = piece_mm2 = 0;
      }
      least = std::min(least, width);
      most = std::max(most, width);
      const double step_mm = distance(line.points[i - 1], line.points[i]);
      piece_mm += step_mm;
      piece_mm2 += step_mm * (before + width) / 2;
    }
    if (begin == first || piece_mm > most / 2) lay(line, begin, last);
  }

  void lay(const MiddleLine& line, std::size_t first, std::size_t last) {
    std::vector<Point2> points(line.points.begin() + static_cast<std::ptrdiff_t>(first),
                               line.points.begin() + static_cast<std::ptrdiff_t>(last) + 1);
    points = simplified(points, kStraightMm);
    Stroke stroke;
    stroke.width_mm = width_of(points);
    if (points.size() >= 2) {
      if (line.free_back && last + 1 == line.points.size()) lengthen(points, stroke.width_mm);
      if (line.free_front && first == 0) {
        std::reverse(points.begin(), points.end());
        lengthen(points, stroke.width_mm);
        std::reverse(points.begin(), points.end());
      }
    }
    for (const Point2 p : points)
      if (const Point2 q = snap(p) + origin_; stroke.points.empty() || stroke.points.back() != q)
        stroke.points.push_back(q);
    if (stroke.points.size() >= 2) strokes_.push_back(std::move(stroke));
  }

  /// The stretch of a line under the largest bead that runs along it. The ends of a compact part
  /// run into corners, and with them the bead would be no wider than those.
  [[nodiscard]] std::pair<std::size_t, std::size_t> largest_bead(const MiddleLine& line) const {
    std::pair<std::size_t, std::size_t> best{0, 0};
    double largest = 0;
    for (std::size_t first = 0; first < line.points.size(); ++first) {
      double width = width_at(line, first), length = 0;
      for (std::size_t last = first + 1; last < line.points.size(); ++last) {
        length += distance(line.points[last - 1], line.points[last]);
        width = std::min(width, width_at(line, last));
        const double area = width * (length + std::numbers::pi / 4 * width);
        if (area <= largest) continue;
        largest = area;
        best = {first, last};
      }
    }
    return best;
  }

  [[nodiscard]] double width_of(const std::vector<Point2>& points) const {
    double least = rule_.max_width_mm, area = 0, length = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
      const double piece = distance(points[i - 1], points[i]);
      const int steps = static_cast<int>(piece / (rule_.max_width_mm / 4)) + 1;
      for (int k = 0; k <= steps; ++k) {
        const double width = width_at(lerp(points[i - 1], points[i], 1.0 * k / steps));
        least = std::min(least, width);
        area += width * piece / (k == 0 || k == steps ? 2 * steps : steps);
      }
      length += piece;
    }
    return rule_.width == CentreLineWidth::kMean && length > 0
               ? std::min(area / length, kWidthRatio * least)
               : least;
  }

  [[nodiscard]] double width_at(Point2 p) const {
    const auto radius_mm = room_.radius_mm(p, rule_.max_width_mm / 2);
    return radius_mm ? 2 * *radius_mm : rule_.max_width_mm;
  }

  /// Moves the last point on, until its bead touches the boundary.
  void lengthen(std::vector<Point2>& points, double width_mm) const {
    const Point2 end = points.back(), before = points[points.size() - 2];
    const double piece_mm = distance(before, end);
    if (piece_mm <= 0) return;
    const Point2 way = (1 / piece_mm) * (end - before);
    const auto fits = [&](double mm) {
      return !room_.radius_mm(end + mm * way, width_mm / 2 - kTouchMm);
    };
    // No step is longer than the place is clear of the boundary.
    double clear = 0, blocked = 0;
    while (clear < rule_.max_width_mm) {
      blocked = clear +
                room_.radius_mm(end + clear * way, rule_.max_width_mm).value_or(rule_.max_width_mm);
      if (!fits(blocked)) break;
      clear = blocked;
    }
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = (clear + blocked) / 2;
      (fits(middle) ? clear : blocked) = middle;
    }
    points.back() = end + clear * way;
  }

  const CentreLineRule& rule_;
  const Room& room_;
  Point2 origin_;
  std::vector<Stroke>& strokes_;
};

/// Smaller parts have no room for any stroke: neither for the shortest and narrowest one nor for
/// the least dot.
double least_area_mm2(const CentreLineRule& rule) {
  const auto disc = [](double width_mm) { return std::numbers::pi / 4 * width_mm * width_mm; };
  const double line = rule.min_width_mm * std::max(rule.min_length_mm - rule.min_width_mm, 0.0) +
                      disc(rule.min_width_mm);
  return std::min(line, disc(rule.min_dot_mm));
}

/// Whether a ring lies between two lines along its longest side that are less than `width_mm`
/// apart.
bool is_flat(const Ring& ring, double width_mm) {
  Point2 along, previous = ring.back();
  for (const Point2 p : ring) {
    const Point2 side = p - std::exchange(previous, p);
    if (dot(side, side) > dot(along, along)) along = side;
  }
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double low = kInfinity, high = -kInfinity;
  for (const Point2 p : ring) {
    low = std::min(low, cross(along, p));
    high = std::max(high, cross(along, p));
  }
  return high - low < width_mm * std::sqrt(dot(along, along));
}

/// Whether it is seen at once that nothing is left of what rings bound if their sides move inwards
/// by these distances.
bool surely_vanish(const std::vector<Ring>& rings, const std::vector<double>& distances_mm) {
  constexpr std::size_t kMostPoints = 16;  // of a ring: larger ones are seldom flat
  for (std::size_t i = 0; i < rings.size(); ++i)
    if (rings[i].size() > kMostPoints) return false;
  for (std::size_t i = 0; i < rings.size(); ++i)
    if (signed_area_mm2(rings[i]) > 0 && !is_flat(rings[i], -2 * distances_mm[i])) return false;
  return true;
}

Point2 lower_corner(const std::vector<Ring>& rings) {
  Point2 lower = rings.front().front();
  for (const Ring& ring : rings)
    for (const Point2 p : ring) lower = {std::min(lower.x, p.x), std::min(lower.y, p.y)};
  return lower;
}

}  // namespace

std::vector<Stroke> centre_lines(const Polygons& thin, const CentreLineRule& rule,
                                 const PlanContext& context) {
  TakenSides sides;
  const double least_mm2 = least_area_mm2(rule);
  for (const Polygon& polygon : thin)
    if (area_mm2(polygon) >= least_mm2)
      for (Ring& ring : rings_of({polygon})) sides.rings.push_back(std::move(ring));
  sides.taken_mm.resize(sides.rings.size());
  return centre_lines(std::move(sides), rule, context);
}

std::vector<Stroke> centre_lines(TakenSides sides, const CentreLineRule& rule,
                                 const PlanContext& context) {
  std::vector<Stroke> strokes;
  if (sides.rings.empty()) return strokes;
  // Relative to a corner, so that the place does not matter.
  const Point2 origin = lower_corner(sides.rings);
  for (Ring& ring : sides.rings)
    for (Point2& p : ring) p = snap(p - origin);
  // The middle lines of what is wide enough are about those of what is left if sides move inwards.
  const double inwards_mm = std::max(rule.min_width_mm / 2 - kCoreMm, 0.0);
  std::vector<double> distances_mm;
  for (const double taken_mm : sides.taken_mm) distances_mm.push_back(-taken_mm - inwards_mm);
  if (surely_vanish(sides.rings, distances_mm)) return strokes;
  const Polygons cores = offset_boundary(sides.rings, distances_mm);
  Rooms rooms(sides, cores.size());
  for (const Polygon& core : cores) {
    stop_if_asked(context);
    const Box2 box = bounding_box(core);
    const double extent_mm = distance(box.lower, box.upper) + 2 * inwards_mm;
    if (extent_mm < std::min(rule.min_length_mm, rule.min_dot_mm)) continue;
    // Beads are as wide as the sides let them be, not those of the core, and may reach beyond it.
    const Point2 beyond{rule.max_width_mm, rule.max_width_mm};
    const Room& room = rooms.around({box.lower - beyond, box.upper + beyond}, rule.max_width_mm);
    StrokeCutter cutter(rule, room, origin, strokes);
    const std::size_t before = strokes.size();
    if (!cutter.cut_compact(core, inwards_mm))
      for (const MiddleLine& line : middle_lines(core, inwards_mm, room, rule.max_width_mm))
        cutter.cut(line);
    if (strokes.size() == before) cutter.dot(core, inwards_mm);
  }
  return strokes;
}

}  // namespace routebench
