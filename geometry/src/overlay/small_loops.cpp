#include "overlay/small_loops.hpp"

#include <algorithm>
#include <cmath>

#include "overlay/edge_cells.hpp"

namespace routebench::overlay {
namespace {

constexpr std::size_t kMostEdges = 12;
constexpr std::size_t kFewPoints = 256;  // of a curve, all of which may be looked at for each loop

double twice_area(const std::pmr::vector<DrawnPoint>& curve) {
  double sum = 0;
  for (std::size_t i = 1; i + 1 < curve.size(); ++i)
    sum += static_cast<double>(turn(curve[0].at, curve[i].at, curve[i + 1].at));
  return sum;
}

/// Begins a curve half-way along its longest stretch, in points, between ways to corners: small
/// loops run round corners. Takes one with such a way.
void begin_far_from_corners(std::pmr::vector<DrawnPoint>& curve) {
  const std::size_t n = curve.size();
  std::size_t first = 0;
  while (curve[first].ends_side) ++first;
  std::size_t begin = 0, longest = 0;
  for (std::size_t i = first + 1, last = first; i <= first + n; ++i) {
    if (curve[i < n ? i : i - n].ends_side) continue;
    if (i - last > longest) {
      longest = i - last;
      begin = last + longest / 2;
    }
    last = i;
  }
  if (begin >= n) begin -= n;
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
  const bool looks_at_all = is_only_ring_ && !turns_left_ && curve.size() <= kFewPoints;
  begin_far_from_corners(curve);
  curve.push_back(curve.front());
  kept_.clear();
  kept_.reserve(curve.size());
  corners_.clear();
  first_ = 0;
  keep(curve[0]);
  for (std::size_t i = 1; i < curve.size(); ++i) {
    const DrawnPoint& end = curve[i];
    while (const std::optional<Loop> loop = loop_closed_by(end)) {
      const bool turns_left = loop->twice_area > 0;
      const bool is_small = !loop->is_far && std::abs(loop->twice_area) <= largest;
      const auto is_no_part = [&] {
        return looks_at_all && winds_right(*loop, end.at) &&
               lies_outside(*loop, std::span(curve).subspan(i));
      };
      if (turns_left != turns_left_ || !(is_small || is_no_part())) {
        first_ = kept_.size();  // it stays, and so does what it is a part of
        break;
      }
      cut_off(*loop);
    }
    if (i + 1 < curve.size()) keep(end);
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

/// Whether a loop winds left nowhere, being locally convex or simple, and its two sides do not
/// enter it where they go on beyond their crossing. Takes one that turns right, and the point that
/// the closing side leads to.
bool SmallLoops::winds_right(const Loop& loop, GridPoint end) const {
  const std::size_t first = loop.begin, last = kept_.size() - 1;
  const auto at = [&](std::size_t i) { return i <= last ? kept_[i].at : end; };
  const auto meet = [&](std::size_t e, std::size_t f) {
    return edges_meet({at(e), at(e + 1)}, {at(f), at(f + 1)});
  };
  for (std::size_t e = first + 1; e < last; ++e)
    if ((e > first + 1 && meet(first, e)) || (e + 1 < last && meet(e, last))) return false;
  bool is_convex = turn(at(first), at(first + 1), end) > 0;
  for (std::size_t i = first; is_convex && i < last; ++i)
    is_convex = turn(at(i), at(i + 1), at(i + 2)) < 0;
  if (is_convex) return true;
  for (std::size_t e = first + 1; e < last; ++e)
    for (std::size_t f = e + 2; f < last; ++f)
      if (meet(e, f)) return false;
  return true;
}

/// Whether a loop lies apart from the rest of the curve, which does not run round it. Takes the
/// point that the closing side leads to, and all from there on up to the first point.
bool SmallLoops::lies_outside(const Loop& loop, std::span<const DrawnPoint> ahead) const {
  GridBox box{loop.crossing, loop.crossing};
  for (std::size_t i = loop.begin + 1; i < kept_.size(); ++i) {
    const GridPoint p = kept_[i].at;
    box = {{std::min(box.lower.x, p.x), std::min(box.lower.y, p.y)},
           {std::max(box.upper.x, p.x), std::max(box.upper.y, p.y)}};
  }
  // By a ray to the left of a point of the loop, infinitesimally above it.
  const GridPoint inside = kept_[loop.begin + 1].at;
  int winding = 0;
  const auto count = [&](GridPoint a, GridPoint b) {
    if (a.y > inside.y && b.y <= inside.y && turn(a, b, inside) > 0) ++winding;
    if (a.y <= inside.y && b.y > inside.y && turn(a, b, inside) < 0) --winding;
  };
  const auto passes_by = [&](GridPoint a, GridPoint b) {
    count(a, b);
    return !box_of(Edge{a, b}).meets(box);
  };
  for (std::size_t i = 0; i < loop.begin; ++i)
    if (!passes_by(kept_[i].at, kept_[i + 1].at)) return false;
  for (std::size_t i = 1; i < ahead.size(); ++i)
    if (!passes_by(ahead[i - 1].at, ahead[i].at)) return false;
  count(kept_[loop.begin].at, loop.crossing);
  count(loop.crossing, ahead.front().at);
  return winding <= 0;
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
