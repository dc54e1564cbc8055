#include "eulerian/tree_coverage.hpp"

#include <array>
#include <cstddef>
#include <limits>
#include <utility>

#include "eulerian/loops.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench::eulerian {
namespace {

using Steps = std::array<std::uint32_t, 8>;

/// From a node to its neighbours: four in its row and column, then four across. Wraps round, as
/// unsigned numbers do.
Steps steps_of(const Lattice& lattice) {
  const std::uint32_t up = lattice.stride();
  return {1, up, 0U - 1, 0U - up, up + 1, up - 1, 0U - up - 1, 0U - up + 1};
}

/// See cover_by_tree.
class TreeWalk {
 public:
  TreeWalk(const Lattice& lattice, const PlanContext& context)
      : lattice_(lattice), context_(context), steps_(steps_of(lattice)), loops_(lattice) {}

  void make_cells() {
    // Where the cells begin is free: as many whole ones as can be.
    std::array<std::size_t, 4> whole{};
    for_each_node([&](std::uint32_t node) {
      if (is_square(node)) ++whole[phase(node)];
    });
    std::uint32_t best = 0;
    for (std::uint32_t p = 1; p < 4; ++p)
      if (whole[p] > whole[best]) best = p;
    for_each_node([&](std::uint32_t node) {
      if (phase(node) == best) loops_.add_square(node);
    });
    for_each_node([&](std::uint32_t node) { loops_.add_square(node); });
  }

  void join_cells(TreeOrder order) {
    if (order == TreeOrder::kFirst) {
      for_each_node([&](std::uint32_t node) {
        if (!loops_.join_across(node, true)) loops_.join_across(node, false);
      });
      return;
    }
    for (const bool level : {order == TreeOrder::kRows, order != TreeOrder::kRows})
      for_each_node([&](std::uint32_t node) { loops_.join_across(node, level); });
  }

  /// Takes nodes into the loops that pass by until no more can be.
  void insert_others() {
    for_each_node([&](std::uint32_t node) {
      if (is_open(node)) waiting_.push_back(node);
    });
    while (!waiting_.empty()) {
      insert_waiting([this](std::uint32_t node) { return insert_pair(node); });
      // Taking in one node may let in a pair beside it.
      insert_waiting([this](std::uint32_t node) { return insert_single(node); });
      std::swap(waiting_, woken_);
      woken_.clear();
    }
  }

  [[nodiscard]] TreeStrokes strokes() {
    TreeStrokes strokes;
    for (std::vector<std::uint32_t>& walk : loops_.walks()) {
      walk.push_back(walk.front());
      strokes.loops.push_back(polyline(walk));
    }
    take_chains(strokes.lines);
    return strokes;
  }

 private:
  template <typename Visit>
  void for_each_node(Visit&& visit) const {
    for (std::uint32_t node = lattice_.first(); node < lattice_.last(); ++node) {
      if ((node & 0xFFFU) == 0) stop_if_asked(context_);
      if (lattice_.has(node)) visit(node);
    }
  }

  [[nodiscard]] std::uint32_t phase(std::uint32_t node) const {
    return (lattice_.column(node) & 1U) | (lattice_.row(node) & 1U) << 1U;
  }
  [[nodiscard]] bool is_square(std::uint32_t node) const {
    return lattice_.joined_right(node) && lattice_.joined_up(node) &&
           lattice_.joined_right(node + lattice_.stride()) && lattice_.joined_up(node + 1);
  }
  /// A node that no loop passes.
  [[nodiscard]] bool is_open(std::uint32_t node) const {
    return lattice_.has(node) && !loops_.holds(node);
  }

  /// Goes through the nodes that wait, keeping those that have still to. The neighbours of what was
  /// taken in are woken.
  template <typename Insert>
  void insert_waiting(Insert&& insert) {
    std::vector<std::uint32_t> left;
    for (std::size_t i = 0; i < waiting_.size(); ++i) {
      const std::uint32_t node = waiting_[i];
      if (!is_open(node)) continue;
      if (insert(node)) {
        for (const std::uint32_t step : steps_)
          if (is_open(node + step)) woken_.push_back(node + step);
      } else {
        left.push_back(node);
      }
    }
    waiting_ = std::move(left);
  }

  /// Takes in a node with one beside it, where a link runs alongside both.
  bool insert_pair(std::uint32_t c) {
    for (std::size_t k = 0; k < 4; ++k) {
      const std::uint32_t d = c + steps_[k];
      if (!is_open(d) || !lattice_.joined(c, d)) continue;
      for (const std::size_t turn : {std::size_t{1}, std::size_t{3}}) {
        const std::uint32_t side = steps_[(k + turn) % 4];
        const std::uint32_t a = c + side, b = d + side;
        if (!lattice_.has(a) || !loops_.linked(a, b)) continue;
        if (!lattice_.joined(c, a) || !lattice_.joined(d, b)) continue;
        loops_.insert(a, b, c, d);
        return true;
      }
    }
    return false;
  }

  /// Takes in a node where that makes the loop longer by the least.
  bool insert_single(std::uint32_t c) {
    double least_mm = std::numeric_limits<double>::max();
    std::pair<std::uint32_t, std::uint32_t> best{kNone, kNone};
    for (std::size_t k = 0; k < 4; ++k) {
      const std::uint32_t a = c + steps_[k];
      if (!lattice_.has(a) || !loops_.holds(a) || !lattice_.joined(c, a)) continue;
      for (const std::uint32_t b : loops_.links(a)) {
        if (!is_neighbour(c, b) || !lattice_.joined(c, b)) continue;
        const Point2 pa = lattice_.place(a), pb = lattice_.place(b), pc = lattice_.place(c);
        const double more_mm = distance(pa, pc) + distance(pc, pb) - distance(pa, pb);
        if (more_mm >= least_mm) continue;
        least_mm = more_mm;
        best = {a, b};
      }
    }
    if (best.first == kNone) return false;
    loops_.insert(best.first, best.second, c);
    return true;
  }

  [[nodiscard]] bool is_neighbour(std::uint32_t a, std::uint32_t b) const {
    for (const std::uint32_t step : steps_)
      if (a + step == b) return true;
    return false;
  }

  [[nodiscard]] std::vector<Point2> polyline(const std::vector<std::uint32_t>& walk) const {
    std::vector<Point2> points{lattice_.place(walk.front())};
    for (std::size_t i = 1; i < walk.size(); ++i) lattice_.append_way(walk[i - 1], walk[i], points);
    return points;
  }

  /// Lines along the nodes that no loop takes.
  void take_chains(std::vector<std::vector<Point2>>& lines) {
    std::vector<std::uint32_t> open;
    for_each_node([&](std::uint32_t node) {
      if (is_open(node)) open.push_back(node);
    });
    std::vector<bool> taken(open.empty() ? 0 : lattice_.size());
    const auto next_of = [&](std::uint32_t node, std::size_t ahead) -> std::size_t {
      for (std::size_t k = 0; k <= steps_.size(); ++k) {
        const std::size_t way = k == 0 ? ahead : k - 1;
        if (way == steps_.size()) continue;
        const std::uint32_t other = node + steps_[way];
        if (is_open(other) && !taken[other] && lattice_.joined(node, other)) return way;
      }
      return steps_.size();
    };
    const auto neighbours = [&](std::uint32_t node) {
      int count = 0;
      for (const std::uint32_t step : steps_)
        if (is_open(node + step) && lattice_.joined(node, node + step)) ++count;
      return count;
    };
    for (const int most_neighbours : {1, 8})
      for (const std::uint32_t start : open) {
        if (taken[start] || neighbours(start) > most_neighbours) continue;
        std::vector<std::uint32_t> chain{start};
        taken[start] = true;
        for (std::size_t way = next_of(start, steps_.size()); way < steps_.size();
             way = next_of(chain.back(), way)) {
          chain.push_back(chain.back() + steps_[way]);
          taken[chain.back()] = true;
        }
        if (chain.size() > 1) lines.push_back(polyline(chain));
      }
  }

  const Lattice& lattice_;
  const PlanContext& context_;
  Steps steps_;
  Loops loops_;
  std::vector<std::uint32_t> waiting_, woken_;
};

}  // namespace

TreeStrokes cover_by_tree(const Lattice& lattice, TreeOrder order, const PlanContext& context) {
  TreeWalk walk(lattice, context);
  walk.make_cells();
  walk.join_cells(order);
  walk.insert_others();
  walk.join_cells(order);
  return walk.strokes();
}

}  // namespace routebench::eulerian
