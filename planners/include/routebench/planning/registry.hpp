#pragma once
/// The planners that a program knows.

#include <concepts>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "routebench/planning/params.hpp"
#include "routebench/planning/planner.hpp"

namespace routebench {

/// How the names of planners begin that are commands of the user: "command:./my_planner --fast".
inline constexpr std::string_view kCommandPrefix = "command:";

/// What a planner can lay.
enum class PlannerRole { kShell, kFill };

struct PlannerInfo {
  /// A parameter at a value.
  struct Setting {
    std::string param;
    std::string value;
  };

  std::string name;  ///< as in configs: snake_case (see Registry::add_entry)
  PlannerRole role = PlannerRole::kFill;
  std::string summary;  ///< one line
  std::string source;   ///< author, year; empty if it is our own
  /// With any of these the planner does as its paper did and may leave the polygons, which the
  /// judge then calls off task; the conformance test leaves them out.
  std::vector<Setting> may_leave = {};
  /// A promise, kept at any parameters: layers with equal polygons and heights have equal routes if
  /// their indices differ by a multiple of this, whatever the seed. 0 promises nothing.
  int repeats_every = 0;
};

/// What a class must have to be registered.
template <typename P>
concept PlannerType = std::derived_from<P, Planner> &&
    requires(ParamBinder& bind, typename P::Params& params) {
  { P::info() } -> std::same_as<PlannerInfo>;
  requires std::constructible_from<P, const typename P::Params&>;
  requires std::default_initializable<typename P::Params>;
  params.bind(bind);
};

class Registry {
 public:
  struct Entry {
    PlannerInfo info;
    std::vector<ParamSchema> params;
    std::string origin;  ///< "built in" or the plugin's file
    /// Every parameter with its value; throws Error{kBadInput} for unknown, mistyped or
    /// out-of-range values.
    std::function<ParamSet(const ParamSet&)> resolve;
    /// Throws as resolve does.
    std::function<std::unique_ptr<const Planner>(const ParamSet&)> make;
  };

  /// Throws Error{kBadInput} if the name is taken; says by whom.
  template <PlannerType P>
  void add() {
    const std::string owner = "planner " + P::info().name;
    typename P::Params defaults;
    ParamBinder collect(owner, {});
    defaults.bind(collect);
    add_entry({P::info(), collect.schema(), origin_,
               [owner](const ParamSet& values) {
                 typename P::Params params;
                 ParamBinder bind(owner, values);
                 params.bind(bind);
                 bind.finish();
                 return bind.resolved();
               },
               [owner](const ParamSet& values) -> std::unique_ptr<const Planner> {
                 typename P::Params params;
                 ParamBinder bind(owner, values);
                 params.bind(bind);
                 bind.finish();
                 return std::make_unique<const P>(params);
               }});
  }

  /// Adds a planner that is no class of this process. Its name is snake_case, or begins with
  /// kCommandPrefix. Throws Error{kBadInput} as add does.
  void add_entry(Entry entry);

  /// Throws Error{kBadInput} with the nearest known name.
  [[nodiscard]] const Entry& at(const std::string& name) const;
  [[nodiscard]] const std::map<std::string, Entry>& entries() const noexcept { return entries_; }

  /// Where planners that are added from now on come from.
  void set_origin(std::string origin) { origin_ = std::move(origin); }
  [[nodiscard]] const std::string& origin() const noexcept { return origin_; }

 private:
  std::map<std::string, Entry> entries_;
  std::string origin_ = "built in";
};

}  // namespace routebench
