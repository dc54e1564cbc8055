#include "routebench/planning/loop_trees.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "routebench/geometry/region.hpp"
#include "routebench/planning/ring_path.hpp"
#include "routebench/planning/walls.hpp"

namespace routebench {
namespace {

constexpr std::size_t kPlaces = 32;  // of a loop from which it looks at others
// In steps: loops of neighbouring insets lie so near to each other; and so near the last loops of a
// corridor, where a further one finds no place between them.
constexpr double kBeside = 1.35;
constexpr double kFacing = 2.05;

class LoopTrees {
 public:
  explicit LoopTrees(const std::vector<Polygons>& insets) {
    for (const Polygons& inset : insets) {
      for (Ring& ring : rings_of(inset)) {
        boxes_.push_back(bounding_box(ring));
        tree_.push_back(static_cast<std::uint32_t>(loops_.size()));
        loops_.push_back({std::move(ring)});
      }
      first_.push_back(static_cast<std::uint32_t>(loops_.size()));
    }
    joined_.resize(loops_.size());
  }

  /// Joins loops of an inset to loops of another one, or of the same.
  void join(std::size_t inset, std::size_t other, double limit_mm, const PlanContext& context) {
    std::vector<Pair> pairs;
    for (std::uint32_t a = first_[inset]; a < first_[inset + 1]; ++a) {
      stop_if_asked(context);
      const std::vector<RingPlace> places = spread_places(loops_[a].ring, kPlaces);
      for (std::uint32_t b = first_[other]; b < first_[other + 1]; ++b) {
        if (tree_of(a) == tree_of(b) || !may_meet(boxes_[a], boxes_[b], limit_mm)) continue;
        const auto near = std::count_if(places.begin(), places.end(), [&](const RingPlace& place) {
          return nearest_place(loops_[b].ring, place.point).distance_mm <= limit_mm;
        });
        if (near > 0) pairs.push_back({a, b, near});
      }
    }
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const Pair& a, const Pair& b) { return a.places > b.places; });
    for (const Pair& pair : pairs) {
      const std::uint32_t a = tree_of(pair.a), b = tree_of(pair.b);
      if (a == b) continue;
      tree_[a] = b;
      joined_[pair.a].push_back(pair.b);
      joined_[pair.b].push_back(pair.a);
    }
  }

  /// The loops, those of each tree seen from its first.
  std::vector<InsetLoop> take() {
    std::vector<std::size_t> below(loops_.size(), 1);  // loops reached over one, itself included
    std::vector<bool> seen(loops_.size(), false);
    for (std::uint32_t root = 0; root < loops_.size(); ++root) {
      if (seen[root]) continue;
      seen[root] = true;
      std::vector<std::uint32_t> order{root};
      for (std::size_t i = 0; i < order.size(); ++i)
        for (const std::uint32_t next : joined_[order[i]]) {
          if (seen[next]) continue;
          seen[next] = true;
          loops_[next].is_root = false;
          loops_[order[i]].children.push_back(next);
          order.push_back(next);
        }
      for (auto loop = order.rbegin(); loop != order.rend(); ++loop) {
        std::vector<std::uint32_t>& children = loops_[*loop].children;
        for (const std::uint32_t child : children) below[*loop] += below[child];
        std::stable_sort(children.begin(), children.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return below[a] > below[b]; });
      }
    }
    return std::move(loops_);
  }

 private:
  struct Pair {
    std::uint32_t a, b;
    std::ptrdiff_t places;
  };

  std::uint32_t tree_of(std::uint32_t loop) {
    while (tree_[loop] != loop) loop = tree_[loop] = tree_[tree_[loop]];
    return loop;
  }

  static bool may_meet(const Box2& a, const Box2& b, double limit_mm) {
    return a.lower.x <= b.upper.x + limit_mm && b.lower.x <= a.upper.x + limit_mm &&
           a.lower.y <= b.upper.y + limit_mm && b.lower.y <= a.upper.y + limit_mm;
  }

  std::vector<InsetLoop> loops_;
  std::vector<Box2> boxes_;  // of loops
  std::vector<std::uint32_t>
      tree_;  // of loops: a loop of the same tree, itself if it stands for it
  std::vector<std::vector<std::uint32_t>> joined_;  // neighbours of loops
  std::vector<std::uint32_t> first_{0};             // loop of an inset; one more at the end
};

}  // namespace

std::vector<InsetLoop> loop_trees(const std::vector<Polygons>& insets, double step_mm,
                                  const PlanContext& context) {
  LoopTrees trees(insets);
  for (std::size_t i = 1; i < insets.size(); ++i) trees.join(i, i - 1, kBeside * step_mm, context);
  for (std::size_t i = 0; i < insets.size(); ++i) trees.join(i, i, kFacing * step_mm, context);
  return trees.take();
}

}  // namespace routebench
