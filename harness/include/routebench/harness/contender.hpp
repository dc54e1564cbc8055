#pragma once
/// What is compared: planners with parameters that together print a layer.

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <numeric>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "routebench/geometry/slice.hpp"
#include "routebench/geometry/types.hpp"
#include "routebench/harness/demand.hpp"
#include "routebench/harness/slicer_spec.hpp"
#include "routebench/harness/task.hpp"
#include "routebench/planning/params.hpp"
#include "routebench/planning/planner.hpp"
#include "routebench/planning/registry.hpp"

namespace routebench {

/// The slot that planners of a role fill: "shell", "fill".
[[nodiscard]] std::string_view to_string(PlannerRole role);

struct SlotSpec {
  std::string planner;
  ParamSet params;  ///< as given; see Registry::Entry::resolve
};

/// What is printed before what.
enum class LayerOrder {
  kIsland,  ///< everything of one island before the next, islands by nearest boundary; planners get
            ///< one island at a time
  kStage,   ///< all walls, then all that is dense, then all that is sparse; planners get the whole
            ///< layer and choose the order of its islands themselves
};
/// "island", "stage".
[[nodiscard]] std::string_view to_string(LayerOrder order);
/// Throws Error{kBadInput} for an unknown name.
[[nodiscard]] LayerOrder layer_order(std::string_view name);

/// Planners in one or both slots, a foreign slicer, or a way of cutting layers.
struct ContenderSpec {
  std::string name;
  std::optional<SlotSpec> shell;
  std::optional<SlotSpec> fill;
  LayerOrder order = LayerOrder::kIsland;
  std::optional<SlicerSpec> slicer = std::nullopt;    ///< then there is no slot
  std::optional<SliceMethod> slicing = std::nullopt;  ///< likewise: cuts layers, plans nothing
};

/// What a stroke is for.
enum class StrokeKind : std::uint8_t { kWall, kDense, kSparse };
[[nodiscard]] std::string_view to_string(StrokeKind kind);  ///< "wall", "dense", "sparse"

/// Time inside plan().
struct PlanTime {
  std::int64_t wall_ns = 0;
  std::int64_t cpu_ns = 0;  ///< of the thread, or of the planner's own process
};

/// Consecutive strokes of a layer: what one call of a planner made.
struct PlannedPart {
  std::size_t strokes;
  std::shared_ptr<const Route> shared;  ///< the same for layers that have it in common, or nothing
};

struct PlannedLayer {
  Route route;
  std::vector<StrokeKind> kinds;  ///< one a stroke
  std::int64_t plan_wall_ns = 0;  ///< inside plan() alone, summed over its calls; see timed_plan
  std::int64_t plan_cpu_ns = 0;
  std::vector<PlannedPart> parts = {};  ///< of the route; nothing if it is not known
};

class PlanMemo;

/// A contender of planners, ready to plan. Immutable; plan() may be called from any thread.
class Contender {
 public:
  /// Makes no planner yet: that is done when it first plans, so that what a constructor does wrong
  /// costs a cell, as what plan() does.
  ///
  /// Throws Error{kBadInput} for unknown planners, a planner in the wrong slot, bad parameters, or
  /// no slot at all.
  Contender(ContenderSpec spec, const Registry& registry);

  /// Plans one layer: cuts nothing itself (see demand_of), hands each region to its planner, puts
  /// the strokes together in the contender's order.
  ///
  /// Takes  `origin`, which anchors patterns (lower corner of the model), and the seed of the whole
  ///        run: each layer's planners get one that is mixed from it and the layer's index;
  ///        whether to take times: of small islands the clock takes a fiftieth.
  /// Throws Error{kStopped} when asked to stop; Error{kBadInput} naming planner and layer if a
  ///        planner or its constructor throws anything else, or it returns a stroke of fewer than
  ///        two points, a coordinate that is not finite or a kilometre away, or a width that is not
  ///        positive or more than a metre. std::bad_alloc passes as it is; PlannerDied, if a
  ///        planner's own process has ended.
  /// Cost   beside the planners' own near-linear in the layer's vertices. With a memo, regions that
  ///        it knows from other layers of the same job cost no planning.
  [[nodiscard]] PlannedLayer plan(const Layer& layer, const Demand& demand, const Task& task,
                                  Point2 origin, std::uint64_t seed, std::stop_token stop,
                                  PlanMemo* memo = nullptr, bool timed = true) const;

  /// The most memory that planning has taken so far: of this process, or of a planner's own process
  /// if that took more.
  [[nodiscard]] double peak_rss_bytes() const;

  /// After how many layers its planners promise to repeat themselves; 0 if any of them does not.
  /// See PlannerInfo::repeats_every.
  [[nodiscard]] int repeats_every() const {
    return std::lcm(shell_ ? shell_->repeats_every : 1, fill_ ? fill_->repeats_every : 1);
  }

  [[nodiscard]] const ContenderSpec& spec() const noexcept { return spec_; }
  /// The slots' parameters, all of them.
  [[nodiscard]] const ParamSet& shell_params() const noexcept { return params_of(shell_); }
  [[nodiscard]] const ParamSet& fill_params() const noexcept { return params_of(fill_); }

  /// A planner that is made when it is first needed, from any thread.
  struct Slot {
    std::string name;
    ParamSet params;        ///< all of them
    int repeats_every = 0;  ///< see PlannerInfo
    std::function<std::unique_ptr<const Planner>()> make;
    mutable std::mutex making = {};  // once_flag does not outlive exceptions everywhere
    mutable std::unique_ptr<const Planner> made = nullptr;
    mutable std::atomic<const Planner*> ready = nullptr;  // made, for threads that need no lock

    /// Throws what the planner's constructor throws.
    [[nodiscard]] const Planner& planner() const {
      if (const Planner* const there = ready.load(std::memory_order_acquire)) return *there;
      const std::lock_guard lock(making);
      if (!made) made = make();
      ready.store(made.get(), std::memory_order_release);
      return *made;
    }
  };

 private:
  [[nodiscard]] static const ParamSet& params_of(const std::unique_ptr<const Slot>& slot) {
    static const ParamSet kNone;
    return slot ? slot->params : kNone;
  }

  ContenderSpec spec_;
  std::unique_ptr<const Slot> shell_;
  std::unique_ptr<const Slot> fill_;
};

}  // namespace routebench
