#pragma once
/// Parameters of planners: bound once, in one line each, from which schema, help, validation and
/// record come.

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "routebench/geometry/nearest_name.hpp"

namespace routebench {

using ParamValue = std::variant<bool, std::int64_t, double, std::string>;
using ParamSet = std::map<std::string, ParamValue>;

/// A value as a config would have it: true, 3, 0.25, "grid" (without the quotes).
[[nodiscard]] std::string to_string(const ParamValue& value);

enum class ParamType { kBool, kInt, kReal, kChoice };

/// One parameter, described.
struct ParamSchema {
  std::string name;
  ParamType type = ParamType::kReal;
  ParamValue default_value;
  std::optional<double> lowest;      ///< kInt, kReal
  std::optional<double> highest;     ///< kInt, kReal
  std::vector<std::string> choices;  ///< kChoice
  std::string unit;                  ///< empty if it has none
  std::string help;
};

/// Closed range of a number.
struct Range {
  double lowest;
  double highest;
};

/// One name of a choice.
template <typename Enum>
struct Choice {
  const char* name;
  Enum value;
};

/// Goes through a planner's parameters. A planner's `Params` has `void bind(ParamBinder& bind)`
/// with one line a parameter:
///
///     bind("angle_deg", angle_deg, {-180, 180}, "deg", "direction of the lines, 0 along x");
///
/// Constructed without values it collects the schema from the members' defaults; with values it
/// checks and assigns them.
class ParamBinder {
 public:
  ParamBinder();
  /// `owner` is named in messages, for example "planner rectilinear".
  ParamBinder(std::string owner, ParamSet values);

  void operator()(const char* name, double& member, Range range, const char* unit,
                  const char* help);
  void operator()(const char* name, int& member, Range range, const char* unit, const char* help);
  void operator()(const char* name, bool& member, const char* help);
  template <typename Enum>
  requires std::is_enum_v<Enum>
  void operator()(const char* name, Enum& member, std::initializer_list<Choice<Enum>> choices,
                  const char* help) {
    std::vector<std::string> names;
    std::size_t chosen = 0;
    for (const Choice<Enum>& choice : choices) {
      if (choice.value == member) chosen = names.size();
      names.emplace_back(choice.name);
    }
    chosen = bind_choice(name, names, chosen, help);
    member = (choices.begin() + chosen)->value;
  }

  /// A choice whose names are known at run time only. Takes and returns places in `names`.
  std::size_t bind_choice(const char* name, const std::vector<std::string>& names,
                          std::size_t chosen, const char* help);

  /// Throws Error{kBadInput} if a value was given for a name that nobody bound, with the nearest
  /// bound name.
  void finish() const;

  [[nodiscard]] const std::vector<ParamSchema>& schema() const noexcept { return schema_; }
  /// Every parameter with the value that it now has.
  [[nodiscard]] const ParamSet& resolved() const noexcept { return resolved_; }

 private:
  /// Notes a parameter; returns the value that was given for it, if any.
  const ParamValue* declare(ParamSchema schema);

  std::string owner_;
  ParamSet values_;
  std::vector<ParamSchema> schema_;
  ParamSet resolved_;
};

}  // namespace routebench
