#include "routebench/planning/hatch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/planning/walls.hpp"

namespace routebench {
namespace {

Point2 unit_vector(double angle_deg) {
  const double quarters = angle_deg / 90;
  if (quarters == std::floor(quarters)) {
    constexpr std::array<Point2, 4> kExact{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    const double turn = quarters - 4 * std::floor(quarters / 4);
    return kExact[static_cast<std::size_t>(turn)];
  }
  const double angle = angle_deg / 180 * std::numbers::pi;
  return {std::cos(angle), std::sin(angle)};
}

// Offsets wave by up to this where their outline is level (see region.hpp).
constexpr double kWaveMm = 0.01;

/// Lowest and highest y of a region in a turned frame.
std::array<double, 2> level_range(const Polygon& region, double angle_deg) {
  const Turn turn(angle_deg);
  double low = turn.to_level(region.outer.front()).y, high = low;
  for (const Point2 p : region.outer) {
    low = std::min(low, turn.to_level(p).y);
    high = std::max(high, turn.to_level(p).y);
  }
  return {low, high};
}

}  // namespace

EvenLines lines_over(const Polygon& region, double angle_deg, double distance_mm) {
  const auto [low, high] = level_range(region, angle_deg);
  const double first = std::ceil(low / distance_mm);
  const double last = std::floor(high / distance_mm);
  return {first * distance_mm, distance_mm, static_cast<std::uint32_t>(last - first + 1)};
}

EvenLines fitted_lines_over(const Polygon& region, double angle_deg, const PlanContext& context) {
  const auto [low, high] = level_range(region, angle_deg);
  const double inner_mm = high - low - 2 * kWaveMm;
  if (inner_mm < context.spacing_mm / 2) return {(low + high) / 2, context.spacing_mm, 1};
  const double gaps = std::max(std::round(inner_mm / context.spacing_mm),
                               std::ceil(inner_mm / context.line_width_mm));
  return {low + kWaveMm, inner_mm / gaps, static_cast<std::uint32_t>(gaps) + 1};
}

Turn::Turn(double angle_deg) : along_(unit_vector(angle_deg)) {}

Point2 Turn::to_level(Point2 p) const { return {dot(along_, p), cross(along_, p)}; }

Point2 Turn::from_level(Point2 p) const {
  return {along_.x * p.x - along_.y * p.y, along_.y * p.x + along_.x * p.y};
}

Hatch::Hatch(const Polygon& region, const HatchRule& rule)
    : rule_(rule), turn_(rule.angle_deg), rings_(rings_of({region})) {
  std::vector<Ring> level = rings_;
  for (Ring& ring : level)
    for (Point2& p : ring) p = turn_.to_level(p);
  const std::vector<Crossing> crossings = cross_lines(level, rule.lines, rule.search);

  first_piece_.assign(std::size_t{rule.lines.count} + 1, 0);
  const auto end_of = [&](const Crossing& c, double x) {
    const double y = rule.lines.y(c.line);
    return End{
        snap(turn_.from_level({x, y})), x, {c.edge, snap(turn_.from_level({c.x, y}))}, c.ring};
  };
  // Every line has an even number of crossings, so pairs never span two lines.
  for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
    const double left = crossings[i].x + rule.end_gap_mm;
    const double right = crossings[i + 1].x - rule.end_gap_mm;
    if (right - left < rule.min_length_mm) continue;
    const End first = end_of(crossings[i], left), last = end_of(crossings[i + 1], right);
    if (first.point == last.point) continue;
    ends_.push_back(first);
    ends_.push_back(last);
    line_of_.push_back(crossings[i].line);
    ++first_piece_[crossings[i].line + 1];
  }
  for (std::size_t line = 1; line < first_piece_.size(); ++line)
    first_piece_[line] += first_piece_[line - 1];
}

bool Hatch::passes_near(Point2 p, double reach_mm) const {
  const Point2 at = turn_.to_level(p);
  const EvenLines& lines = rule_.lines;
  const std::uint32_t last = lines.first_at_or_above(at.y + reach_mm);
  for (std::uint32_t line = lines.first_at_or_above(at.y - reach_mm); line < last; ++line) {
    const double dy = lines.y(line) - at.y;
    const double dx = std::sqrt(std::max(0.0, reach_mm * reach_mm - dy * dy));
    // Pieces of a line lie one after the other: the first that ends beyond the near side decides.
    std::size_t low = first_piece_[line], high = first_piece_[line + 1];
    const std::size_t end = high;
    while (low < high) {
      const std::size_t middle = (low + high) / 2;
      if (ends_[2 * middle + 1].x < at.x - dx)
        low = middle + 1;
      else
        high = middle;
    }
    if (low < end && ends_[2 * low].x <= at.x + dx) return true;
  }
  return false;
}

std::vector<Stretch> boundary_stretches(const Hatch& hatch) {
  const std::vector<Hatch::End>& ends = hatch.ends();
  std::vector<std::vector<std::size_t>> by_ring(hatch.rings().size());
  for (std::size_t end = 0; end < ends.size(); ++end) by_ring[ends[end].ring].push_back(end);

  std::vector<Stretch> stretches;
  for (std::size_t r = 0; r < by_ring.size(); ++r) {
    const Ring& ring = hatch.rings()[r];
    std::vector<std::size_t>& here = by_ring[r];
    if (here.empty()) {
      const RingPlace begin{0, ring.front()};
      stretches.push_back({kNoEnd, kNoEnd, path_along(ring, begin, begin)});
      continue;
    }
    std::stable_sort(here.begin(), here.end(), [&](std::size_t a, std::size_t b) {
      return comes_before(ring, ends[a].place, ends[b].place);
    });
    for (std::size_t i = 0; i < here.size(); ++i) {
      const std::size_t from = here[i], to = here[i + 1 < here.size() ? i + 1 : 0];
      stretches.push_back({from, to, path_along(ring, ends[from].place, ends[to].place)});
    }
  }
  return stretches;
}

std::vector<std::vector<Point2>> joined_lines(const Hatch& hatch,
                                              const std::vector<Joint>& joints) {
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> joint_at(hatch.ends().size(), kNone);
  for (std::size_t j = 0; j < joints.size(); ++j)
    joint_at[joints[j].from_end] = joint_at[joints[j].to_end] = j;

  std::vector<std::vector<Point2>> polylines;
  std::vector<bool> done(hatch.pieces(), false);
  for (std::size_t first = 0; first < hatch.ends().size(); ++first) {
    // Joints close no stroke, so every stroke has an end without a joint.
    if (done[first / 2] || joint_at[first] != kNone) continue;
    std::vector<Point2> points{hatch.ends()[first].point};
    const auto go_to = [&](Point2 p) {
      if (p != points.back()) points.push_back(p);
    };
    std::size_t end = first;
    for (;;) {
      done[end / 2] = true;
      end ^= 1U;
      go_to(hatch.ends()[end].point);
      if (joint_at[end] == kNone) break;
      const Joint& joint = joints[joint_at[end]];
      const bool forward = joint.from_end == end;
      if (forward)
        std::for_each(joint.path.begin(), joint.path.end(), go_to);
      else
        std::for_each(joint.path.rbegin(), joint.path.rend(), go_to);
      end = forward ? joint.to_end : joint.from_end;
    }
    polylines.push_back(std::move(points));
  }
  return polylines;
}

}  // namespace routebench
