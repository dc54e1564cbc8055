#include "near_sides.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory_resource>
#include <vector>

#include "routebench/geometry/region.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench {
namespace {

constexpr std::size_t kLeafEdges = 4;
// Of so few each is looked at with each.
constexpr std::size_t kFewEdges = 48;
constexpr double kOpposite = -0.5;  // cosine of two sides' directions: 60 degrees from opposite

struct Edge {
  Point2 from;
  Point2 to;
  Point2 way;       ///< of length one
  double begin_mm;  ///< along its ring
  double end_mm;
  std::uint32_t ring;
};

constexpr std::size_t kFewBytes = kFewEdges * (sizeof(Edge) + sizeof(double));

/// The edges of a polygon; of many also the boxes around runs of them, by halves.
class EdgeTree {
 public:
  EdgeTree(const Polygon& polygon, double width_mm, double apart_mm,
           std::pmr::memory_resource* memory)
      : width_mm_(width_mm),
        apart_mm_(apart_mm),
        edges_(memory),
        lengths_mm_(memory),
        boxes_(memory) {
    std::size_t edges = polygon.outer.size();
    for (const Ring& hole : polygon.holes) edges += hole.size();
    edges_.reserve(edges);
    add(polygon.outer);
    for (const Ring& hole : polygon.holes) add(hole);
    if (edges <= kFewEdges) return;
    const std::size_t needed = (edges_.size() + kLeafEdges - 1) / kLeafEdges;
    while (leaves_ < needed) leaves_ *= 2;
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    boxes_.resize(2 * leaves_, {{kInfinity, kInfinity}, {-kInfinity, -kInfinity}});
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      Box2& box = boxes_[leaves_ + i / kLeafEdges];
      for (const Point2 p : {edges_[i].from, edges_[i].to}) box = around(box, {p, p});
    }
    for (std::size_t node = leaves_; --node > 0;)
      boxes_[node] = around(boxes_[2 * node], boxes_[2 * node + 1]);
  }

  [[nodiscard]] bool has_near_sides() const {
    if (!boxes_.empty()) return have_near_sides({1, 0, leaves_}, {1, 0, leaves_});
    for (std::size_t e = 0; e < edges_.size(); ++e)
      for (std::size_t f = e + 1; f < edges_.size(); ++f)
        if (are_near_sides(edges_[e], edges_[f])) return true;
    return false;
  }

 private:
  struct Node {
    std::size_t index;
    std::size_t first;  ///< leaf
    std::size_t leaves;

    [[nodiscard]] Node half(std::size_t which) const {
      return {2 * index + which, first + which * (leaves / 2), leaves / 2};
    }
  };

  void add(const Ring& ring) {
    double along_mm = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 a = ring[i], b = ring[i + 1 < ring.size() ? i + 1 : 0];
      const double edge_mm = distance(a, b);
      edges_.push_back({a, b, (1 / edge_mm) * (b - a), along_mm, along_mm + edge_mm,
                        static_cast<std::uint32_t>(lengths_mm_.size())});
      along_mm += edge_mm;
    }
    lengths_mm_.push_back(along_mm);
  }

  /// Takes nodes of one height, the first no later than the second.
  [[nodiscard]] bool have_near_sides(const Node& a, const Node& b) const {
    const Box2& p = boxes_[a.index];
    const Box2& q = boxes_[b.index];
    const double x = std::max({p.lower.x - q.upper.x, q.lower.x - p.upper.x, 0.0});
    const double y = std::max({p.lower.y - q.upper.y, q.lower.y - p.upper.y, 0.0});
    if (!(x * x + y * y < width_mm_ * width_mm_)) return false;  // nothing is near an empty box
    const std::size_t a_first = a.first * kLeafEdges, b_first = b.first * kLeafEdges;
    const std::size_t a_end = std::min(a_first + a.leaves * kLeafEdges, edges_.size());
    const std::size_t b_end = std::min(b_first + b.leaves * kLeafEdges, edges_.size());
    if (are_close_along(edges_[a_first], edges_[a_end - 1], edges_[b_first], edges_[b_end - 1]))
      return false;
    if (a.leaves == 1) {
      for (std::size_t e = a_first; e < a_end; ++e)
        for (std::size_t f = std::max(e + 1, b_first); f < b_end; ++f)
          if (are_near_sides(edges_[e], edges_[f])) return true;
      return false;
    }
    return have_near_sides(a.half(0), b.half(0)) || have_near_sides(a.half(0), b.half(1)) ||
           (a.index != b.index && have_near_sides(a.half(1), b.half(0))) ||
           have_near_sides(a.half(1), b.half(1));
  }

  /// Whether runs of edges, one not before the other, lie on one ring and are nowhere apart on it.
  [[nodiscard]] bool are_close_along(const Edge& a_first, const Edge& a_last, const Edge& b_first,
                                     const Edge& b_last) const {
    if (a_first.ring != b_last.ring) return false;
    const double on_mm = b_last.end_mm - a_first.begin_mm;
    const double round_mm = lengths_mm_[a_first.ring] - (b_first.begin_mm - a_last.end_mm);
    return std::min(on_mm, round_mm) < apart_mm_;
  }

  [[nodiscard]] bool are_near_sides(const Edge& e, const Edge& f) const {
    if (dot(e.way, f.way) > kOpposite) return false;
    // The inside, to the left of both, lies between them; and most are farther apart than that.
    const auto may_be_near = [this](const Edge& side, const Edge& other) {
      const double from_mm = cross(side.way, other.from - side.from);
      const double to_mm = cross(side.way, other.to - side.from);
      return from_mm + to_mm > 0 && std::min(from_mm, to_mm) < width_mm_;
    };
    if (!may_be_near(e, f) || !may_be_near(f, e)) return false;
    if (are_close_along(e, e, f, f)) return false;
    const auto is_near = [this](Point2 p, const Edge& edge) {
      return squared_distance(p, nearest_on_segment(p, edge.from, edge.to)) < width_mm_ * width_mm_;
    };
    return is_near(e.from, f) || is_near(e.to, f) || is_near(f.from, e) || is_near(f.to, e);
  }

  double width_mm_;
  double apart_mm_;
  std::pmr::vector<Edge> edges_;
  std::pmr::vector<double> lengths_mm_;  // of rings
  std::size_t leaves_ = 1;               // a power of two
  std::pmr::vector<Box2> boxes_;  // of nodes: the root is 1, the halves of node i are 2 i, 2 i + 1
};

}  // namespace

bool has_near_sides(const Polygon& polygon, double width_mm, double apart_mm) {
  // No two places of one ring are farther apart than half its length.
  if (polygon.holes.empty() && perimeter_mm(polygon.outer) < 2 * apart_mm) return false;
  std::array<std::byte, kFewBytes> few;
  std::pmr::monotonic_buffer_resource memory(few.data(), few.size());
  return EdgeTree(polygon, width_mm, apart_mm, &memory).has_near_sides();
}

}  // namespace routebench
