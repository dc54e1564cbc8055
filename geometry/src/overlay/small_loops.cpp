#include "overlay/small_loops.hpp"

#include <algorithm>
#include <cmath>

#include "overlay/edge_cells.hpp"

namespace routebench::overlay {
namespace {

constexpr std::size_t kMostEdges = 12;

double twice_area(const std::pmr::vector<DrawnPoint>& curve) {
  double sum = 0;
  for (std::size_t i = 1; i + 1 < curve.size(); ++i)
    sum += static_cast<double>(turn(curve[0].at, curve[i].at, curve[i + 1].at));
  return sum;
}

/// Begins a curve at the end of its longest edge, which is hardly ever part of a small loop.
void begin_after_longest_edge(std::pmr::vector<DrawnPoint>& curve) {
  std::size_t begin = 0;
  double longest = 0;
  for (std::size_t i = 0, before = curve.size() - 1; i < curve.size(); before = i++) {
    const double x = curve[i].at.x - curve[before].at.x, y = curve[i].at.y - curve[before].at.y;
    if (x * x + y * y <= longest) continue;
    longest = x * x + y * y;
    begin = i;
  }
  std::rotate(curve.begin(), curve.begin() + static_cast<std::ptrdiff_t>(begin), curve.end());
}

/// Whether one edge passes from side to side of the other's line.
bool passes(const Edge& edge, const Edge& line) {
  const std::int64_t from = turn(line.from, line.to, edge.from);
  const std::int64_t to = turn(line.from, line.to, edge.to);
  return (from > 0 && to < 0) || (from < 0 && to > 0);
}

}  // namespace

void SmallLoops::drop_from(std::pmr::vector<DrawnPoint>& curve) {
  const auto ends_no_side = [](const DrawnPoint& point) { return !point.ends_side; };
  if (curve.size() < 5 || std::none_of(curve.begin(), curve.end(), ends_no_side)) return;
  // Of what turns the same way as loops that may go, such as holes that grow, the ring itself must
  // not be taken for the loop.
  const double largest = std::abs(twice_area(curve)) / 2;
  begin_after_longest_edge(curve);
  kept_.clear();
  kept_.reserve(curve.size());
  corners_.clear();
  first_ = 0;
  keep(curve[0]);
  for (std::size_t i = 1; i <= curve.size(); ++i) {
    const DrawnPoint& end = curve[i < curve.size() ? i : 0];
    while (const std::optional<Loop> loop = loop_closed_by(end)) {
      const bool turns_left = loop->twice_area > 0;
      if (loop->is_far || turns_left != turns_left_ || std::abs(loop->twice_area) > largest) {
        first_ = kept_.size();  // it stays, and so does what it is a part of
        break;
      }
      cut_off(*loop);
    }
    if (i < curve.size()) keep(end);
  }
  std::swap(curve, kept_);
}

void SmallLoops::keep(const DrawnPoint& point) {
  if (!kept_.empty() && kept_.back().at == point.at) return;
  if (!point.ends_side) corners_.push_back(kept_.size());
  kept_.push_back(point);
}

void SmallLoops::cut_off(const Loop& loop) {
  kept_.resize(loop.begin + 1);
  while (!corners_.empty() && corners_.back() > loop.begin) corners_.pop_back();
  keep({loop.crossing});
}

/// The shortest one. Its two sides cross, and it has been to a corner.
std::optional<SmallLoops::Loop> SmallLoops::loop_closed_by(const DrawnPoint& end) const {
  const std::size_t last = kept_.size() - 1;
  const std::size_t stop = std::max(first_, last > kMostEdges ? last - kMostEdges : 0);
  if (!end.ends_side || corners_.empty()) return std::nullopt;
  const Edge closing{kept_.back().at, end.at};
  const GridBox box = box_of(closing);
  for (std::size_t e = std::min(corners_.back(), last); e-- > stop;) {
    if (!kept_[e + 1].ends_side) continue;
    const Edge edge{kept_[e].at, kept_[e + 1].at};
    if (!box_of(edge).meets(box) || !passes(edge, closing) || !passes(closing, edge)) continue;
    Loop loop{e, crossing_of(edge, closing), 0, kept_[last].is_far};
    for (std::size_t i = e + 1; i < last; ++i) {
      loop.twice_area += static_cast<double>(turn(loop.crossing, kept_[i].at, kept_[i + 1].at));
      loop.is_far |= kept_[i].is_far;
    }
    return loop;
  }
  return std::nullopt;
}

}  // namespace routebench::overlay
