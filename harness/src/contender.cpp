#include "routebench/harness/contender.hpp"

#include <algorithm>
#include <array>
#include <cfenv>
#include <cmath>
#include <exception>
#include <new>
#include <utility>

#include "island_tree.hpp"
#include "plan_memo.hpp"
#include "plan_timing.hpp"
#include "planner_process.hpp"
#include "routebench/geometry/error.hpp"

namespace routebench {
namespace {

constexpr std::array<std::string_view, 2> kOrderNames = {"island", "stage"};
constexpr std::array<std::string_view, 3> kKindNames = {"wall", "dense", "sparse"};

/// No printer reaches further, and arithmetic on the grid stays exact well beyond.
constexpr double kFarthestMm = 1e6;
constexpr double kWidestMm = 1e3;

std::unique_ptr<const Contender::Slot> checked_slot(const SlotSpec& slot, PlannerRole role,
                                                    const std::string& contender,
                                                    const Registry& registry) {
  const Registry::Entry& entry = registry.at(slot.planner);
  if (entry.info.role != role) {
    std::string known;
    for (const auto& [name, other] : registry.entries())
      if (other.info.role == role) known += (known.empty() ? "" : ", ") + name;
    throw Error(ErrorKind::kBadInput,
                "contender " + contender + ": " + slot.planner + " is no " +
                    std::string(to_string(role)) + " planner; name it as " +
                    std::string(to_string(entry.info.role)) +
                    ", or take one of: " + (known.empty() ? "(none is registered)" : known));
  }
  return std::unique_ptr<const Contender::Slot>(new Contender::Slot{
      .name = slot.planner,
      .params = entry.resolve(slot.params),
      .repeats_every = entry.info.repeats_every,
      .make = [make = entry.make, given = slot.params] { return make(given); }});
}

/// Spreads the seed of a run over its layers (finaliser of splitmix64: every bit of the input moves
/// every bit of the output).
std::uint64_t mixed_seed(std::uint64_t seed, int layer_index) {
  std::uint64_t x = seed + 0x9E3779B97F4A7C15u * (static_cast<std::uint64_t>(layer_index) + 1);
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
  return x ^ (x >> 31);
}

bool is_place(Point2 p) {
  return std::abs(p.x) <= kFarthestMm && std::abs(p.y) <= kFarthestMm;  // false for NaN
}

/// What is wrong with a route, or nothing.
std::string fault_of(const Route& route) {
  for (std::size_t i = 0; i < route.strokes.size(); ++i) {
    const Stroke& stroke = route.strokes[i];
    const auto which = [i] { return "stroke " + std::to_string(i) + " of the returned route "; };
    if (stroke.points.size() < 2)
      return which() + "has " + std::to_string(stroke.points.size()) +
             " points; it needs two or more";
    if (!(stroke.width_mm > 0 && stroke.width_mm <= kWidestMm))
      return which() + "has the width " + std::to_string(stroke.width_mm) +
             " mm; it must be positive and at most a metre";
    for (std::size_t k = 0; k < stroke.points.size(); ++k) {
      const Point2 p = stroke.points[k];
      if (!is_place(p))
        return which() + "has point " + std::to_string(k) + " at (" + std::to_string(p.x) + ", " +
               std::to_string(p.y) + "); coordinates must be finite and within a kilometre";
    }
  }
  return {};
}

/// Keeps how numbers are rounded, and which operations trap, as it was: a planner that changes it
/// must not change what the judge finds. Once a layer, for that takes as long as planning a small
/// island.
class KeptArithmetic {
 public:
  KeptArithmetic() { std::fegetenv(&before_); }
  ~KeptArithmetic() { std::fesetenv(&before_); }
  KeptArithmetic(const KeptArithmetic&) = delete;
  KeptArithmetic& operator=(const KeptArithmetic&) = delete;

 private:
  std::fenv_t before_{};
};

/// Puts one layer's route together, call by call.
class LayerAssembly {
 public:
  LayerAssembly(const Layer& layer, const Task& task, PlanContext context, PlanMemo* memo,
                bool timed)
      : layer_(layer), task_(task), context_(std::move(context)), memo_(memo), timed_(timed) {}

  /// Has one planner lay a region from where the nozzle is, and appends its route.
  void lay(const Contender::Slot* slot, StrokeKind kind, Polygons region) {
    if (slot == nullptr || region.empty()) return;
    stop_if_asked(context_);
    const Layer part{layer_.index,      layer_.z_mm, layer_.height_mm,
                     std::move(region), {},          layer_.repaired};
    context_.density = kind == StrokeKind::kSparse ? task_.density : 1;
    if (memo_ == nullptr || slot->repeats_every == 0) {
      append(kind, sound_plan(*slot, part), nullptr);
      return;
    }
    const PlanMemo::Question question{slot, part.index % slot->repeats_every, part.height_mm,
                                      context_.start, context_.density};
    const std::shared_ptr<const Route> known =
        memo_->route(question, part.polygons, [&] { return sound_plan(*slot, part); });
    append(kind, *known, known);
  }

  [[nodiscard]] Point2 nozzle() const { return context_.start; }
  [[nodiscard]] PlannedLayer take() { return std::move(planned_); }

 private:
  void append(StrokeKind kind, Route route, std::shared_ptr<const Route> shared) {
    if (route.strokes.empty()) return;
    planned_.parts.push_back({route.strokes.size(), std::move(shared)});
    context_.start = route.strokes.back().points.back();
    planned_.kinds.insert(planned_.kinds.end(), route.strokes.size(), kind);
    std::move(route.strokes.begin(), route.strokes.end(),
              std::back_inserter(planned_.route.strokes));
  }

  Route sound_plan(const Contender::Slot& slot, const Layer& part) {
    Route route = plan_part(slot, part);
    if (const std::string fault = fault_of(route); !fault.empty()) throw failure(slot.name, fault);
    return route;
  }

  Route plan_part(const Contender::Slot& slot, const Layer& part) {
    const std::string& name = slot.name;
    try {
      const Planner& planner = slot.planner();
      if (!timed_) return planner.plan(part, context_);
      PlanTime time;
      Route route = timed_plan(planner, part, context_, time);
      planned_.plan_wall_ns += time.wall_ns;
      planned_.plan_cpu_ns += time.cpu_ns;
      return route;
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const PlannerDied& death) {
      throw PlannerDied(blame(name, death.what()));
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::kStopped) throw;
      throw failure(name, error.what());
    } catch (const std::exception& error) {
      throw failure(name, error.what());
    } catch (...) {
      throw failure(name, "it threw something that is no std::exception");
    }
  }

  [[nodiscard]] std::string blame(const std::string& name, const std::string& what) const {
    return "planner " + name + ", layer " + std::to_string(layer_.index) + ": " + what;
  }
  [[nodiscard]] Error failure(const std::string& name, const std::string& what) const {
    return {ErrorKind::kBadInput, blame(name, what)};
  }

  const Layer& layer_;
  const Task& task_;
  PlanContext context_;
  PlanMemo* memo_;
  bool timed_;
  PlannedLayer planned_;
};

/// What has to be laid on one island.
struct IslandWork {
  Polygons walls;
  Polygons dense;
  Polygons sparse;
};

void share_out(const Polygons& regions, const IslandTree& tree, std::vector<IslandWork>& islands,
               Polygons IslandWork::*part) {
  for (const Polygon& region : regions) (islands[tree.island_of(region)].*part).push_back(region);
}

}  // namespace

std::string_view to_string(PlannerRole role) {
  return role == PlannerRole::kShell ? "shell" : "fill";
}

std::string_view to_string(LayerOrder order) {
  return kOrderNames[static_cast<std::size_t>(order)];
}

LayerOrder layer_order(std::string_view name) {
  const auto* found = std::find(kOrderNames.begin(), kOrderNames.end(), name);
  if (found == kOrderNames.end())
    throw Error(ErrorKind::kBadInput,
                "order '" + std::string(name) + "' is unknown; it is island or stage");
  return static_cast<LayerOrder>(found - kOrderNames.begin());
}

std::string_view to_string(StrokeKind kind) { return kKindNames[static_cast<std::size_t>(kind)]; }

Contender::Contender(ContenderSpec spec, const Registry& registry) : spec_(std::move(spec)) {
  if (!spec_.shell && !spec_.fill)
    throw Error(ErrorKind::kBadInput,
                (spec_.name.empty() ? "the contender" : "contender " + spec_.name + ": it") +
                    " has no planner; give it a shell, a fill or both");
  if (spec_.shell) shell_ = checked_slot(*spec_.shell, PlannerRole::kShell, spec_.name, registry);
  if (spec_.fill) fill_ = checked_slot(*spec_.fill, PlannerRole::kFill, spec_.name, registry);
}

double Contender::peak_rss_bytes() const {
  return std::max(routebench::peak_rss_bytes(shell_ ? shell_->made.get() : nullptr),
                  routebench::peak_rss_bytes(fill_ ? fill_->made.get() : nullptr));
}

PlannedLayer Contender::plan(const Layer& layer, const Demand& demand, const Task& task,
                             Point2 origin, std::uint64_t seed, std::stop_token stop,
                             PlanMemo* memo, bool timed) const {
  const KeptArithmetic kept;
  PlanContext context;
  context.start = task.start_mm;
  context.origin = origin;
  context.line_width_mm = task.line_width_mm;
  context.spacing_mm = task.spacing_mm();
  context.perimeters = task.perimeters;
  context.seed = mixed_seed(seed, layer.index);
  context.stop = std::move(stop);
  LayerAssembly assembly(layer, task, std::move(context), memo, timed);

  const auto lay = [&](IslandWork work) {
    assembly.lay(shell_.get(), StrokeKind::kWall, std::move(work.walls));
    assembly.lay(fill_.get(), StrokeKind::kDense, std::move(work.dense));
    assembly.lay(fill_.get(), StrokeKind::kSparse, std::move(work.sparse));
  };
  const Polygons walls = shell_ && task.perimeters > 0 ? demand.outline : Polygons{};
  const Polygons dense = fill_ ? demand.dense : Polygons{};
  const Polygons sparse = fill_ && task.density > 0 ? demand.sparse : Polygons{};
  if (spec_.order == LayerOrder::kStage || demand.outline.size() <= 1) {
    lay({walls, dense, sparse});
    return assembly.take();
  }

  IslandTree tree(demand.outline);
  std::vector<IslandWork> islands(demand.outline.size());
  for (std::size_t i = 0; i < walls.size(); ++i) islands[i].walls = {walls[i]};
  share_out(dense, tree, islands, &IslandWork::dense);
  share_out(sparse, tree, islands, &IslandWork::sparse);
  for (std::size_t i = 0; i < islands.size(); ++i) {
    const IslandWork& work = islands[i];
    if (work.walls.empty() && work.dense.empty() && work.sparse.empty()) tree.take(i);
  }
  while (const auto next = tree.nearest(assembly.nozzle())) {
    tree.take(*next);
    lay(std::move(islands[*next]));
  }
  return assembly.take();
}

}  // namespace routebench
