#include "eulerian/tree_coverage.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <unordered_map>
#include <utility>

#include "eulerian/loops.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench::eulerian {
namespace {

// Chains of so many nodes are laid twice rather than alone.
constexpr std::size_t kLongestSpur = 2;

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

  /// Joins loops that lie side by side but have no square between them, where that costs least.
  void join_others() {
    for_each_node([&](std::uint32_t a) {
      if (!loops_.holds(a)) return;
      double least_mm = std::numeric_limits<double>::max();
      std::array<std::uint32_t, 3> best{};
      for (const std::uint32_t step : steps_) {
        const std::uint32_t c = a + step;
        if (!loops_.holds(c) || loops_.same_loop(a, c) || !lattice_.joined(a, c)) continue;
        for (const std::uint32_t b : loops_.links(a))
          for (const std::uint32_t d : loops_.links(c)) {
            if (!is_neighbour(b, d) || !lattice_.joined(b, d)) continue;
            const double more_mm =
                length_mm(a, c) + length_mm(b, d) - length_mm(a, b) - length_mm(c, d);
            if (more_mm >= least_mm) continue;
            least_mm = more_mm;
            best = {b, c, d};
          }
      }
      if (best != std::array<std::uint32_t, 3>{}) loops_.join(a, best[0], best[1], best[2]);
    });
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
    for (const std::vector<std::uint32_t>& chain : chains())
      if (!hang_up(chain) && chain.size() > 1) strokes.lines.push_back(polyline(chain));
    for (std::vector<std::uint32_t>& walk : loops_.walks()) {
      walk.push_back(walk.front());
      strokes.loops.push_back(polyline(spurs_.empty() ? walk : with_spurs(walk)));
    }
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
        const double more_mm = length_mm(a, c) + length_mm(c, b) - length_mm(a, b);
        if (more_mm >= least_mm) continue;
        least_mm = more_mm;
        best = {a, b};
      }
    }
    if (best.first == kNone) return false;
    loops_.insert(best.first, best.second, c);
    return true;
  }

  /// Between the places of two nodes.
  [[nodiscard]] double length_mm(std::uint32_t a, std::uint32_t b) const {
    return distance(lattice_.place(a), lattice_.place(b));
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

  /// The nodes that no loop takes, each in one chain: begun at the ends of chains where that can
  /// be.
  [[nodiscard]] std::vector<std::vector<std::uint32_t>> chains() const {
    std::vector<std::uint32_t> open;
    for_each_node([&](std::uint32_t node) {
      if (is_open(node)) open.push_back(node);
    });
    std::vector<bool> taken(open.empty() ? 0 : lattice_.size());
    const auto goes = [&](std::uint32_t node, std::uint32_t step) {
      return is_open(node + step) && !taken[node + step] && lattice_.joined(node, node + step);
    };
    std::vector<std::vector<std::uint32_t>> chains;
    const auto follow = [&](std::uint32_t start) {
      std::vector<std::uint32_t>& chain = chains.emplace_back(1, start);
      taken[start] = true;
      for (std::uint32_t ahead = 0;;) {
        // Straight on, if that can be.
        if (ahead == 0 || !goes(chain.back(), ahead)) {
          const auto next = std::find_if(steps_.begin(), steps_.end(), [&](std::uint32_t step) {
            return goes(chain.back(), step);
          });
          if (next == steps_.end()) return;
          ahead = *next;
        }
        chain.push_back(chain.back() + ahead);
        taken[chain.back()] = true;
      }
    };
    for (const std::uint32_t node : open) {
      const auto ways = std::count_if(steps_.begin(), steps_.end(),
                                      [&](std::uint32_t step) { return goes(node, step); });
      if (!taken[node] && ways <= 1) follow(node);
    }
    for (const std::uint32_t node : open)
      if (!taken[node]) follow(node);
    return chains;
  }

  /// Makes a short chain a spur of a loop that passes its end: there and back, as a doubled edge of
  /// a tree is walked.
  bool hang_up(std::vector<std::uint32_t> chain) {
    if (chain.size() > kLongestSpur) return false;
    for (int end = 0; end < 2; ++end) {
      for (const std::uint32_t step : steps_) {
        const std::uint32_t node = chain.front() + step;
        if (!lattice_.has(node) || !loops_.holds(node) || spurs_.contains(node)) continue;
        if (!lattice_.joined(node, chain.front())) continue;
        spurs_.emplace(node, std::move(chain));
        return true;
      }
      std::reverse(chain.begin(), chain.end());
    }
    return false;
  }

  [[nodiscard]] std::vector<std::uint32_t> with_spurs(
      const std::vector<std::uint32_t>& walk) const {
    std::vector<std::uint32_t> longer;
    for (std::size_t i = 0; i < walk.size(); ++i) {
      longer.push_back(walk[i]);
      const auto spur = i > 0 ? spurs_.find(walk[i]) : spurs_.end();
      if (spur == spurs_.end()) continue;
      longer.insert(longer.end(), spur->second.begin(), spur->second.end());
      longer.insert(longer.end(), spur->second.rbegin() + 1, spur->second.rend());
      longer.push_back(walk[i]);
    }
    return longer;
  }

  const Lattice& lattice_;
  const PlanContext& context_;
  Steps steps_;
  Loops loops_;
  std::vector<std::uint32_t> waiting_, woken_;
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> spurs_;  // by their node in a loop
};

}  // namespace

TreeStrokes cover_by_tree(const Lattice& lattice, TreeOrder order, const PlanContext& context) {
  TreeWalk walk(lattice, context);
  walk.make_cells();
  walk.join_cells(order);
  walk.insert_others();
  walk.join_cells(order);
  walk.join_others();
  return walk.strokes();
}

}  // namespace routebench::eulerian
