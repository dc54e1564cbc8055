#pragma once
/// From a model's name to scores: the steps that `plan`, `slice` and experiments share.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "routebench/geometry/model.hpp"
#include "routebench/geometry/parallel.hpp"
#include "routebench/geometry/slice.hpp"
#include "routebench/geometry/types.hpp"
#include "routebench/harness/contender.hpp"
#include "routebench/harness/demand.hpp"
#include "routebench/harness/judge.hpp"
#include "routebench/harness/metrics.hpp"
#include "routebench/harness/task.hpp"
#include "routebench/planning/plugin.hpp"
#include "routebench/planning/registry.hpp"

namespace routebench {

struct ExperimentConfig;

/// A folder of the search path of plugins.
struct PluginFolder {
  std::string path;
  bool exists = false;
};

/// The planners of a program and the plugins that were looked at for them.
struct PlannerSet {
  Registry registry;
  std::vector<PluginRecord> plugins;  ///< one a file, in the order in which they were looked at,
                                      ///< refused ones included
  std::vector<PluginFolder> folders;  ///< that were searched
};

/// Registers the built-in planners, then what the given plugin files bring, then what the files on
/// the search path bring (see plugin_files.hpp): shared libraries, and Python files (.py). Each
/// library is loaded in a process of its own first. Must be called while this process has no other
/// thread.
[[nodiscard]] PlannerSet load_planners(std::span<const std::string> plugin_files);

/// Registers those of the names that are commands, such as "command:./my_planner --fast".
///
/// Takes  names of planners, others among them, and the folder in which the commands run; empty:
///        the current one.
/// Throws Error{kBadInput} naming the first command that is no planner and why.
void add_commands(PlannerSet& planners, std::span<const std::string> names,
                  const std::filesystem::path& folder = {});

/// The planners of an experiment: load_planners, then the commands in its slots, which run in the
/// config's folder. What a plugin or a command does is a result: one that is refused (it cannot be
/// started, crashes, says nothing sensible) is replaced by a planner that takes any parameters and
/// fails with the refusal as its reason, so that what needs it fails, and the rest goes on. If
/// plugins have been refused, that is done under every name that nobody knows.
///
/// Takes  the config's plugin files and those given beside it.
/// Throws Error{kBadInput} for what reading shows to be wrong: a plugin that does not exist, a
///        command without a word or with an open quote.
[[nodiscard]] PlannerSet load_planners_for(const ExperimentConfig& config,
                                           std::span<const std::string> plugin_files);

/// Throws Error{kBadInput} naming the first plugin that was asked for and refused, and why.
void require_all_loaded(const PlannerSet& planners);

struct SliceModelOptions {
  SliceMethod method = SliceMethod::kBucket;
  bool repair = false;     ///< see ModelOptions and SliceOptions
  bool find_skins = true;  ///< whether Layer::solid is wanted of layers that are not all dense
  bool hash_mesh = false;  ///< whether SlicedModel::mesh_hash is wanted
  std::optional<double> cell_mm =
      std::nullopt;  ///< for voxel: see SliceOptions; else the task's line width
  /// Told what container voxel is going to use, before it does.
  std::function<void(const VoxelContainer&)> on_container = {};
};

/// A model cut into layers; the mesh itself is no longer held.
struct SlicedModel {
  std::string spec;                        ///< as the user wrote it
  std::optional<MeshReport> mesh;          ///< nothing if the model is a file of layers
  std::optional<std::uint64_t> mesh_hash;  ///< see content_hash; nothing unless asked for
  SliceReport report;
  std::vector<std::string> warnings;  ///< of reading and slicing, one line each, without the spec
  std::vector<Layer> layers;          ///< with `solid` set if skins were asked for
  Point2 origin;  ///< lower corner of all layers together: where patterns are anchored
};

/// How a mesh is cut into the layers that all contenders of a task get.
[[nodiscard]] SliceOptions slicing_for(const Task& task, const SliceModelOptions& options);

/// Reads or makes a model, cuts it at the task's layer height and finds its skins.
///
/// Takes  a model spec (see load_model) or the path of a .wkt file of layers (see read_wkt), whose
///        layers must be as high as the task's.
/// Throws Error{kBadInput} for what cannot be used.
[[nodiscard]] SlicedModel slice_model(const std::string& spec, const Task& task,
                                      const SliceModelOptions& options,
                                      const ParallelFor& parallel_for);

/// What a task demands of each layer; layers of which it demands the same may share it.
using Demands = std::vector<std::shared_ptr<const Demand>>;

/// A sliced model with what a task demands of it.
struct PreparedModel {
  SlicedModel sliced;
  Demands demands;
};

/// What a task demands of each layer of a model, which may have been sliced for another task that
/// asks for the same layers. Skins are found in what the walls leave.
[[nodiscard]] Demands demands_of(const SlicedModel& sliced, const Task& task,
                                 const ParallelFor& parallel_for);

/// Slices a model and finds its demands. Layer::solid is set only where a whole layer is dense.
[[nodiscard]] PreparedModel prepare_model(const std::string& spec, const Task& task,
                                          const SliceModelOptions& options,
                                          const ParallelFor& parallel_for);

/// Places in `layers`, all of them: the selection of plan_layers and judge_layers that leaves
/// nothing out.
[[nodiscard]] std::vector<std::size_t> all_layers(const SlicedModel& sliced);

/// Of each chosen layer the place in `chosen` of the first one that has the same route for sure: an
/// equal layer with an equal demand, as the contender's planners promise; its own if there is none.
/// Cost   linear in vertices, times the different demands that equal layers have.
[[nodiscard]] std::vector<std::size_t> first_of_equal_routes(const Contender& contender,
                                                             const PreparedModel& model,
                                                             std::span<const std::size_t> chosen);

/// Whether each region is planned for itself, or takes over the route of one that came in an equal
/// layer, where its planner promises that its own would be equal (see PlannerInfo::repeats_every);
/// then no times are taken.
enum class Repeats { kPlan, kTakeOver };

/// Plans the chosen layers. Times are those of each call to plan() alone; wall times are to be
/// trusted only if no other thread competes, that is with serial_for.
///
/// Takes   places in the model's layers, ascending.
/// Returns one planned layer for each of them.
/// Throws  what Contender::plan throws, of the lowest such layer; under kTakeOver the first ones of
///         equal layers count before the others.
[[nodiscard]] std::vector<PlannedLayer> plan_layers(
    const Contender& contender, const PreparedModel& model, std::span<const std::size_t> chosen,
    const Task& task, std::uint64_t seed, std::stop_token stop, const ParallelFor& parallel_for,
    Repeats repeats = Repeats::kPlan);

/// A cell's scores.
struct JudgedCell {
  std::vector<LayerScore> layers;  ///< with plan_wall_ns and plan_cpu_ns
  Scores totals;                   ///< with both times; without peak_rss_bytes
  Verdict verdict;
};

/// Judges planned layers one above the other: each is entered from where the nearest chosen layer
/// below with a stroke ended.
/// Takes what plan_layers took and returned.
[[nodiscard]] JudgedCell judge_layers(const Judge& judge, const PreparedModel& model,
                                      std::span<const std::size_t> chosen,
                                      std::span<const PlannedLayer> planned,
                                      const ParallelFor& parallel_for);

/// Where the nozzle is after a route; nothing if it has no stroke.
[[nodiscard]] std::optional<Point2> end_of(const Route& route);

}  // namespace routebench
