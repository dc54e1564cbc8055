#include "routebench/harness/config.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <functional>
#include <limits>
#include <set>
#include <sstream>
#include <system_error>
#include <tuple>

#include "config_claims.hpp"
#include "config_sweep.hpp"
#include "config_table.hpp"
#include "routebench/geometry/error.hpp"

namespace routebench {
namespace {

constexpr std::uintmax_t kMostBytes = 4u << 20;
constexpr std::size_t kMostCells = 1'000'000;
constexpr std::size_t kLongestName = 100;
constexpr std::int64_t kHighestSeed = std::numeric_limits<std::int64_t>::max();
constexpr const char* kSlotExample = "{ planner = \"rectilinear\", angle_deg = 45 }";

const std::vector<std::string> kTopKeys{"name",      "seed",  "models",   "optional_models",
                                        "plugins",   "task",  "printer",  "run",
                                        "contender", "claim", "published"};
const std::vector<std::string> kRunKeys{"repetitions", "timeout_s", "memory_mb", "jobs",
                                        "keep_layers"};
const std::vector<std::string> kContenderKeys{"name",  "shell",  "fill",
                                              "order", "slicer", "slicing"};

/// The name is a folder under results/.
std::string read_name(const ConfigTable& top) {
  const ConfigEntry entry = top.at("name");
  const std::string name = entry.text();
  const bool plain = std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_' || c == '.';
  });
  if (name.empty() || name.size() > kLongestName || name.front() == '.' || !plain)
    entry.refuse_value("made of letters, digits, - _ and . (it names the folder of the results)");
  return name;
}

std::vector<std::uint64_t> read_seeds(const ConfigTable& top) {
  const std::optional<ConfigEntry> entry = top.find("seed");
  if (!entry) return {1};
  std::vector<std::uint64_t> seeds;
  for (const ConfigEntry& point : axis_of(*entry, "seed", ValueShape::kSingle).points)
    seeds.push_back(static_cast<std::uint64_t>(point.whole_number(0, kHighestSeed)));
  return seeds;
}

std::string beside(const std::filesystem::path& config, const std::string& path) {
  return (config.parent_path() / path).string();
}

std::vector<ConfiguredModel> read_models(const ConfigTable& top,
                                         const std::filesystem::path& file) {
  std::vector<ConfiguredModel> models;
  std::set<std::string> seen;
  const auto read_list = [&](const ConfigEntry& list, const std::string& key, bool optional) {
    for (const ConfigEntry& element : list.elements(key)) {
      const std::string spec = element.text();
      if (spec.empty()) element.refuse("an empty text is no model");
      if (!seen.insert(spec).second) element.refuse("the model " + spec + " stands twice");
      const bool is_path = !spec.starts_with("shape:") && !spec.starts_with("cgal:");
      models.push_back({spec, is_path ? beside(file, spec) : spec, optional});
    }
  };
  const ConfigEntry list = top.at("models");
  read_list(list, "models", false);
  if (models.empty()) list.refuse("an empty list; an experiment needs a model");
  if (const std::optional<ConfigEntry> more = top.find("optional_models"))
    read_list(*more, "optional_models", true);
  return models;
}

std::vector<std::string> read_plugins(const ConfigTable& top, const std::filesystem::path& file) {
  std::vector<std::string> plugins;
  if (const std::optional<ConfigEntry> entry = top.find("plugins"))
    for (const ConfigEntry& element : entry->elements("plugin files"))
      plugins.push_back(beside(file, element.text()));
  return plugins;
}

KeepLayers read_keep_layers(const ConfigEntry& entry) {
  constexpr std::int64_t kHighestLayer = 10'000'000;
  KeepLayers keep;
  if (entry.node->is_array()) {
    keep.rule = KeepLayers::Rule::kListed;
    for (const ConfigEntry& element : entry.elements("layer indices"))
      keep.listed.push_back(static_cast<std::size_t>(element.whole_number(0, kHighestLayer)));
    std::sort(keep.listed.begin(), keep.listed.end());
    keep.listed.erase(std::unique(keep.listed.begin(), keep.listed.end()), keep.listed.end());
    return keep;
  }
  const toml::value<std::string>* word = entry.node->as_string();
  if (word != nullptr && word->get() == "middle")
    keep.rule = KeepLayers::Rule::kMiddle;
  else if (word != nullptr && word->get() == "all")
    keep.rule = KeepLayers::Rule::kAll;
  else if (word != nullptr && word->get() == "none")
    keep.rule = KeepLayers::Rule::kNone;
  else
    entry.refuse_value("\"middle\", \"all\", \"none\" or a list of layer indices");
  return keep;
}

RunOptions read_run(const ConfigTable& top, const std::string& file) {
  RunOptions run;
  const std::optional<ConfigEntry> entry = top.find("run");
  if (!entry) return run;
  const ConfigTable table(file, "[run]", entry->table("[run]"));
  table.require_known(kRunKeys);
  if (const auto found = table.find("repetitions"))
    run.repetitions = static_cast<int>(found->whole_number(1, 10'000));
  if (const auto found = table.find("timeout_s")) run.timeout_s = found->number(0.01, 1e6);
  if (const auto found = table.find("memory_mb"))
    run.memory_mb = static_cast<int>(found->whole_number(16, 16 << 20));
  if (const auto found = table.find("jobs"))
    run.jobs = static_cast<int>(found->whole_number(0, 1024));
  if (const auto found = table.find("keep_layers")) run.keep_layers = read_keep_layers(*found);
  return run;
}

/// A table whose keys and values go through a text interface: [task] and [printer].
struct BoundTable {
  std::vector<KeyValue> defaults;
  std::function<void(Setting&, const std::string& key, const std::string& value)> set;
};

/// Values that a text interface takes are told apart by how their defaults are written.
bool is_number(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

/// The axes of a bound table; checks that numbers are given for numbers and texts for texts. The
/// table may have a `name`, too, if it is `named`.
std::vector<Axis> bound_axes(const ConfigTable& table, const BoundTable& bound, bool named) {
  std::map<std::string, std::string> defaults;
  std::vector<std::string> known;
  for (const KeyValue& pair : bound.defaults) {
    defaults[pair.key] = pair.value;
    known.push_back(pair.key);
  }
  if (named) known.emplace_back("name");
  table.require_known(known);
  std::vector<Axis> axes;
  for (const ConfigEntry& found : table.entries()) {
    if (named && found.key == "name") continue;
    const std::string& standard = defaults[found.key];
    const bool pair = standard.find(',') != std::string::npos;
    axes.push_back(axis_of(found, found.key, pair ? ValueShape::kPair : ValueShape::kSingle));
    for (const ConfigEntry& point : axes.back().points) {
      if (pair) continue;
      if (is_number(standard) && !point.node->is_number()) point.refuse_value("a number");
      if (!is_number(standard) && point.node->is_number()) point.refuse_value("a text in quotes");
    }
  }
  return axes;
}

/// One [task], or one of several [[task]] with a name each.
struct TaskTable {
  std::string name;
  std::vector<Axis> axes;
};

std::vector<TaskTable> read_tasks(const ConfigTable& top, const BoundTable& bound,
                                  const std::string& file) {
  const std::optional<ConfigEntry> entry = top.find("task");
  if (!entry) return {{}};
  if (!entry->node->is_array_of_tables())
    return {{"", bound_axes({file, "[task]", entry->table("[task]")}, bound, false)}};
  std::vector<TaskTable> tasks;
  std::map<std::string, std::string> places;
  for (const toml::node& node : *entry->node->as_array()) {
    const ConfigTable table(file, "[[task]]", *node.as_table());
    const ConfigEntry name = table.at("name");
    if (name.text().empty()) name.refuse("must not be empty");
    const auto [taken, is_new] = places.emplace(name.text(), name.place);
    if (!is_new)
      name.refuse("the name " + taken->first + " is taken by the task at " + taken->second);
    tasks.push_back({name.text(), bound_axes(table, bound, true)});
  }
  return tasks;
}

/// Checks what task keys ask of each other.
void require_consistent(const Setting& setting, const ConfigTable& top) {
  try {
    check_task(setting.task);
  } catch (const Error& error) {
    // The defaults agree with each other, so there is a task to blame.
    top.at("task").refuse(error.what());
  }
}

std::vector<Setting> read_settings(const ConfigTable& top, const std::string& file) {
  const BoundTable bound_task{
      task_values(Task{}), [](Setting& setting, const std::string& key, const std::string& value) {
        set_task_value(setting.task, key, value);
      }};
  const BoundTable bound_printer{
      printer_values(Printer{}),
      [](Setting& setting, const std::string& key, const std::string& value) {
        set_printer_value(setting.printer, key, value);
      }};
  std::vector<Axis> printer_axes;
  if (const std::optional<ConfigEntry> entry = top.find("printer"))
    printer_axes = bound_axes({file, "[printer]", entry->table("[printer]")}, bound_printer, false);

  std::vector<Setting> settings;
  for (TaskTable& task : read_tasks(top, bound_task, file)) {
    std::vector<Axis>& axes = task.axes;
    const std::size_t task_axes = axes.size();
    axes.insert(axes.end(), printer_axes.begin(), printer_axes.end());
    for_each_combination(axes, [&](const Combination& combination) {
      Setting setting;
      setting.label = sweep_label(axes, combination);
      if (!task.name.empty())
        setting.label = task.name + (setting.label.empty() ? "" : ", " + setting.label);
      for (std::size_t i = 0; i < axes.size(); ++i) {
        const ConfigEntry& point = axes[i].points[combination[i]];
        try {
          (i < task_axes ? bound_task : bound_printer).set(setting, point.key, value_text(point));
        } catch (const Error& error) {
          point.refuse(error.what());
        }
      }
      require_consistent(setting, top);
      settings.push_back(std::move(setting));
    });
  }
  return settings;
}

/// Adds the axes of a slot; `slot` is "shell" or "fill".
void add_slot_axes(const ConfigTable& contender, const char* slot, const std::string& file,
                   std::vector<Axis>& axes) {
  const std::optional<ConfigEntry> entry = contender.find(slot);
  if (!entry) return;
  const ConfigTable table(file, "`" + std::string(slot) + "`", entry->table(kSlotExample));
  const std::optional<ConfigEntry> command = table.find("command");
  if (!command) static_cast<void>(table.at("planner").node);
  if (command && table.find("planner"))
    command->refuse("the slot has a `planner`, too; give one of them");
  for (ConfigEntry& found : table.entries()) {
    std::string name = std::string(slot) + "." + found.key;
    found.key = name;
    axes.push_back(axis_of(found, std::move(name), ValueShape::kSingle));
  }
}

LayerOrder read_order(const ConfigEntry& point) {
  const toml::value<std::string>* word = point.node->as_string();
  if (word != nullptr && word->get() == "island") return LayerOrder::kIsland;
  if (word != nullptr && word->get() == "stage") return LayerOrder::kStage;
  point.refuse_value("\"island\" or \"stage\"");
}

/// Names of slicers, or one table with a command.
Axis slicer_axis(const ConfigEntry& entry) {
  if (entry.node->is_table()) return {entry.key, {entry}, false};
  return axis_of(entry, entry.key, ValueShape::kSingle);
}

/// Relative paths of programs begin at the config's folder.
SlicerSpec read_slicer(const ConfigEntry& point, const std::string& file) {
  SlicerSpec slicer;
  slicer.folder = beside(file, "");
  if (point.node->is_table()) {
    const ConfigTable table(file, "`slicer`", point.table(""));
    table.require_known({"command"});
    slicer.command = table.at("command").text();
    if (slicer.command.empty()) point.refuse("the command is empty");
  } else {
    slicer.name = point.text();
  }
  try {
    check_slicer(slicer);
  } catch (const Error& error) {
    point.refuse(error.what());
  }
  return slicer;
}

SliceMethod read_slicing(const ConfigEntry& point) {
  try {
    return slice_method(point.text());
  } catch (const Error& error) {
    point.refuse(error.what());
  }
}

/// Puts the value of one axis where it belongs.
void apply(const Axis& axis, const ConfigEntry& point, const std::string& file,
           ConfiguredContender& contender) {
  contender.key_places[axis.name] = point.place;
  if (axis.name == "order") {
    contender.spec.order = read_order(point);
    return;
  }
  if (axis.name == "slicer") {
    contender.spec.slicer = read_slicer(point, file);
    return;
  }
  if (axis.name == "slicing") {
    contender.spec.slicing = read_slicing(point);
    return;
  }
  const std::size_t dot = axis.name.find('.');
  std::optional<SlotSpec>& slot =
      axis.name.substr(0, dot) == "shell" ? contender.spec.shell : contender.spec.fill;
  if (!slot) slot.emplace();
  const std::string key = axis.name.substr(dot + 1);
  if (key == "planner") {
    slot->planner = point.text();
  } else if (key == "command") {
    slot->planner = std::string(kCommandPrefix) + point.text();
    contender.key_places[axis.name.substr(0, dot) + ".planner"] = point.place;
  } else {
    slot->params[key] = point.value();
  }
}

/// Adds the points of a [[contender]]'s sweep; `places` says where each name was given.
void add_contenders(const ConfigTable& table, const std::string& file,
                    std::map<std::string, std::string>& places,
                    std::vector<ConfiguredContender>& contenders) {
  table.require_known(kContenderKeys);
  const ConfigEntry name = table.at("name");
  if (name.text().empty()) name.refuse("must not be empty");
  for (const char* whole : {"slicer", "slicing"})
    if (table.find(whole))
      for (const char* other : {"shell", "fill", "order", "slicer", "slicing"})
        if (const auto found = table.find(other); found && std::string_view(other) != whole)
          found->refuse("a contender with a `" + std::string(whole) +
                        "` has no planners; give either");
  if (!table.find("slicer") && !table.find("slicing") && !table.find("shell") &&
      !table.find("fill"))
    name.refuse("the contender has neither `shell` nor `fill` nor `slicer`; give at least one");

  std::vector<Axis> axes;
  if (const auto slicer = table.find("slicer")) axes.push_back(slicer_axis(*slicer));
  if (const auto slicing = table.find("slicing"))
    axes.push_back(axis_of(*slicing, "slicing", ValueShape::kSingle));
  add_slot_axes(table, "shell", file, axes);
  add_slot_axes(table, "fill", file, axes);
  if (const auto order = table.find("order"))
    axes.push_back(axis_of(*order, "order", ValueShape::kSingle));
  std::stable_sort(axes.begin(), axes.end(), [](const Axis& a, const Axis& b) {
    return std::tie(a.points.front().line, a.points.front().column) <
           std::tie(b.points.front().line, b.points.front().column);
  });

  for_each_combination(axes, [&](const Combination& combination) {
    ConfiguredContender contender;
    contender.base_name = name.text();
    contender.place = name.place;
    for (std::size_t i = 0; i < axes.size(); ++i)
      apply(axes[i], axes[i].points[combination[i]], file, contender);
    const std::string label = sweep_label(axes, combination);
    contender.spec.name = contender.base_name + (label.empty() ? "" : " [" + label + "]");
    const auto [taken, is_new] = places.emplace(contender.spec.name, name.place);
    if (!is_new)
      name.refuse("the name " + taken->first + " is taken by the contender at " + taken->second);
    contenders.push_back(std::move(contender));
  });
}

std::vector<ConfiguredContender> read_contenders(const ConfigTable& top, const std::string& file) {
  std::vector<ConfiguredContender> contenders;
  const ConfigEntry list = top.at("contender");
  if (!list.node->is_array_of_tables())
    list.refuse_value("one or more tables, each headed [[contender]]");
  std::map<std::string, std::string> places;
  for (const toml::node& node : *list.node->as_array())
    add_contenders(ConfigTable(file, "[[contender]]", *node.as_table()), file, places, contenders);
  return contenders;
}

/// Throws Error{kBadInput} for more cells than anybody can mean.
void require_manageable(const ExperimentConfig& config) {
  std::size_t cells = 1;
  for (const std::size_t factor : {config.models.size(), config.contenders.size(),
                                   config.settings.size(), config.seeds.size()}) {
    cells *= factor;
    if (cells > kMostCells)
      throw Error(ErrorKind::kBadInput, config.file.string() + ": the experiment has more than " +
                                            std::to_string(kMostCells) +
                                            " cells; sweep over fewer values");
  }
}

toml::table parse_toml(const std::string& text, const std::string& file) {
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    const toml::source_position at = error.source().begin;
    throw Error(ErrorKind::kBadInput, file + ":" + std::to_string(at.line) + ":" +
                                          std::to_string(at.column) + ": " +
                                          std::string(error.description()));
  }
}

}  // namespace

std::vector<std::size_t> KeepLayers::of(std::size_t layer_count) const {
  std::vector<std::size_t> kept;
  if (layer_count == 0) return kept;
  switch (rule) {
    case Rule::kNone:
      break;
    case Rule::kMiddle:
      kept.push_back(layer_count / 2);
      break;
    case Rule::kAll:
      for (std::size_t i = 0; i < layer_count; ++i) kept.push_back(i);
      break;
    case Rule::kListed:
      for (const std::size_t i : listed)
        if (i < layer_count) kept.push_back(i);
      break;
  }
  return kept;
}

ExperimentConfig parse_config(const std::string& text, const std::filesystem::path& file) {
  const std::string name = file.string();
  const toml::table root = parse_toml(text, name);
  const ConfigTable top(name, "the config", root);
  top.require_known(kTopKeys);
  ExperimentConfig config;
  config.file = file;
  config.text = text;
  config.name = read_name(top);
  config.seeds = read_seeds(top);
  config.models = read_models(top, file);
  config.plugins = read_plugins(top, file);
  config.settings = read_settings(top, name);
  config.run = read_run(top, name);
  config.contenders = read_contenders(top, name);
  read_claims(top, name, config);
  require_manageable(config);
  return config;
}

ExperimentConfig load_config(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(file, error);
  if (error) throw Error(ErrorKind::kBadInput, file.string() + ": " + error.message());
  if (bytes > kMostBytes)
    throw Error(ErrorKind::kBadInput, file.string() + ": " + std::to_string(bytes) +
                                          " bytes are no config; it may have up to " +
                                          std::to_string(kMostBytes));
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw Error(ErrorKind::kBadInput, file.string() + ": cannot be read");
  return parse_config(text.str(), file);
}

}  // namespace routebench
