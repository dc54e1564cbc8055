#include "eulerian/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "eulerian/polyline.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/planning/line_crossings.hpp"
#include "routebench/planning/walls.hpp"

namespace routebench::eulerian {
namespace {

// Offsets wave by up to this where their outline is level (see region.hpp).
constexpr double kWaveMm = 0.01;
// An even number of lines is worth to lie so much nearer or farther than wanted.
constexpr double kEvenSlack = 0.1;
constexpr double kMostPlaces = 16777216;  // 2^24
// In pitches: how far inside a place may lie to be pushed out to the boundary, how near to each
// other nodes may come when they are moved there, and how long a way along the wall may be.
constexpr double kPushOut = 0.25, kNearest = 0.5, kLongestWay = 2;

double mean_step_mm(const Axis& x, const Axis& y) { return std::sqrt(x.step_mm * y.step_mm); }

}  // namespace

Axis axis_over(double low_mm, double high_mm, const Pitch& pitch) {
  if (!pitch.fit) {
    const double first = std::ceil((low_mm - pitch.margin_mm) / pitch.wanted_mm);
    const double last = std::floor((high_mm + pitch.margin_mm) / pitch.wanted_mm);
    return {first * pitch.wanted_mm, pitch.wanted_mm, static_cast<std::uint32_t>(last - first + 1)};
  }
  const double inner_mm = high_mm - low_mm - 2 * kWaveMm;
  const double all_mm = inner_mm + 2 * pitch.margin_mm;
  const auto least = std::max(1.0, std::ceil((all_mm - pitch.wanted_mm) / pitch.widest_mm) + 1);
  double count = std::max(std::round(all_mm / pitch.wanted_mm), least);
  if (std::fmod(count, 2) == 1) {
    for (const double even : {count - 1, count + 1}) {
      const double share = all_mm / even / pitch.wanted_mm;
      if (even >= least && std::abs(share - 1) <= kEvenSlack) {
        count = even;
        break;
      }
    }
  }
  const double step_mm = all_mm / count;
  return {low_mm + kWaveMm - pitch.margin_mm + step_mm / 2, step_mm,
          static_cast<std::uint32_t>(count)};
}

std::uint32_t framed_places(const Axis& x, const Axis& y) {
  const double places = (x.count + 2.0) * (y.count + 2.0);
  if (!(places <= kMostPlaces))
    throw Error(ErrorKind::kBadInput, "eulerian: a region takes " +
                                          std::to_string(static_cast<long long>(places)) +
                                          " places at this line width, more than 16777216");
  return static_cast<std::uint32_t>(places);
}

Lattice::Lattice(const Polygon& region, const Pitch& pitch) : pitch_(pitch), edges_({region}) {
  const Box2 box = bounding_box(region);
  x_ = axis_over(box.lower.x, box.upper.x, pitch);
  y_ = axis_over(box.lower.y, box.upper.y, pitch);
  const std::uint32_t size = framed_places(x_, y_);
  stride_ = x_.count + 2;
  wall_.rings = rings_of({region});
  for (const Ring& ring : wall_.rings) {
    std::vector<double> along{0};
    for (std::size_t i = 0; i < ring.size(); ++i)
      along.push_back(along.back() + distance(ring[i], ring[i + 1 == ring.size() ? 0 : i + 1]));
    wall_.along_mm.push_back(std::move(along));
  }
  has_.assign(size, 0);
  joined_.assign(size, 0);
  rim_of_.assign(size, kNone);
  mark_inside();
  find_rims();
  pull_in();
  join();
}

Point2 Lattice::lattice_place(std::uint32_t node) const {
  return snap(Point2{x_.at(column(node)), y_.at(row(node))});
}

Point2 Lattice::place(std::uint32_t node) const {
  if (rim_of_[node] != kNone && rims_[rim_of_[node]].taken) return rims_[rim_of_[node]].place.point;
  return lattice_place(node);
}

void Lattice::mark_inside() {
  const EvenLines lines{y_.first_mm, y_.step_mm, y_.count};
  const std::vector<Crossing> crossings = cross_lines(wall_.rings, lines, CrossingSearch::kBucket);
  // Every line has an even number of crossings.
  for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
    const auto begin = std::max(0.0, std::ceil((crossings[i].x - x_.first_mm) / x_.step_mm));
    const auto end =
        std::min(x_.count - 1.0, std::floor((crossings[i + 1].x - x_.first_mm) / x_.step_mm));
    const std::uint32_t row = (crossings[i].line + 1) * stride_ + 1;
    for (double column = begin; column <= end; column += 1)
      has_[row + static_cast<std::uint32_t>(column)] = 1;
  }
}

void Lattice::find_rims() {
  const double reach_mm = std::max(x_.step_mm, y_.step_mm);
  const auto range = [&](double low, double high, const Axis& axis) {
    const double from = std::ceil((low - reach_mm - axis.first_mm) / axis.step_mm);
    const double to = std::floor((high + reach_mm - axis.first_mm) / axis.step_mm);
    return std::pair(
        static_cast<std::uint32_t>(std::max(from, 0.0)),
        static_cast<std::uint32_t>(std::clamp(to + 1, 0.0, static_cast<double>(axis.count))));
  };
  const auto look = [&](Point2 a, Point2 b, std::uint32_t ring, std::uint32_t edge) {
    const auto [left, right] = range(std::min(a.x, b.x), std::max(a.x, b.x), x_);
    const auto [low, high] = range(std::min(a.y, b.y), std::max(a.y, b.y), y_);
    for (std::uint32_t row = low; row < high; ++row)
      for (std::uint32_t column = left; column < right; ++column) {
        const std::uint32_t node = (row + 1) * stride_ + column + 1;
        const Point2 p{x_.at(column), y_.at(row)};
        const Point2 near = nearest_on_segment(p, a, b);
        const double squared = squared_distance(p, near);
        if (squared > reach_mm * reach_mm) continue;
        if (rim_of_[node] == kNone) {
          rim_of_[node] = static_cast<std::uint32_t>(rims_.size());
          rims_.push_back({squared, {edge, near}, ring, false});
        } else if (Rim& rim = rims_[rim_of_[node]]; squared < rim.squared_mm) {
          rim = {squared, {edge, near}, ring, false};
        }
      }
  };
  for (std::uint32_t r = 0; r < wall_.rings.size(); ++r) {
    const Ring& ring = wall_.rings[r];
    for (std::uint32_t e = 0; e < ring.size(); ++e) {
      const Point2 a = ring[e], b = ring[e + 1 == ring.size() ? 0 : e + 1];
      // A slanted edge's box would hold many nodes that are far from it.
      const double pieces = std::ceil(distance(a, b) / (2 * reach_mm));
      for (double i = 0; i < pieces; i += 1)
        look(lerp(a, b, i / pieces), i + 1 < pieces ? lerp(a, b, (i + 1) / pieces) : b, r, e);
    }
  }
  for (Rim& rim : rims_) rim.place.point = snap(rim.place.point);
}

void Lattice::pull_in() {
  const double pitch_mm = mean_step_mm(x_, y_);
  struct Candidate {
    double squared_mm;
    std::uint32_t node;
  };
  std::vector<Candidate> inner, outer;
  for (std::uint32_t node = first(); node < last(); ++node) {
    if (rim_of_[node] == kNone) continue;
    const double squared_mm = rims_[rim_of_[node]].squared_mm;
    const double reach_mm = has_[node] ? kPushOut * pitch_mm : pitch_.margin_mm;
    if (squared_mm <= reach_mm * reach_mm)
      (has_[node] ? inner : outer).push_back({squared_mm, node});
  }
  for (std::vector<Candidate>* candidates : {&inner, &outer}) {
    std::sort(candidates->begin(), candidates->end(), [](const Candidate& a, const Candidate& b) {
      return a.squared_mm != b.squared_mm ? a.squared_mm < b.squared_mm : a.node < b.node;
    });
    for (const Candidate& candidate : *candidates) {
      Rim& rim = rims_[rim_of_[candidate.node]];
      if (!is_free(candidate.node, rim.place.point)) continue;
      has_[candidate.node] = 1;
      rim.taken = true;
    }
  }
}

bool Lattice::is_free(std::uint32_t node, Point2 p) const {
  const double nearest_mm = kNearest * mean_step_mm(x_, y_);
  for (const std::uint32_t row : {node - stride_, node, node + stride_})
    for (const std::uint32_t other : {row - 1, row, row + 1})
      if (other != node && has_[other] &&
          squared_distance(place(other), p) < nearest_mm * nearest_mm * (1 - 1e-6))
        return false;
  return true;
}

void Lattice::join() {
  for (std::uint32_t node = first(); node < last(); ++node) {
    if (!has_[node]) continue;
    const Way right = find_way(node, node + 1), up = find_way(node, node + stride_);
    if (right != Way::kBlocked) joined_[node] |= kRight;
    if (right == Way::kBent) joined_[node] |= kRightBent;
    if (up != Way::kBlocked) joined_[node] |= kUp;
    if (up == Way::kBent) joined_[node] |= kUpBent;
  }
}

bool Lattice::is_clear(std::uint32_t a, std::uint32_t b) const {
  // Discs round both, up to the wall, that cover the way between; what has no rim is farther from
  // the wall than a step.
  if (rim_of_[a] == kNone && rim_of_[b] == kNone) return true;
  const double reach_mm = std::max(x_.step_mm, y_.step_mm);
  const auto clear_mm = [&](std::uint32_t node) {
    if (rim_of_[node] == kNone) return reach_mm;
    const Rim& rim = rims_[rim_of_[node]];
    return rim.taken ? 0.0 : std::sqrt(rim.squared_mm);
  };
  constexpr double kRoundingMm = 1e-5;
  return clear_mm(a) + clear_mm(b) > distance(place(a), place(b)) + kRoundingMm;
}

Lattice::Way Lattice::find_way(std::uint32_t a, std::uint32_t b) const {
  if (!has_[a] || !has_[b]) return Way::kBlocked;
  if (is_clear(a, b) || edges_.covers(place(a), place(b))) return Way::kStraight;
  return along_wall(a, b) ? Way::kBent : Way::kBlocked;
}

Lattice::Way Lattice::way(std::uint32_t a, std::uint32_t b) const {
  const std::uint32_t low = std::min(a, b), high = std::max(a, b);
  const auto remembered = [&](std::uint8_t joined, std::uint8_t bent) {
    if ((joined_[low] & joined) == 0) return Way::kBlocked;
    return (joined_[low] & bent) == 0 ? Way::kStraight : Way::kBent;
  };
  if (high == low + 1) return remembered(kRight, kRightBent);
  if (high == low + stride_) return remembered(kUp, kUpBent);
  return find_way(a, b);
}

std::optional<std::vector<Point2>> Lattice::along_wall(std::uint32_t a, std::uint32_t b) const {
  if (rim_of_[a] == kNone || rim_of_[b] == kNone) return std::nullopt;
  const Rim& from = rims_[rim_of_[a]];
  const Rim& to = rims_[rim_of_[b]];
  if (!from.taken || !to.taken || from.ring != to.ring) return std::nullopt;
  const Ring& ring = wall_.rings[from.ring];
  const std::vector<double>& along = wall_.along_mm[from.ring];
  const auto at = [&](const Rim& rim) {
    return along[rim.place.edge] + distance(ring[rim.place.edge], rim.place.point);
  };
  double ahead_mm = at(to) - at(from);
  if (ahead_mm < 0) ahead_mm += along.back();
  const double back_mm = along.back() - ahead_mm;
  if (std::min(ahead_mm, back_mm) > kLongestWay * pitch_.widest_mm) return std::nullopt;
  if (ahead_mm <= back_mm) return path_along(ring, from.place, to.place);
  std::vector<Point2> path = path_along(ring, to.place, from.place);
  std::reverse(path.begin(), path.end());
  return path;
}

void Lattice::append_way(std::uint32_t a, std::uint32_t b, std::vector<Point2>& points) const {
  if (way(a, b) == Way::kBent) {
    const auto path = along_wall(a, b);
    for (const Point2 p : *path) append_straight(points, p);
  } else {
    append_straight(points, place(b));
  }
}

}  // namespace routebench::eulerian
