#include "routebench/harness/reproduction.hpp"

#include <cmath>
#include <map>
#include <ostream>

#include "json_parts.hpp"
#include "process_planner.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/harness/metrics.hpp"

namespace routebench {
namespace {

namespace fs = std::filesystem;

CellName name_of(const StoredCell& cell) {
  return {cell.model, cell.contender, cell.setting, cell.seed};
}

std::string text_of(const CellName& name) {
  std::string text = name.model + " · " + name.contender;
  if (!name.setting.empty()) text += " · " + name.setting;
  return text + " · seed " + std::to_string(name.seed);
}

std::map<CellName, StoredCell> cells_by_name(const fs::path& file) {
  std::map<CellName, StoredCell> cells;
  for (StoredCell& cell : current_cells(file)) {
    CellName name = name_of(cell);
    cells.emplace(std::move(name), std::move(cell));
  }
  return cells;
}

std::string value_text(const std::optional<double>& value) {
  return value ? to_string(ParamValue(*value)) : "none";
}

/// What differs between two executions of a cell; nothing if they came out alike.
std::string differences_of(const StoredCell& before, const StoredCell& after) {
  std::string text;
  const auto add = [&](const std::string& what) { text += (text.empty() ? "" : "; ") + what; };
  if (before.layers_hash != after.layers_hash) add("the model gives other layers");
  if (before.plugin_hashes != after.plugin_hashes) add("the plugin file is another one");
  if (before.outcome != after.outcome)
    add(std::string(to_string(before.outcome)) + " -> " + std::string(to_string(after.outcome)) +
        (after.reason.empty() ? "" : " (" + after.reason + ")"));
  if (before.route_hash != after.route_hash) add("another route");
  for (std::size_t i = 0; i < metric_table().size(); ++i) {
    const std::string_view metric = metric_table()[i].name;
    if (is_deterministic(metric) && before.totals.at(i) != after.totals.at(i))
      add(std::string(metric) + " " + value_text(before.totals[i]) + " -> " +
          value_text(after.totals[i]));
  }
  return text;
}

std::vector<std::string> provenance_changes(const Provenance& before, const Provenance& after) {
  std::vector<std::string> changes;
  const auto compare = [&](const std::string& what, const std::string& a, const std::string& b) {
    if (a != b) changes.push_back(what + " " + a + " -> " + b);
  };
  const auto commit = [](const Provenance& from) {
    return from.git_commit.value_or("unknown") +
           (from.git_dirty.value_or(false) ? " with changes" : "");
  };
  compare("routebench", before.routebench_version, after.routebench_version);
  compare("commit", commit(before), commit(after));
  compare("build", before.program_build_id, after.program_build_id);
  compare("compiler", before.compiler, after.compiler);
  compare("compiler flags", before.compiler_flags, after.compiler_flags);
  compare("libraries", before.libraries_json, after.libraries_json);
  compare("processor", before.cpu, after.cpu);
  compare("cores", std::to_string(before.cores), std::to_string(after.cores));
  compare("memory in bytes", std::to_string(before.memory_bytes),
          std::to_string(after.memory_bytes));
  compare("system", before.os, after.os);
  return changes;
}

}  // namespace

Reproduction read_reproduction(const fs::path& file, const std::optional<fs::path>& base) {
  const RunRecord run = last_run(file).record;
  Reproduction again;
  // A path that is absolute already stays as it is.
  const fs::path config_file = run.working_folder / run.config_file;
  again.config = parse_config(run.config_text, base ? *base / config_file.filename() : config_file);
  again.repair = run.repair;
  for (const Json& plugin : Json::parse(run.plugins_json)) {
    const auto name = plugin.at("file").get<std::string>();
    // Commands stand in the config; what a search path brings is there again or is not wanted.
    if (is_command(name) || !plugin.at("by_name").get<bool>()) continue;
    again.plugins.push_back((run.working_folder / name).string());
  }
  for (const StoredCell& cell : current_cells(file)) again.cells.insert(name_of(cell));
  if (again.cells.empty())
    throw Error(ErrorKind::kBadInput, file.string() + ": holds no cells that could be reproduced");
  return again;
}

Comparison compare_results(const fs::path& before, const fs::path& after) {
  const std::map<CellName, StoredCell> old_cells = cells_by_name(before);
  const std::map<CellName, StoredCell> new_cells = cells_by_name(after);
  Comparison comparison;
  double log_sum = 0;
  std::size_t timed = 0;
  const std::size_t wall_ns = metric_index("plan_wall_ns");
  for (const auto& [name, cell] : old_cells) {
    const auto found = new_cells.find(name);
    if (found == new_cells.end()) {
      comparison.differences.push_back(text_of(name) + ": not executed again");
      continue;
    }
    ++comparison.cells;
    if (const std::string what = differences_of(cell, found->second); !what.empty())
      comparison.differences.push_back(text_of(name) + ": " + what);
    const double old_ns = cell.totals.at(wall_ns).value_or(0);
    const double new_ns = found->second.totals.at(wall_ns).value_or(0);
    if (old_ns <= 0 || new_ns <= 0) continue;
    log_sum += std::log(new_ns / old_ns);
    ++timed;
  }
  for (const auto& [name, cell] : new_cells)
    if (!old_cells.contains(name))
      comparison.differences.push_back(text_of(name) + ": was not there before");
  if (timed > 0) comparison.time_ratio = std::exp(log_sum / static_cast<double>(timed));
  comparison.provenance =
      provenance_changes(last_run(before).record.provenance, last_run(after).record.provenance);
  return comparison;
}

void write_comparison(std::ostream& out, const Comparison& comparison) {
  for (const std::string& difference : comparison.differences)
    out << "differs: " << difference << '\n';
  for (const std::string& change : comparison.provenance) out << "made with: " << change << '\n';
  if (comparison.time_ratio > 0)
    out << "planning took " << std::round(comparison.time_ratio * 1e3) / 1e3
        << " times as long (geometric mean over the cells; times are not compared)\n";
  out << (comparison.differences.empty() ? "reproduced: " : "not reproduced: ") << comparison.cells
      << " cells executed again, " << comparison.differences.size()
      << (comparison.differences.size() == 1 ? " differs" : " differ")
      << " in outcome, route or metrics\n";
}

}  // namespace routebench
