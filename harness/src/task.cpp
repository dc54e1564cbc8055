#include "routebench/harness/task.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <concepts>
#include <optional>
#include <span>
#include <system_error>
#include <type_traits>
#include <utility>

#include "routebench/geometry/error.hpp"
#include "routebench/geometry/nearest_name.hpp"

namespace routebench {

namespace {

/// What a key may be set to.
template <typename Value>
struct Rule;
template <>
struct Rule<double> {
  double lowest;
  double highest;
  std::string_view unit;
};
template <>
struct Rule<int> {
  int lowest;
  int highest;
};
template <>
struct Rule<Point2> {
  double furthest_mm;
};
template <typename Enum>
requires std::is_enum_v<Enum>
struct Rule<Enum> {
  std::span<const std::pair<std::string_view, Enum>> choices;
};
template <>
struct Rule<std::string> {
  std::span<const std::string_view> choices;
};

constexpr std::array<std::pair<std::string_view, RetractPolicy>, 3> kPolicies{{
    {"length", RetractPolicy::kLength},
    {"length_and_crossing", RetractPolicy::kLengthAndCrossing},
    {"manhattan", RetractPolicy::kManhattan},
}};

constexpr std::array<std::pair<std::string_view, SkinRule>, 3> kSkinRules{{
    {"difference", SkinRule::kDifference},
    {"slope", SkinRule::kSlope},
    {"near", SkinRule::kNear},
}};

constexpr std::array<std::string_view, 4> kFlavours{"marlin", "klipper", "reprap", "ultigcode"};

// One line a key, in the order of the struct; setting, listing and hints all go through these.

/// Takes a Task or a const Task, and a function of (name, member, rule).
template <typename AnyTask, typename Visit>
void visit_keys_of_task(AnyTask& task, Visit&& visit) {
  visit("layer_height_mm", task.layer_height_mm, Rule<double>{0.001, 100, "mm"});
  visit("line_width_mm", task.line_width_mm, Rule<double>{0.001, 100, "mm"});
  visit("perimeters", task.perimeters, Rule<int>{0, 10000});
  visit("density", task.density, Rule<double>{0, 1, ""});
  visit("skin_layers", task.skin_layers, Rule<int>{0, 100000});
  visit("skin_rule", task.skin_rule, Rule<SkinRule>{kSkinRules});
  visit("base_mm", task.base_mm, Rule<double>{0, 100000, "mm"});
  visit("join_mm", task.join_mm, Rule<double>{0, 10, "mm"});
  visit("start_mm", task.start_mm, Rule<Point2>{100000});
  visit("gate_covered_min", task.gate.covered_min, Rule<double>{0, 1, ""});
  visit("gate_skipped_max", task.gate.skipped_max, Rule<double>{0, 1, ""});
  visit("gate_worst_layer_max", task.gate.worst_layer_max, Rule<double>{0, 1, ""});
  visit("gate_deposit_min", task.gate.deposit_min, Rule<double>{0, 1000, ""});
  visit("gate_deposit_max", task.gate.deposit_max, Rule<double>{0, 1000, ""});
  visit("gate_outline_covered_min", task.gate.outline_covered_min, Rule<double>{0, 1, ""});
  visit("gate_spilled_max", task.gate.spilled_max, Rule<double>{0, 1000, ""});
  visit("gate_doubled_max", task.gate.doubled_max, Rule<double>{0, 1, ""});
  visit("gate_hollow_share_max", task.gate.hollow_share_max, Rule<double>{0, 1, ""});
}

template <typename AnyPrinter, typename Visit>
void visit_keys_of_printer(AnyPrinter& printer, Visit&& visit) {
  visit("retract_policy", printer.retract_policy, Rule<RetractPolicy>{kPolicies});
  visit("retract_over_mm", printer.retract_over_mm, Rule<double>{0, 100000, "mm"});
  visit("retract_mm", printer.retract_mm, Rule<double>{0, 1000, "mm"});
  visit("retract_mm_s", printer.retract_mm_s, Rule<double>{0.01, 100000, "mm/s"});
  visit("lift_mm", printer.lift_mm, Rule<double>{0, 1000, "mm"});
  visit("extrude_mm_s", printer.extrude_mm_s, Rule<double>{0.01, 100000, "mm/s"});
  visit("travel_mm_s", printer.travel_mm_s, Rule<double>{0.01, 100000, "mm/s"});
  visit("accel_mm_s2", printer.accel_mm_s2, Rule<double>{0.01, 10000000, "mm/s2"});
  visit("junction_mm", printer.junction_mm, Rule<double>{0, 100, "mm"});
  visit("jerk_mm_s", printer.jerk_mm_s, Rule<double>{0, 10000, "mm/s"});
  visit("filament_mm", printer.filament_mm, Rule<double>{0.01, 1000, "mm"});
  visit("flavour", printer.flavour, Rule<std::string>{kFlavours});
}

std::string text_of(double value) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  return {digits.data(), end};
}
std::string text_of(int value) { return std::to_string(value); }
std::string text_of(const std::string& value) { return value; }
std::string text_of(Point2 value) { return text_of(value.x) + "," + text_of(value.y); }

/// As text, by the rule where that has the names.
template <typename Value>
std::string text_of(const Value& value, const Rule<Value>& rule) {
  if constexpr (std::is_enum_v<Value>) {
    for (const auto& [name, choice] : rule.choices)
      if (choice == value) return std::string(name);
    throw Error(ErrorKind::kInternal, "a choice without a name");
  } else {
    return text_of(value);
  }
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

/// The number that all of a text is; nothing for anything else, infinities and NaN included.
template <typename Number>
std::optional<Number> number_in(std::string_view text) {
  text = trimmed(text);
  Number number{};
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (failure != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  if constexpr (std::floating_point<Number>)
    if (!std::isfinite(number)) return std::nullopt;
  return number;
}

/// Sets one key of one table from text.
class Setter {
 public:
  Setter(std::string_view table, std::string_view key, std::string_view text)
      : table_(table), key_(key), text_(text) {}

  template <typename Value>
  void operator()(std::string_view name, Value& member, const Rule<Value>& rule) {
    names_.emplace_back(name);
    if (name != key_) return;
    found_ = true;
    assign(member, rule);
  }

  /// To be called when all keys have been offered.
  void finish() const {
    if (found_) return;
    const std::optional<std::string> near = nearest_name(key_, names_);
    std::string known;
    if (!near)
      for (const std::string& name : names_) known += (known.empty() ? "" : ", ") + name;
    throw Error(ErrorKind::kBadInput,
                table_ + ": unknown key '" + std::string(key_) + "'; " +
                    (near ? "did you mean '" + *near + "'?" : "known keys are " + known));
  }

 private:
  void assign(double& member, const Rule<double>& rule) const {
    const std::optional<double> value = number_in<double>(text_);
    if (!value || *value < rule.lowest || *value > rule.highest)
      refuse("a number from " + text_of(rule.lowest) + " to " + text_of(rule.highest) +
             (rule.unit.empty() ? "" : " " + std::string(rule.unit)));
    member = *value + 0.0;  // -0 becomes 0: one value, one record
  }

  void assign(int& member, const Rule<int>& rule) const {
    const std::optional<int> value = number_in<int>(text_);
    if (!value || *value < rule.lowest || *value > rule.highest)
      refuse("a whole number from " + text_of(rule.lowest) + " to " + text_of(rule.highest));
    member = *value;
  }

  void assign(Point2& member, const Rule<Point2>& rule) const {
    const std::size_t comma = text_.find(',');
    const auto in_reach = [&rule](const std::optional<double>& value) {
      return value && std::abs(*value) <= rule.furthest_mm;
    };
    const std::optional<double> x = number_in<double>(text_.substr(0, comma));
    const std::optional<double> y =
        comma == text_.npos ? std::nullopt : number_in<double>(text_.substr(comma + 1));
    if (!in_reach(x) || !in_reach(y))
      refuse("two numbers \"x,y\" from " + text_of(-rule.furthest_mm) + " to " +
             text_of(rule.furthest_mm) + " mm");
    member = {*x + 0.0, *y + 0.0};
  }

  template <typename Enum>
  requires std::is_enum_v<Enum>
  void assign(Enum& member, const Rule<Enum>& rule) const {
    std::vector<std::string> names;
    for (const auto& [name, value] : rule.choices) {
      if (name == text_) {
        member = value;
        return;
      }
      names.emplace_back(name);
    }
    refuse_choice(names);
  }

  void assign(std::string& member, const Rule<std::string>& rule) const {
    std::vector<std::string> names;
    for (const std::string_view choice : rule.choices) {
      if (choice == text_) {
        member = choice;
        return;
      }
      names.emplace_back(choice);
    }
    refuse_choice(names);
  }

  [[noreturn]] void refuse(const std::string& right) const {
    throw Error(ErrorKind::kBadInput, table_ + ": " + std::string(key_) + " = '" +
                                          std::string(text_) + "' is not " + right);
  }

  [[noreturn]] void refuse_choice(const std::vector<std::string>& names) const {
    std::string right = names.size() == 1 ? "" : "one of ";
    for (const std::string& name : names) right += (&name == &names.front() ? "" : ", ") + name;
    if (const std::optional<std::string> near = nearest_name(text_, names); near)
      right += "; did you mean '" + *near + "'?";
    refuse(right);
  }

  std::string table_;
  std::string_view key_;
  std::string_view text_;
  std::vector<std::string> names_;
  bool found_ = false;
};

/// Puts keys with their values into a list.
auto lister(std::vector<KeyValue>& list) {
  return [&list](std::string_view name, const auto& member, const auto& rule) {
    list.push_back({std::string(name), text_of(member, rule)});
  };
}

}  // namespace

void set_task_value(Task& task, std::string_view key, std::string_view value) {
  Setter set("task", key, value);
  visit_keys_of_task(task, set);
  set.finish();
}

void set_printer_value(Printer& printer, std::string_view key, std::string_view value) {
  Setter set("printer", key, value);
  visit_keys_of_printer(printer, set);
  set.finish();
}

std::vector<KeyValue> task_values(const Task& task) {
  std::vector<KeyValue> list;
  visit_keys_of_task(task, lister(list));
  return list;
}

std::vector<KeyValue> printer_values(const Printer& printer) {
  std::vector<KeyValue> list;
  visit_keys_of_printer(printer, lister(list));
  return list;
}

void check_task(const Task& task) {
  if (task.line_width_mm < task.layer_height_mm)
    throw Error(ErrorKind::kBadInput,
                "task: line_width_mm = " + text_of(task.line_width_mm) +
                    " is less than layer_height_mm = " + text_of(task.layer_height_mm) +
                    "; a bead is at least as wide as it is high");
  if (task.gate.deposit_min > task.gate.deposit_max)
    throw Error(ErrorKind::kBadInput, "task: gate_deposit_min = " + text_of(task.gate.deposit_min) +
                                          " is more than gate_deposit_max = " +
                                          text_of(task.gate.deposit_max) + "; no route could pass");
}

}  // namespace routebench
