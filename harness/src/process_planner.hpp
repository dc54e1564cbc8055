#pragma once
/// Planners that are programs: what is said to them, what they answer, and how they are registered.
/// The protocol stands in planners/README.md.

#include <memory>
#include <span>
#include <string>

#include "plan_timing.hpp"
#include "planner_process.hpp"
#include "routebench/planning/plugin.hpp"
#include "routebench/planning/registry.hpp"

namespace routebench {

/// Grows whenever a program that speaks the older protocol would misunderstand the newer one.
inline constexpr int kPlannerProtocol = 1;

/// The processes of one command: as many as are asked at the same time, each started by the process
/// that asks it.
class PlannerProcesses;

/// A planner behind the protocol. Sees each layer relative to the model's corner, so its routes
/// move with the model, and its coordinates are put on the grid.
class ProcessPlanner final : public Planner {
 public:
  ProcessPlanner(std::shared_ptr<PlannerProcesses> processes, std::string name, ParamSet params);

  /// Throws also PlannerDied and Error{kBadInput} saying what was wrong with the answer;
  /// std::bad_alloc if the planner's process has no more memory.
  [[nodiscard]] Route plan(const Layer& layer, const PlanContext& context) const override;
  /// The same. Times are taken round plan() in its process if that is the host of Python planners,
  /// else from the request to the answer; starting it does not count.
  [[nodiscard]] Route plan(const Layer& layer, const PlanContext& context, PlanTime& times) const;

  /// The most memory that one of its processes has had.
  [[nodiscard]] std::uint64_t peak_rss_bytes() const;

 private:
  std::shared_ptr<PlannerProcesses> processes_;
  std::string name_;
  ParamSet params_;
};

/// True for the name of a file that holds planners in Python.
[[nodiscard]] bool is_python_plugin(const std::string& file);

/// Registers the planners of a Python file, in the way of load_plugin.
[[nodiscard]] PluginRecord load_python_plugin(Registry& registry, const std::string& file);

/// True for a planner's name that is a command: "command:./my_planner --fast".
[[nodiscard]] bool is_command(const std::string& planner);

/// Registers the planner that a command describes under the command's own name, in the way of
/// load_plugin. Words are split at white space; quotes keep them together; there is no shell.
///
/// Takes   the folder in which it runs; empty: here.
/// Returns a record whose fingerprint covers the words and the files that they name.
/// Throws  Error{kBadInput} if there are no words, or a quote is not closed.
[[nodiscard]] PluginRecord load_command(Registry& registry, const std::string& planner,
                                        const std::filesystem::path& folder);

}  // namespace routebench
