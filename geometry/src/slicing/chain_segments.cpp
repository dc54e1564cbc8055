#include "slicing/chain_segments.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <tuple>
#include <utility>

#include "large_vector.hpp"

namespace routebench::slicing {
namespace {

constexpr std::uint32_t kNone = UINT32_MAX;
constexpr std::uint32_t kUsed = kNone - 1;

bool precedes(Point2 a, Point2 b) { return std::tie(a.x, a.y) < std::tie(b.x, b.y); }

/// Adds a closed line if it has any extent.
void add_ring(std::span<const Point2> points, std::vector<Ring>& rings) {
  Ring ring;
  ring.reserve(points.size());
  std::unique_copy(points.begin(), points.end(), std::back_inserter(ring));
  while (ring.size() > 1 && ring.back() == ring.front()) ring.pop_back();
  if (ring.size() >= 3) rings.push_back(std::move(ring));
}

/// Finds the cut that begins on an edge. Open addressing, at most a third full.
class CutsByEdge {
 public:
  explicit CutsByEdge(std::span<const Cut> cuts)
      : edges_(cuts.size()),
        slots_(std::bit_ceil(3 * cuts.size() + 1), kNone),
        shift_(64 - std::countr_zero(slots_.size())) {
    std::transform(cuts.begin(), cuts.end(), edges_.begin(),
                   [](const Cut& cut) { return cut.from(); });
  }

  /// The edge that a cut begins on.
  [[nodiscard]] EdgeKey edge(std::uint32_t cut) const { return edges_[cut]; }
  /// False if another cut begins on the same edge.
  [[nodiscard]] bool insert(std::uint32_t cut) {
    std::uint32_t& slot = slots_[slot_of(edges_[cut])];
    if (slot != kNone) return false;
    slot = cut;
    return true;
  }
  [[nodiscard]] std::uint32_t find(EdgeKey edge) const { return slots_[slot_of(edge)]; }

 private:
  /// The slot that holds the edge's cut, or the free one where it would stand.
  [[nodiscard]] std::size_t slot_of(EdgeKey edge) const {
    std::size_t slot = edge * 0x9E3779B97F4A7C15u >> shift_;
    while (slots_[slot] != kNone && edges_[slots_[slot]] != edge)
      slot = (slot + 1) & (slots_.size() - 1);
    return slot;
  }

  LargeVector<EdgeKey> edges_;  // of each cut
  std::vector<std::uint32_t> slots_;
  int shift_;
};

/// The rings, if the edges lead from every cut to exactly one other.
std::optional<std::vector<Ring>> chain_by_edges(std::span<const Cut> cuts, const Mesh& mesh,
                                                double z_mm) {
  CutsByEdge by_edge(cuts);
  for (std::uint32_t cut = 0; cut < cuts.size(); ++cut) {
    if (!by_edge.insert(cut)) return std::nullopt;
    // Until they are needed they will have come.
    __builtin_prefetch(&mesh.vertices[cuts[cut].alone].z);
    __builtin_prefetch(&mesh.vertices[cuts[cut].from_end].z);
  }
  // What does not wait for the cut before, not on the way around.
  LargeVector<std::uint32_t> next(cuts.size());
  LargeVector<Point2> begin(cuts.size());
  for (std::uint32_t cut = 0; cut < cuts.size(); ++cut) {
    next[cut] = by_edge.find(cuts[cut].to());
    begin[cut] = cut_point(mesh, by_edge.edge(cut), z_mm);
  }

  std::vector<Ring> rings;
  LargeVector<Point2> points(cuts.size());
  for (std::uint32_t first = 0; first < cuts.size(); ++first) {
    if (next[first] == kUsed) continue;
    std::size_t count = 0;
    std::uint32_t cut = first;
    do {
      if (cut == kNone || next[cut] == kUsed) return std::nullopt;
      points[count++] = begin[cut];
      cut = std::exchange(next[cut], kUsed);
    } while (cut != first);
    add_ring(std::span(points).first(count), rings);
  }
  return rings;
}

struct Segment {
  Point2 from, to;
};

/// The segments of a layer as a directed graph over its distinct points.
class SegmentGraph {
 public:
  explicit SegmentGraph(std::vector<Segment> segments) {
    std::sort(segments.begin(), segments.end(), [](const Segment& a, const Segment& b) {
      return std::tie(a.from.x, a.from.y, a.to.x, a.to.y) <
             std::tie(b.from.x, b.from.y, b.to.x, b.to.y);
    });
    for (const Segment& s : segments) points_.insert(points_.end(), {s.from, s.to});
    std::sort(points_.begin(), points_.end(), precedes);
    points_.erase(std::unique(points_.begin(), points_.end()), points_.end());

    next_.resize(points_.size());
    end_.resize(points_.size());
    surplus_.resize(points_.size());
    place_.resize(points_.size(), kNone);
    for (const Segment& s : segments) {
      const std::uint32_t from = number(s.from), to = number(s.to);
      if (end_[from] == 0) next_[from] = static_cast<std::uint32_t>(targets_.size());
      targets_.push_back(to);
      end_[from] = static_cast<std::uint32_t>(targets_.size());
      ++surplus_[from];
      --surplus_[to];
    }
  }

  /// Uses every segment once. Open lines are begun where more segments begin than end, and only
  /// there; what they leave is closed.
  [[nodiscard]] Contours decompose() {
    Contours contours;
    for (std::uint32_t p = 0; p < points_.size(); ++p)
      for (; surplus_[p] > 0; --surplus_[p]) walk(p, contours);
    for (std::uint32_t p = 0; p < points_.size(); ++p)
      while (next_[p] < end_[p]) walk(p, contours);
    return contours;
  }

 private:
  [[nodiscard]] std::uint32_t number(Point2 p) const {
    return static_cast<std::uint32_t>(
        std::lower_bound(points_.begin(), points_.end(), p, precedes) - points_.begin());
  }

  /// Follows unused segments to where none is left. Whenever the line meets itself the loop is cut
  /// off as a ring, so that rings and open lines visit no point twice.
  void walk(std::uint32_t start, Contours& contours) {
    std::vector<std::uint32_t> path{start};
    place_[start] = 0;
    while (next_[path.back()] < end_[path.back()]) {
      const std::uint32_t target = targets_[next_[path.back()]++];
      if (place_[target] == kNone) {
        place_[target] = static_cast<std::uint32_t>(path.size());
        path.push_back(target);
        continue;
      }
      add_ring(coordinates(path, place_[target]), contours.rings);
      for (; path.back() != target; path.pop_back()) place_[path.back()] = kNone;
    }
    if (path.size() > 1) contours.open.push_back(coordinates(path, 0));
    for (const std::uint32_t p : path) place_[p] = kNone;
  }

  [[nodiscard]] std::vector<Point2> coordinates(const std::vector<std::uint32_t>& path,
                                                std::size_t begin) const {
    std::vector<Point2> line;
    line.reserve(path.size() - begin);
    for (std::size_t i = begin; i < path.size(); ++i) line.push_back(points_[path[i]]);
    return line;
  }

  std::vector<Point2> points_;
  std::vector<std::uint32_t> targets_;  // of the segments, grouped by where they begin
  std::vector<std::uint32_t> next_;     // of each point: its first unused segment
  std::vector<std::uint32_t> end_;
  std::vector<int> surplus_;  // of each point: segments that begin less those that end there
  std::vector<std::uint32_t> place_;  // of each point on the current path
};

Contours chain_by_points(std::span<const Cut> cuts, const Mesh& mesh, double z_mm) {
  std::vector<Segment> segments;
  segments.reserve(cuts.size());
  for (const Cut& cut : cuts) {
    const Segment segment{cut_point(mesh, cut.from(), z_mm), cut_point(mesh, cut.to(), z_mm)};
    if (segment.from != segment.to) segments.push_back(segment);
  }
  return SegmentGraph(std::move(segments)).decompose();
}

}  // namespace

Contours chain_cuts(std::span<const Cut> cuts, const Mesh& mesh, double z_mm) {
  if (std::optional<std::vector<Ring>> rings = chain_by_edges(cuts, mesh, z_mm))
    return {std::move(*rings), {}, true};
  return chain_by_points(cuts, mesh, z_mm);
}

}  // namespace routebench::slicing
