#include "overlay/offset_rings.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>

#include "overlay/monotone_runs.hpp"
#include "overlay/planar_edges.hpp"
#include "overlay/small_loops.hpp"

namespace routebench::overlay {
namespace {

struct Vector {
  double x = 0;
  double y = 0;
};

double dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y; }
double cross(Vector a, Vector b) { return a.x * b.y - a.y * b.x; }

GridPoint moved(Vector p, Vector by) {
  const auto rounded = [](double v) {
    return static_cast<std::int32_t>(v < 0 ? v - 0.5 : v + 0.5);
  };
  return {rounded(p.x + by.x), rounded(p.y + by.y)};
}

/// Draws the moved boundary of one ring after the other. The curve may cross itself; what it winds
/// round at least once is the result.
class MovedBoundary {
 public:
  MovedBoundary(const GridRings& rings, bool moves_outwards, double clean)
      : clean_(clean),
        memory_(rings.memory()),
        small_loops_(moves_outwards, rings.rings() == 1, memory_) {
    curve_.reserve(rings.size() + rings.size() / 2);
  }

  void add(std::span<const GridPoint> ring, double distance) {
    distance_ = distance;
    corners_.clear();
    corners_.reserve(ring.size());
    for (const GridPoint p : ring)
      corners_.push_back({static_cast<double>(p.x), static_cast<double>(p.y)});
    do {
      measure_edges();
    } while (drop_used_edges());
    const std::size_t n = corners_.size();
    if (n < 3) return;  // nothing is left of the ring
    drawn_.clear();
    drawn_.reserve(2 * n);
    for (std::size_t i = 0, before = n - 1; i < n; before = i++) join(corners_[i], before, i);
    small_loops_.drop_from(drawn_);
    curve_.begin_ring({1, 0});
    for (const DrawnPoint& p : drawn_) curve_.add(p.at);
    curve_.end_ring();
  }

  [[nodiscard]] GridRings take() { return std::move(curve_); }

 private:
  struct MovedEdge {
    Vector normal;
    double left;  ///< of its length
    double used;  ///< at the corner where it begins
  };

  /// Normals, and what is left of the moved edges if every corner is one point.
  void measure_edges() {
    const std::size_t n = corners_.size();
    edges_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      const Vector a = corners_[i], b = corners_[i + 1 < n ? i + 1 : 0];
      const double dx = b.x - a.x, dy = b.y - a.y;
      const double length = std::sqrt(dx * dx + dy * dy);
      edges_[i] = {{dy / length, -dx / length}, length, 0};
    }
    for (std::size_t i = 0, before = n - 1; i < n; before = i++)
      edges_[i].used = used_at_corner(edges_[before].normal, edges_[i].normal);
    for (std::size_t i = 0; i < n; ++i)
      edges_[i].left -= edges_[i].used + edges_[i + 1 < n ? i + 1 : 0].used;
  }

  /// By how much the moved edges about a corner are shorter if they end where they cross; negative
  /// if they are longer.
  [[nodiscard]] double used_at_corner(Vector u, Vector v) const {
    const double sine = cross(u, v), cosine = dot(u, v);
    return 1 + cosine < kShortestMitre ? 0 : -distance_ * sine / (1 + cosine);
  }

  /// Edges between two corners at which moved edges cross, and of which nothing is left, are gone
  /// before the boundary has moved all the way: from then on their neighbours meet, which are
  /// farther from them than the distance. So they may as well have met from the beginning. True if
  /// there was such an edge.
  bool drop_used_edges() {
    const std::size_t n = corners_.size();
    const auto may_go = [&](std::size_t i) {  // & for &&: nobody can foresee these
      return i + 1 < n &&
             ((edges_[i].left < 0) & (edges_[i].used > 0) & (edges_[i + 1].used > 0)) != 0;
    };
    std::size_t first = 0;
    while (first < n && !may_go(first)) ++first;
    if (n < 4 || first == n) return false;
    kept_.clear();
    kept_.reserve(n);
    bool dropped = false;
    const auto are_one = [](Vector a, Vector b) {
      return std::abs(a.x - b.x) + std::abs(a.y - b.y) < 1;
    };
    const auto keep = [&](Vector p) {
      if (kept_.empty() || !are_one(kept_.back(), p)) kept_.push_back(p);
    };
    for (std::size_t i = 0; i < n; ++i) {
      if (may_go(i)) {
        if (const auto meeting = meeting_of(i > 0 ? i - 1 : n - 1, i + 1)) {
          keep(*meeting);
          dropped = true;
          ++i;  // both ends are replaced
          continue;
        }
      }
      keep(corners_[i]);
    }
    if (!dropped) return false;
    while (kept_.size() > 1 && are_one(kept_.back(), kept_.front())) kept_.pop_back();
    std::swap(corners_, kept_);
    return corners_.size() >= 3;
  }

  /// Where the lines of two edges meet, if they turn less than a mitre allows.
  [[nodiscard]] std::optional<Vector> meeting_of(std::size_t e, std::size_t f) const {
    const Vector u = edges_[e].normal, v = edges_[f].normal;
    const double sine = cross(u, v);
    if (sine * distance_ >= 0 || 1 + dot(u, v) < kShortestMitre) return std::nullopt;
    // Along e, whose direction is its normal turned left.
    const Vector along{-u.y, u.x}, from = corners_[e], to = corners_[f];
    const Vector gap{to.x - from.x, to.y - from.y};
    const double share = dot(gap, v) / dot(along, v);
    return Vector{from.x + share * along.x, from.y + share * along.y};
  }

  /// The curve about the point between two edges.
  void join(Vector p, std::size_t before, std::size_t after) {
    const Vector u = edges_[before].normal, v = edges_[after].normal;
    const double sine = cross(u, v), cosine = dot(u, v);
    const auto go_to = [&](Vector by, bool ends_side = true, bool is_far = false) {
      draw({moved(p, {distance_ * by.x, distance_ * by.y}), ends_side, is_far});
    };
    const double mitre = 1 / (1 + cosine);
    const Vector tip{(u.x + v.x) * mitre, (u.y + v.y) * mitre};
    if (std::abs(sine * distance_) < 1 && cosine > 0) {
      go_to(u);
    } else if (sine * distance_ < 0) {
      // The moved edges cross. Where neither is used up by that, only their crossing matters.
      if (1 + cosine >= kShortestMitre && edges_[before].left >= 0 && edges_[after].left >= 0)
        return go_to(tip);
      // By way of the corner, or of a place behind it: nothing is inside that near to it, and the
      // ways from square corners would run along the sides of others.
      go_to(u);
      go_to({-kBehind * (u.x + v.x), -kBehind * (u.y + v.y)}, false);
      go_to(v, false);
    } else if (1 + cosine >= kShortestMitre) {
      go_to(tip, true, std::abs(distance_) * (std::sqrt(2 * mitre) - 1) > clean_);
    } else {
      const double cut =
          std::tan(std::atan2(std::abs(sine), cosine) / 4) * (distance_ < 0 ? -1 : 1);
      go_to({u.x - u.y * cut, u.y + u.x * cut}, true, true);
      go_to({v.x + v.y * cut, v.y - v.x * cut}, true, true);
    }
  }

  void draw(const DrawnPoint& p) {
    if (drawn_.empty() || drawn_.back().at != p.at) drawn_.push_back(p);
  }

  static constexpr double kBehind = 1.0 / 16;
  static constexpr double kShortestMitre = 0.5;  // 1 + cosine of the turn: a mitre of twice

  double distance_ = 0;  // of the ring
  double clean_;
  std::pmr::memory_resource* memory_;
  GridRings curve_{memory_};
  std::pmr::vector<Vector> corners_{memory_};  // of the ring, corner i at the beginning of edge i
  std::pmr::vector<Vector> kept_{memory_};
  SmallLoops small_loops_;
  std::pmr::vector<DrawnPoint> drawn_{memory_};
  std::pmr::vector<MovedEdge> edges_{memory_};
};

/// Takes the points away that lie next to their neighbours or to the line between them. However
/// many go, and however short the edges of a curve are, no edge strays further from the points that
/// it stands for than `reach`.
class Cleaner {
 public:
  Cleaner(double reach, std::pmr::memory_resource* memory)
      : reach_(reach), reach2_(reach * reach), links_(memory), kept_(memory), moved_(memory) {}

  /// True if a ring loses points; what is left of it, maybe nothing, is kept() then.
  bool clean(std::span<const GridPoint> ring) {
    const auto n = static_cast<std::uint32_t>(ring.size());
    moved_.clear();
    std::uint32_t at = first_to_go(ring);
    if (at == n) {
      moved_.resize(n, 0);
      return false;
    }
    links_.resize(n);
    for (std::uint32_t i = 0; i < n; ++i)
      links_[i] = {i + 1 < n ? i + 1 : 0, i > 0 ? i - 1 : n - 1, 0, i < at};
    std::uint32_t size = n;
    while (size > 2 && !links_[at].settled) {
      const std::uint32_t next = links_[at].next, previous = links_[at].previous;
      const GridPoint before = ring[previous], here = ring[at], after = ring[next];
      double strays = reach_;
      if (is_low(before, here, after))
        strays =
            std::max(links_[previous].strayed, links_[at].strayed) + height(before, here, after);
      if (strays < reach_) {
        at = remove(at, strays);
        --size;
      } else if (are_near(before, after)) {
        remove(next, 0);
        at = remove(at, 0);
        size -= 2;
      } else {
        links_[at].settled = true;
        at = next;
      }
    }
    kept_.clear();
    if (size < 3) return true;
    for (std::uint32_t i = 0; i < size; ++i, at = links_[at].next) {
      kept_.push_back(ring[at]);
      moved_.push_back(links_[at].next == (at + 1 < n ? at + 1 : 0) ? 0 : 1);
    }
    return true;
  }

  [[nodiscard]] const GridRing& kept() const { return kept_; }

  /// Of the edges that the last ring has been left with: 1 where points between are gone.
  [[nodiscard]] const std::pmr::vector<std::uint8_t>& moved() const { return moved_; }

 private:
  struct Link {
    std::uint32_t next, previous;
    double strayed;  ///< the edge that begins here
    bool settled;
  };

  /// The first point to take away; as many as there are if all may stay, as mostly they do.
  [[nodiscard]] std::uint32_t first_to_go(std::span<const GridPoint> ring) const {
    const auto n = static_cast<std::uint32_t>(ring.size());
    for (std::uint32_t i = 0; i < n && n > 2; ++i) {
      const GridPoint before = ring[i > 0 ? i - 1 : n - 1], after = ring[i + 1 < n ? i + 1 : 0];
      if (are_near(before, after)) return i;
      if (is_low(before, ring[i], after) && height(before, ring[i], after) < reach_) return i;
    }
    return n;
  }

  /// Takes a point away; the edge that then stands for it strays so far. Returns the point before,
  /// which has to be looked at again.
  std::uint32_t remove(std::uint32_t at, double strays) {
    const std::uint32_t next = links_[at].next, previous = links_[at].previous;
    links_[previous].next = next;
    links_[next].previous = previous;
    links_[previous].settled = false;
    links_[previous].strayed = strays;
    return previous;
  }

  [[nodiscard]] bool are_near(GridPoint a, GridPoint b) const {
    const double dx = a.x - b.x, dy = a.y - b.y;
    return dx * dx + dy * dy <= reach2_;
  }

  /// Whether the height below may be within reach: most are beyond, which takes no root to tell.
  [[nodiscard]] bool is_low(GridPoint a, GridPoint b, GridPoint c) const {
    constexpr double kRounding = 1 + 1e-9;
    const auto twice_area = static_cast<double>(turn(a, b, c));
    return twice_area * twice_area <= kRounding * reach2_ * longest2(a, b, c);
  }

  [[nodiscard]] static double longest2(GridPoint a, GridPoint b, GridPoint c) {
    const auto square = [](GridPoint p, GridPoint q) {
      const double dx = p.x - q.x, dy = p.y - q.y;
      return dx * dx + dy * dy;
    };
    return std::max({square(a, b), square(b, c), square(a, c)});
  }

  /// How far the middle one of three points, in whichever order they lie, is from the line through
  /// the others.
  [[nodiscard]] static double height(GridPoint a, GridPoint b, GridPoint c) {
    const double longest = longest2(a, b, c);
    return longest > 0 ? static_cast<double>(std::abs(turn(a, b, c))) / std::sqrt(longest) : 0;
  }

  double reach_;
  double reach2_;
  std::pmr::vector<Link> links_;  // of points
  GridRing kept_;
  std::pmr::vector<std::uint8_t> moved_;
};

}  // namespace

std::optional<std::vector<GridPolygon>> offset_rings(const GridRings& rings,
                                                     std::span<const double> distances,
                                                     double clean) {
  if (rings.rings() == 0) return std::vector<GridPolygon>{};
  std::pmr::memory_resource* const memory = rings.memory();
  Cleaner smoother(clean, memory), cleaner(clean, memory);
  MovedBoundary boundary(rings, distances.front() > 0, clean);
  for (std::uint32_t i = 0; i < rings.rings(); ++i) {
    std::span<const GridPoint> ring = rings.ring(i);
    if (smoother.clean(ring)) ring = smoother.kept();  // so near, points make mitres that are noise
    if (!ring.empty()) boundary.add(ring, distances[i]);
  }
  std::optional<std::vector<GridPolygon>> grown = overlay(boundary.take(), Inside::kFirstPositive);
  if (!grown) return std::nullopt;

  std::pmr::vector<std::uint8_t> moved(memory);
  bool any_moved = false;
  const auto clean_ring = [&](GridRing& ring) {
    if (cleaner.clean(ring)) {
      ring = cleaner.kept();
      any_moved = true;
    }
    moved.insert(moved.end(), cleaner.moved().begin(), cleaner.moved().end());
  };
  for (GridPolygon& polygon : *grown) {
    clean_ring(polygon.outer);
    if (polygon.outer.empty()) polygon.holes.clear();
    for (GridRing& hole : polygon.holes) clean_ring(hole);
    std::erase_if(polygon.holes, [](const GridRing& hole) { return hole.empty(); });
  }
  std::erase_if(*grown, [](const GridPolygon& polygon) { return polygon.outer.empty(); });
  if (!any_moved || grown->empty()) return grown;
  const GridRings cleaned = rings_of(*grown, memory);
  // Cleaning moves edges, so rings may overlap by as much.
  if (meet_nowhere(cleaned) || !PlanarEdges(cleaned, moved).any_meets()) return grown;
  return overlay(cleaned, Inside::kFirstNonZero);
}

}  // namespace routebench::overlay
