#include "config_sweep.hpp"

#include <set>

namespace routebench {
namespace {

/// More variants of one contender, or settings of one experiment, are taken for a slip.
constexpr std::size_t kMostCombinations = 10'000;

bool is_pair(const toml::node& node) {
  const toml::array* array = node.as_array();
  return array != nullptr && array->size() == 2 && (*array)[0].is_number() &&
         (*array)[1].is_number();
}

void require_shape(const ConfigEntry& point, ValueShape shape) {
  if (shape == ValueShape::kPair && !is_pair(*point.node))
    point.refuse_value("two numbers in brackets such as [0, 0]");
  if (shape == ValueShape::kSingle) static_cast<void>(point.value());
}

}  // namespace

std::string value_text(const ConfigEntry& point) {
  if (!is_pair(*point.node)) return to_string(point.value());
  const toml::array& pair = *point.node->as_array();
  return shown(pair[0]) + "," + shown(pair[1]);
}

Axis axis_of(const ConfigEntry& entry, std::string name, ValueShape shape) {
  const bool is_list =
      entry.node->is_array() && !(shape == ValueShape::kPair && is_pair(*entry.node));
  if (!is_list) {
    require_shape(entry, shape);
    return {std::move(name), {entry}, false};
  }
  Axis axis{std::move(name), entry.elements("values"), true};
  if (axis.points.empty())
    entry.refuse("an empty list sweeps over nothing; give a value, or several in a list");
  std::set<std::string> seen;
  for (const ConfigEntry& point : axis.points) {
    require_shape(point, shape);
    if (!seen.insert(value_text(point)).second)
      point.refuse("the value " + value_text(point) + " stands twice in the list");
  }
  return axis;
}

void for_each_combination(const std::vector<Axis>& axes,
                          const std::function<void(const Combination&)>& visit) {
  std::size_t count = 1;
  for (const Axis& axis : axes) {
    count *= axis.points.size();
    if (count > kMostCombinations)
      axis.points.front().refuse("the sweep has more than " + std::to_string(kMostCombinations) +
                                 " combinations; sweep over fewer values");
  }
  Combination at(axes.size(), 0);
  for (std::size_t done = 0; done < count; ++done) {
    visit(at);
    for (std::size_t i = axes.size(); i-- > 0;) {
      if (++at[i] < axes[i].points.size()) break;
      at[i] = 0;
    }
  }
}

std::string sweep_label(const std::vector<Axis>& axes, const Combination& combination) {
  std::string label;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (!axes[i].swept) continue;
    if (!label.empty()) label += ", ";
    label += axes[i].name + "=" + value_text(axes[i].points[combination[i]]);
  }
  return label;
}

}  // namespace routebench
