#include "routebench/planning/params.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "routebench/geometry/error.hpp"

namespace routebench {
namespace {

std::string shortest(double value) {
  std::array<char, 64> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} ? std::string(text.data(), end) : std::string("?");
}

std::string range_text(Range range, const char* unit) {
  std::string text = "from " + shortest(range.lowest) + " to " + shortest(range.highest);
  if (*unit != '\0') text += std::string(" ") + unit;
  return text;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates) {
  const std::optional<std::string> near = nearest_name(word, candidates);
  return near ? " (did you mean '" + *near + "'?)" : "";
}

[[noreturn]] void refuse(const std::string& owner, const std::string& complaint) {
  throw Error(ErrorKind::kBadInput, owner + ": " + complaint);
}

[[noreturn]] void refuse_value(const std::string& owner, const char* name, const ParamValue& value,
                               const std::string& wanted) {
  const bool is_text = std::holds_alternative<std::string>(value);
  const std::string shown = is_text ? "'" + to_string(value) + "'" : to_string(value);
  refuse(owner, std::string("parameter ") + name + " = " + shown + ", but it must be " + wanted);
}

/// The number in a value, if it is one.
std::optional<double> number_in(const ParamValue& value) {
  if (const double* real = std::get_if<double>(&value)) return *real;
  if (const std::int64_t* whole = std::get_if<std::int64_t>(&value)) {
    return static_cast<double>(*whole);
  }
  return std::nullopt;
}

bool holds(Range range, double value) { return value >= range.lowest && value <= range.highest; }

}  // namespace

std::string to_string(const ParamValue& value) {
  struct Writer {
    std::string operator()(bool yes) const { return yes ? "true" : "false"; }
    std::string operator()(std::int64_t number) const { return std::to_string(number); }
    std::string operator()(double number) const { return shortest(number); }
    std::string operator()(const std::string& text) const { return text; }
  };
  return std::visit(Writer{}, value);
}

ParamBinder::ParamBinder() : owner_("planner") {}

ParamBinder::ParamBinder(std::string owner, ParamSet values)
    : owner_(std::move(owner)), values_(std::move(values)) {}

void ParamBinder::operator()(const char* name, double& member, Range range, const char* unit,
                             const char* help) {
  const ParamValue* given =
      declare({name, ParamType::kReal, member, range.lowest, range.highest, {}, unit, help});
  if (given != nullptr) {
    const std::optional<double> number = number_in(*given);
    if (!number || !holds(range, *number)) {
      refuse_value(owner_, name, *given, "a number " + range_text(range, unit));
    }
    member = *number;
  }
  resolved_[name] = member;
}

void ParamBinder::operator()(const char* name, int& member, Range range, const char* unit,
                             const char* help) {
  const ParamValue* given = declare(
      {name, ParamType::kInt, std::int64_t{member}, range.lowest, range.highest, {}, unit, help});
  if (given != nullptr) {
    const std::int64_t* whole = std::get_if<std::int64_t>(given);
    if (whole == nullptr || !std::in_range<int>(*whole) ||
        !holds(range, static_cast<double>(*whole))) {
      refuse_value(owner_, name, *given, "a whole number " + range_text(range, unit));
    }
    member = static_cast<int>(*whole);
  }
  resolved_[name] = std::int64_t{member};
}

void ParamBinder::operator()(const char* name, bool& member, const char* help) {
  const ParamValue* given = declare({name, ParamType::kBool, member, {}, {}, {}, "", help});
  if (given != nullptr) {
    const bool* yes = std::get_if<bool>(given);
    if (yes == nullptr) refuse_value(owner_, name, *given, "true or false");
    member = *yes;
  }
  resolved_[name] = member;
}

std::size_t ParamBinder::bind_choice(const char* name, const std::vector<std::string>& names,
                                     std::size_t chosen, const char* help) {
  const ParamValue* given =
      declare({name, ParamType::kChoice, names.at(chosen), {}, {}, names, "", help});
  if (given != nullptr) {
    const std::string* word = std::get_if<std::string>(given);
    const auto found = word == nullptr ? names.end() : std::find(names.begin(), names.end(), *word);
    if (found == names.end()) {
      refuse_value(owner_, name, *given,
                   "one of " + joined(names) + did_you_mean(to_string(*given), names));
    }
    chosen = static_cast<std::size_t>(found - names.begin());
  }
  resolved_[name] = names[chosen];
  return chosen;
}

const ParamValue* ParamBinder::declare(ParamSchema schema) {
  if (resolved_.contains(schema.name)) {
    refuse(owner_, "binds parameter " + schema.name + " twice");
  }
  if (schema.lowest &&
      !holds({*schema.lowest, *schema.highest}, *number_in(schema.default_value))) {
    refuse(owner_, "default of parameter " + schema.name + " is outside of its own range");
  }
  schema_.push_back(std::move(schema));
  const auto given = values_.find(schema_.back().name);
  return given == values_.end() ? nullptr : &given->second;
}

void ParamBinder::finish() const {
  std::vector<std::string> known;
  for (const ParamSchema& param : schema_) known.push_back(param.name);
  for (const auto& [name, value] : values_) {
    if (resolved_.contains(name)) continue;
    refuse(owner_, "unknown parameter '" + name + "'" + did_you_mean(name, known) +
                       (known.empty() ? "; it has none" : "; known are " + joined(known)));
  }
}

}  // namespace routebench
