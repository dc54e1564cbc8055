#include "overlay/crossed_rings.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <span>
#include <utility>
#include <vector>

#include "overlay/apart_rings.hpp"

namespace routebench::overlay {
namespace {

/// Crossings of one edge that are farther apart lie in the same order once they are rounded.
constexpr std::int32_t kApart = 4;
/// The area of a ring that is less than so many units wide may be what rounding makes of it.
constexpr double kSliver = 4;

}  // namespace

CrossedRings::CrossedRings(const PlanarEdges& edges)
    : edges_(edges),
      cuts_(edges.crossings()),
      order_(edges.memory()),
      strands_(edges.memory()),
      rings_(edges.memory()),
      begun_(edges.memory()) {
  are_known_ = !edges.any_touches() && put_in_order() && find_windings();
}

/// Into the order along the edges: by edges at once, then the few of one edge.
void CrossedRings::sort_by_edges() {
  std::pmr::vector<std::uint32_t> end(edges_.size() + 1, 0, edges_.memory());  // of an edge's
  for (const Cut& cut : cuts_) ++end[cut.edge + 1];
  for (std::size_t edge = 1; edge < end.size(); ++edge) end[edge] += end[edge - 1];
  order_.resize(cuts_.size());
  for (std::uint32_t i = 0; i < cuts_.size(); ++i) order_[end[cuts_[i].edge]++] = i;
  const auto is_before = [&](std::uint32_t a, std::uint32_t b) {
    return cuts_[a].squared_way < cuts_[b].squared_way;
  };
  std::uint32_t begin = 0;
  for (std::uint32_t edge = 0; edge < edges_.size(); begin = end[edge++])
    if (end[edge] - begin > 1)
      std::sort(order_.begin() + begin, order_.begin() + end[edge], is_before);
}

/// False if some crossings may come in another order than their places.
bool CrossedRings::put_in_order() {
  const auto count = static_cast<std::uint32_t>(cuts_.size());
  sort_by_edges();
  for (std::uint32_t i = 1; i < count; ++i) {
    const Cut &a = cuts_[order_[i - 1]], &b = cuts_[order_[i]];
    if (a.edge == b.edge && std::abs(a.at.x - b.at.x) < kApart &&
        std::abs(a.at.y - b.at.y) < kApart)
      return false;
  }
  strands_.resize(count);
  for (std::uint32_t i = 0; i < count; i += 2) {
    const Edge a = edges_.edge(cuts_[i].edge), b = edges_.edge(cuts_[i + 1].edge);
    strands_[i + 1].leftwards = turn(a.from, a.to, b.to) > 0;
    strands_[i].leftwards = !strands_[i + 1].leftwards;
  }
  std::uint32_t cut = 0;
  for (std::uint32_t ring = 0; ring < edges_.rings(); ++ring) {
    const std::span<const GridPoint> all = edges_.ring(ring);
    const auto leftmost = std::min_element(all.begin(), all.end()) - all.begin();
    const std::uint32_t begin = edges_.first_point(ring), first = cut;
    while (cut < count && cuts_[order_[cut]].edge < begin + all.size()) ++cut;
    for (std::uint32_t i = first, previous = cut - 1; i < cut; previous = i++) {
      Strand& strand = strands_[order_[i]];
      strand.ring = ring;
      strand.previous = order_[previous];
      strands_[order_[previous]].next = order_[i];
    }
    rings_.push_back({box_of(all), begin + static_cast<std::uint32_t>(leftmost), first, cut});
  }
  return true;
}

/// The winding numbers of all stretches; false if that takes too long.
bool CrossedRings::find_windings() {
  for (std::uint32_t r = 0; r < rings_.size(); ++r) {
    Ring& ring = rings_[r];
    if (ring.is_known) continue;
    ring.is_known = true;
    const std::span<const GridPoint> all = edges_.ring(r);
    const std::size_t at = ring.leftmost - edges_.first_point(r);
    const bool turns_left = turn(all[at == 0 ? all.size() - 1 : at - 1], all[at],
                                 all[at + 1 == all.size() ? 0 : at + 1]) > 0;
    const Winding outside = winding_around(r);
    if (steps_ > kStepsPerPoint * edges_.size()) return false;
    const Winding right = turns_left ? outside : outside - edges_.winding(r);
    if (ring.first_cut == ring.end_cut) {
      ring.right = right;
      continue;
    }
    const std::uint32_t strand = strand_at(ring);
    strands_[strand].right = right;
    begun_.push_back(strand);
    while (!begun_.empty()) {
      const std::uint32_t begin = begun_.back();
      begun_.pop_back();
      go_along(begin);
    }
  }
  return true;
}

/// How often the others run round a ring's leftmost point.
Winding CrossedRings::winding_around(std::uint32_t ring) {
  const GridPoint p = edges_.point(rings_[ring].leftmost);
  Winding sum;
  steps_ += rings_.size() / 4;
  for (std::uint32_t other = 0; other < rings_.size(); ++other) {
    const GridBox& box = rings_[other].box;
    if (other == ring || !box.meets({p, p})) continue;
    // By a ray to the left, infinitesimally above the point.
    const std::span<const GridPoint> all = edges_.ring(other);
    steps_ += all.size();
    const Winding winding = edges_.winding(other);
    GridPoint a = all.back();
    for (const GridPoint b : all) {
      if (a.y > p.y && b.y <= p.y && turn(a, b, p) > 0)
        sum = sum + winding;
      else if (a.y <= p.y && b.y > p.y && turn(a, b, p) < 0)
        sum = sum - winding;
      a = b;
    }
  }
  return sum;
}

/// The strand whose stretch runs through the ring's leftmost point.
std::uint32_t CrossedRings::strand_at(const Ring& ring) const {
  const auto begin = order_.begin() + ring.first_cut, end = order_.begin() + ring.end_cut;
  const auto after = std::partition_point(
      begin, end, [&](std::uint32_t i) { return cuts_[i].edge < ring.leftmost; });
  return after == begin ? *(end - 1) : *(after - 1);
}

/// Takes a strand of which the winding numbers are known. Finds those of its ring, and of one
/// strand of each ring that this crosses.
void CrossedRings::go_along(std::uint32_t begin) {
  const std::uint32_t ring = strands_[begin].ring;
  const Winding own = edges_.winding(ring);
  std::uint32_t at = begin;
  do {
    const Winding before = strands_[at].right;
    at = strands_[at].next;
    const Strand& other = strands_[at ^ 1U];
    const Winding others = edges_.winding(other.ring);
    const Winding after = other.leftwards ? before - others : before + others;
    strands_[at].right = after;
    if (rings_[other.ring].is_known) continue;
    rings_[other.ring].is_known = true;
    // Before the crossing the other one has to its right what is beyond it, or to the left of it.
    strands_[other.previous].right = other.leftwards ? after : before + own;
    begun_.push_back(other.previous);
  } while (at != begin);
}

namespace {

/// Which way has the inside to the left.
enum class Way : std::uint8_t { kNone, kOn, kBack };

}  // namespace

/// Goes along the boundary.
class CrossedRings::Tracer {
 public:
  Tracer(const CrossedRings& of, Inside inside)
      : edges_(of.edges_),
        cuts_(of.cuts_),
        strands_(of.strands_),
        ways_(edges_.memory()),
        boundary_(edges_.memory()),
        is_cut_(edges_.memory()) {
    ways_.reserve(strands_.size());
    for (const Strand& strand : strands_)
      ways_.push_back(way_of(strand.ring, strand.right, inside));
    is_traced_.assign(strands_.size(), 0);
    for (std::uint32_t r = 0; r < of.rings_.size(); ++r)
      if (const Ring& ring = of.rings_[r]; ring.first_cut == ring.end_cut)
        add_ring(r, way_of(r, ring.right, inside));
  }

  std::optional<GridRings> run() {
    if (!trace_stretches() || meets_itself()) return std::nullopt;
    return std::move(boundary_);
  }

 private:
  [[nodiscard]] Way way_of(std::uint32_t ring, Winding right, Inside inside) const {
    const bool left = is_inside(right + edges_.winding(ring), inside);
    return left == is_inside(right, inside) ? Way::kNone : left ? Way::kOn : Way::kBack;
  }

  void add_ring(std::uint32_t ring, Way way) {
    if (way == Way::kNone) return;
    const std::uint32_t begin = edges_.first_point(ring);
    const auto size = static_cast<std::uint32_t>(edges_.ring(ring).size());
    boundary_.begin_ring({1, 0});
    for (std::uint32_t i = 0; i < size; ++i)
      add_point(begin + (way == Way::kBack ? size - 1 - i : i));
    boundary_.end_ring();
  }

  /// False where the boundary meets itself at a crossing, or may have no area.
  bool trace_stretches() {
    for (std::uint32_t i = 0; i < strands_.size(); ++i) {
      if (ways_[i] == Way::kNone || is_traced_[i] != 0) continue;
      boundary_.begin_ring({1, 0});
      if (!trace_from(i)) return false;
      boundary_.end_ring();
      const std::span<const GridPoint> ring = boundary_.ring(boundary_.rings() - 1);
      const GridBox box = box_of(ring);
      const std::int64_t extent =
          std::int64_t{box.upper.x} - box.lower.x + box.upper.y - box.lower.y;
      if (std::abs(twice_area(ring)) < 2 * kSliver * static_cast<double>(extent)) return false;
    }
    return true;
  }

  bool trace_from(std::uint32_t begin) {
    std::uint32_t stretch = begin;
    do {
      is_traced_[stretch] = 1;
      add_stretch(stretch);
      stretch = stretch_after(stretch);
      if (stretch == kNone) return false;
    } while (stretch != begin);
    return true;
  }

  /// The only other one of the four about a crossing that is boundary, if there is just one.
  [[nodiscard]] std::uint32_t stretch_after(std::uint32_t stretch) const {
    const bool back = ways_[stretch] == Way::kBack;
    const std::uint32_t at = back ? stretch : strands_[stretch].next, across = at ^ 1U;
    const std::uint32_t on = back ? strands_[at].previous : at;
    std::uint32_t found = kNone;
    const auto may_go = [&](std::uint32_t to, Way way) {
      if (ways_[to] == Way::kNone) return true;
      if (found != kNone || ways_[to] != way) return false;
      found = to;
      return true;
    };
    const bool is_one = may_go(on, back ? Way::kBack : Way::kOn) && may_go(across, Way::kOn) &&
                        may_go(strands_[across].previous, Way::kBack);
    return is_one ? found : kNone;
  }

  /// From the crossing where the boundary comes to it up to before the one where it leaves it.
  void add_stretch(std::uint32_t stretch) {
    const std::uint32_t next = strands_[stretch].next;
    const Cut &from = cuts_[stretch], &to = cuts_[next];
    const bool back = ways_[stretch] == Way::kBack;
    boundary_.add(back ? to.at : from.at);
    is_cut_.push_back(1);
    if (from.edge == to.edge && from.squared_way < to.squared_way) return;
    const std::uint32_t first = edges_.next(from.edge), last = to.edge;
    if (back) {
      const std::uint32_t begin = edges_.first_point(strands_[stretch].ring);
      const auto size = static_cast<std::uint32_t>(edges_.ring(strands_[stretch].ring).size());
      for (std::uint32_t i = last; i != first; i = i > begin ? i - 1 : begin + size - 1)
        add_point(i);
      add_point(first);
    } else {
      for (std::uint32_t i = first; i != last; i = edges_.next(i)) add_point(i);
      add_point(last);
    }
  }

  void add_point(std::uint32_t i) {
    boundary_.add(edges_.point(i));
    is_cut_.push_back(0);
  }

  /// Rounding has moved the edges at crossings.
  bool meets_itself() {
    if (boundary_.rings() == 0) return false;
    if (is_cut_.size() != boundary_.size()) return true;  // points coincide
    bool any_moved = false;
    for (std::uint32_t r = 0; r < boundary_.rings(); ++r) {
      const std::uint32_t begin = boundary_.begin(r), end = boundary_.end(r);
      const std::uint8_t first = is_cut_[begin];
      for (std::uint32_t i = begin; i < end; ++i) {
        is_cut_[i] |= i + 1 < end ? is_cut_[i + 1] : first;
        any_moved |= is_cut_[i] != 0;
      }
    }
    return any_moved && PlanarEdges(boundary_, is_cut_).any_meets();
  }

  const PlanarEdges& edges_;
  std::span<const Cut> cuts_;
  const std::pmr::vector<Strand>& strands_;
  std::pmr::vector<Way> ways_;  // of stretches
  std::pmr::vector<std::uint8_t> is_traced_{edges_.memory()};
  GridRings boundary_;
  std::pmr::vector<std::uint8_t> is_cut_;  // points of the boundary
};

std::optional<GridRings> CrossedRings::boundary(Inside inside) const {
  if (!are_known_) return std::nullopt;
  return Tracer(*this, inside).run();
}

}  // namespace routebench::overlay
