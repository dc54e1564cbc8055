#include "middle_lines.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "chordal_axis.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench {
namespace {

// A spur ends in a corner if it and the disc at its end reach no farther than so many radii of the
// disc where it begins: the corner of a rectangle lies 1.41 radii away, one of 45 degrees 2.6.
constexpr double kSpurRadii = 1.7;
constexpr int kPruningRounds = 4;
constexpr double kWiderMm = 0.01;  // less is not wider
// Chords between samples that are no farther apart than the polygon is wide run nearly across.
constexpr double kLeastStepMm = 0.05;
// To look at fewer takes less time than to put them into a grid.
constexpr std::size_t kFewEdges = 64;
constexpr std::size_t kFewParts = 8;
constexpr int kBendSteps = 12;  // in which the way round a bend is sought

/// The axis of one polygon while spurs are taken from it.
class PrunedAxis {
 public:
  PrunedAxis(ChordalAxis axis, const Room& room, double farthest_mm)
      : axis_(std::move(axis)),
        room_(room),
        farthest_mm_(farthest_mm),
        is_left_(axis_.chords.size(), true),
        degree_(axis_.triangles.size()) {
    for (std::size_t i = 0; i < degree_.size(); ++i) degree_[i] = axis_.triangles[i].count;
    for (int round = 0; round < kPruningRounds && prune(); ++round) {
    }
  }

  [[nodiscard]] std::vector<MiddleLine> lines() const {
    std::vector<MiddleLine> lines;
    std::vector<bool> is_open = is_left_;
    for (std::uint32_t triangle = 0; triangle < degree_.size(); ++triangle) {
      if (degree_[triangle] != 1 && degree_[triangle] != 3) continue;
      for (std::uint32_t i = 0; i < axis_.triangles[triangle].count; ++i) {
        const std::uint32_t chord = axis_.triangles[triangle].chords[i];
        if (is_open[chord]) lines.push_back(line_from(triangle, chord, is_open));
      }
    }
    for (std::uint32_t chord = 0; chord < is_open.size(); ++chord)  // loops without ends or forks
      if (is_open[chord])
        lines.push_back(line_from(axis_.chords[chord].triangles[0], chord, is_open));
    return lines;
  }

 private:
  struct Spur {
    std::uint32_t junction;
    double reach_mm;
    std::vector<std::uint32_t> chords;
  };

  [[nodiscard]] double radius_mm(Point2 p) const {
    return room_.radius_mm(p, farthest_mm_).value_or(farthest_mm_);
  }

  [[nodiscard]] std::uint32_t across(std::uint32_t chord, std::uint32_t triangle) const {
    const auto& sides = axis_.chords[chord].triangles;
    return sides[0] == triangle ? sides[1] : sides[0];
  }

  /// The chord of a triangle that is left besides the given one.
  [[nodiscard]] std::uint32_t other_chord(std::uint32_t triangle, std::uint32_t chord) const {
    const ChordalAxis::Triangle& of = axis_.triangles[triangle];
    for (std::uint32_t i = 0; i < of.count; ++i)
      if (of.chords[i] != chord && is_left_[of.chords[i]]) return of.chords[i];
    return chord;
  }

  /// Takes all spurs away that now are too short; true if there was one.
  bool prune() {
    std::vector<Spur> spurs;
    for (std::uint32_t triangle = 0; triangle < degree_.size(); ++triangle)
      if (degree_[triangle] == 1) note_spur(triangle, spurs);
    std::stable_sort(spurs.begin(), spurs.end(), [](const Spur& a, const Spur& b) {
      return a.junction != b.junction ? a.junction < b.junction : a.reach_mm < b.reach_mm;
    });
    bool pruned = false;
    for (std::size_t i = 0; i < spurs.size(); ++i) {
      // Where all three arms are short, the longer two remain as one line.
      if (degree_[spurs[i].junction] < 3 || is_one_of_three(spurs, i)) continue;
      for (const std::uint32_t chord : spurs[i].chords) {
        is_left_[chord] = false;
        for (const std::uint32_t triangle : axis_.chords[chord].triangles) --degree_[triangle];
      }
      pruned = true;
    }
    return pruned;
  }

  static bool is_one_of_three(const std::vector<Spur>& spurs, std::size_t i) {
    const auto same = [&](std::size_t k) {
      return k < spurs.size() && spurs[k].junction == spurs[i].junction;
    };
    const bool second = i >= 1 && same(i - 1) && same(i + 1);
    const bool third = i >= 2 && same(i - 1) && same(i - 2);
    return second || third;
  }

  void note_spur(std::uint32_t triangle, std::vector<Spur>& spurs) const {
    std::uint32_t chord = other_chord(triangle, UINT32_MAX);
    Spur spur{0, radius_mm(axis_.chords[chord].middle), {}};
    while (true) {
      spur.chords.push_back(chord);
      triangle = across(chord, triangle);
      if (degree_[triangle] != 2) break;
      const std::uint32_t next = other_chord(triangle, chord);
      spur.reach_mm += distance(axis_.chords[chord].middle, axis_.chords[next].middle);
      if (spur.reach_mm > kSpurRadii * farthest_mm_) return;
      chord = next;
    }
    if (degree_[triangle] != 3) return;
    const Point2 centre = axis_.triangles[triangle].centre;
    spur.junction = triangle;
    spur.reach_mm += distance(axis_.chords[chord].middle, centre);
    if (spur.reach_mm < kSpurRadii * radius_mm(centre)) spurs.push_back(std::move(spur));
  }

  /// The widest place between the inner side of a bend, from which a spur into the outer corner was
  /// taken, and that spur. Straight from chord to chord a line would come nearer to the inner side
  /// than anywhere else.
  [[nodiscard]] Point2 round_bend(const ChordalAxis::Triangle& bend) const {
    Point2 corner_side;
    for (const std::uint32_t chord : bend.chords)
      if (!is_left_[chord]) corner_side = axis_.chords[chord].middle;
    const Point2 inner_side = 3 * bend.centre - 2 * corner_side;
    Point2 best;
    double widest_mm = -1;
    for (int i = kBendSteps / 2; i <= kBendSteps; ++i) {
      const Point2 p = lerp(inner_side, corner_side, static_cast<double>(i) / kBendSteps);
      const double mm = radius_mm(p);
      if (mm <= widest_mm) break;  // it rises up to the middle
      best = p;
      widest_mm = mm;
    }
    return best;
  }

  MiddleLine line_from(std::uint32_t triangle, std::uint32_t chord,
                       std::vector<bool>& is_open) const {
    MiddleLine line;
    const auto go_to = [&](Point2 p) {
      line.points.push_back(p);
      line.radii_mm.push_back(radius_mm(p));
    };
    line.free_front = degree_[triangle] == 1;
    if (degree_[triangle] == 3) go_to(axis_.triangles[triangle].centre);
    while (true) {
      is_open[chord] = false;
      go_to(axis_.chords[chord].middle);
      triangle = across(chord, triangle);
      if (degree_[triangle] != 2) break;
      if (axis_.triangles[triangle].count == 3) go_to(round_bend(axis_.triangles[triangle]));
      chord = other_chord(triangle, chord);
      if (!is_open[chord]) {  // round a loop
        go_to(axis_.chords[chord].middle);
        return line;
      }
    }
    line.free_back = degree_[triangle] == 1;
    if (degree_[triangle] == 3) go_to(axis_.triangles[triangle].centre);
    return line;
  }

  ChordalAxis axis_;
  const Room& room_;
  double farthest_mm_;
  std::vector<bool> is_left_;          // chords
  std::vector<std::uint32_t> degree_;  // chords left, of a triangle
};

/// Takes the part of a line's free back away that runs on into a corner.
void trim_back(MiddleLine& line) {
  const double tip_mm = line.radii_mm.back();
  double reach_mm = tip_mm, widest_mm = tip_mm;
  std::size_t keep = line.points.size();
  for (std::size_t i = keep - 1; i-- > 0;) {
    reach_mm += distance(line.points[i], line.points[i + 1]);
    if (reach_mm < kSpurRadii * line.radii_mm[i] && line.radii_mm[i] > kWiderMm + widest_mm) {
      keep = i + 1;
      widest_mm = line.radii_mm[i];
    }
    if (reach_mm > kSpurRadii * kSpurRadii * widest_mm) break;
  }
  if (keep < 2) return;
  line.points.resize(keep);
  line.radii_mm.resize(keep);
}

void trim_free_ends(MiddleLine& line) {
  if (line.free_back) trim_back(line);
  if (!line.free_front) return;
  std::reverse(line.points.begin(), line.points.end());
  std::reverse(line.radii_mm.begin(), line.radii_mm.end());
  trim_back(line);
  std::reverse(line.points.begin(), line.points.end());
  std::reverse(line.radii_mm.begin(), line.radii_mm.end());
}

}  // namespace

namespace {

/// The one of sides along which so much is taken.
Room::Side& side_with(double taken_mm, std::vector<Room::Side>& sides) {
  const auto known = std::find_if(sides.begin(), sides.end(), [&](const Room::Side& side) {
    return side.taken_mm == taken_mm;
  });
  return known != sides.end() ? *known : sides.emplace_back(Room::Side{taken_mm, {}, std::nullopt});
}

/// The edges that come near the places.
std::vector<Room::Side> edges_near(const Box2& places, double farthest_mm,
                                   const TakenSides& taken) {
  std::vector<Room::Side> sides;
  for (std::size_t i = 0; i < taken.rings.size(); ++i) {
    Room::Side& side = side_with(taken.taken_mm[i], sides);
    const double reach_mm = taken.taken_mm[i] + farthest_mm;
    const Point2 lower = places.lower - Point2{reach_mm, reach_mm};
    const Point2 upper = places.upper + Point2{reach_mm, reach_mm};
    Point2 a = taken.rings[i].back();
    for (const Point2 b : taken.rings[i]) {
      if (std::max(a.x, b.x) >= lower.x && std::min(a.x, b.x) <= upper.x &&
          std::max(a.y, b.y) >= lower.y && std::min(a.y, b.y) <= upper.y)
        side.edges.emplace_back(a, b);
      a = b;
    }
  }
  return sides;
}

std::vector<Room::Side> in_grids(const TakenSides& taken) {
  std::vector<Room::Side> sides;
  for (const double taken_mm : taken.taken_mm) side_with(taken_mm, sides);
  for (Room::Side& side : sides) {
    Polygons outlines;  // the grid is asked for distances only
    for (std::size_t i = 0; i < taken.rings.size(); ++i)
      if (taken.taken_mm[i] == side.taken_mm) outlines.push_back({taken.rings[i], {}});
    side.grid.emplace(outlines);
  }
  return sides;
}

}  // namespace

Rooms::Rooms(const TakenSides& sides, std::size_t parts)
    : sides_(sides), are_few_(parts <= kFewParts) {}

const Room& Rooms::around(const Box2& places, double farthest_mm) {
  if (are_few_) {
    std::vector<Room::Side> sides = edges_near(places, farthest_mm, sides_);
    const auto is_short = [](const Room::Side& side) { return side.edges.size() <= kFewEdges; };
    if (std::all_of(sides.begin(), sides.end(), is_short)) return near_.emplace(std::move(sides));
  }
  return everywhere_ ? *everywhere_ : everywhere_.emplace(in_grids(sides_));
}

Room::Edge::Edge(Point2 a, Point2 b) : from(a), way(b - a) {
  const double squared = dot(way, way);
  shares_a_mm2 = squared > 0 ? 1 / squared : 0;
}

double Room::Edge::squared_distance(Point2 p) const {
  const Point2 at = p - from;
  const Point2 off = at - std::clamp(dot(at, way) * shares_a_mm2, 0.0, 1.0) * way;
  return dot(off, off);
}

std::optional<double> Room::radius_mm(Point2 p, double limit_mm) const {
  std::optional<double> least;
  for (const Side& side : sides_) {
    const double farthest_mm = least.value_or(limit_mm) + side.taken_mm;
    std::optional<double> mm;
    if (side.grid) {
      mm = side.grid->distance_to_edge_mm(p, farthest_mm);
    } else {
      double squared = std::numeric_limits<double>::infinity();
      for (const Edge& edge : side.edges) squared = std::min(squared, edge.squared_distance(p));
      if (squared <= farthest_mm * farthest_mm) mm = std::sqrt(squared);
    }
    if (mm) least = std::max(*mm - side.taken_mm, 0.0);
  }
  return least;
}

std::vector<MiddleLine> middle_lines(const Polygon& core, double inwards_mm, const Room& room,
                                     double widest_mm) {
  const double mean_width_mm = 2 * (area_mm2(core) / perimeter_mm(core) + inwards_mm);
  const double step_mm =
      std::clamp(mean_width_mm, kLeastStepMm, std::max(kLeastStepMm, widest_mm / 2 - inwards_mm));
  std::vector<MiddleLine> lines = PrunedAxis(chordal_axis(core, step_mm), room, widest_mm).lines();
  for (MiddleLine& line : lines) trim_free_ends(line);
  return lines;
}

}  // namespace routebench
