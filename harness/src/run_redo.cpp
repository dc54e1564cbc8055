#include "run_redo.hpp"

#include <set>
#include <tuple>

#include "json_parts.hpp"

namespace routebench {
namespace {

void add(std::string& changes, const std::string& change) {
  changes += (changes.empty() ? "" : "; ") + change;
}

/// "/fill/params/angle_deg" as "fill.angle_deg".
std::string readable_path(std::string path) {
  const std::string params = "/params/";
  if (const std::size_t at = path.find(params); at != std::string::npos)
    path.replace(at, params.size(), "/");
  path.erase(0, 1);
  for (char& c : path)
    if (c == '/') c = '.';
  return path;
}

/// Every value that is in only one of two documents or differs between them.
void add_differences(std::string& changes, const std::string& prefix, const std::string& before,
                     const std::string& now) {
  const nlohmann::json old_values = nlohmann::json::parse(before, nullptr, false).flatten();
  const nlohmann::json new_values = nlohmann::json::parse(now, nullptr, false).flatten();
  std::set<std::string> paths;
  for (const nlohmann::json* values : {&old_values, &new_values})
    for (const auto& [path, value] : values->items()) paths.insert(path);
  const auto text = [](const nlohmann::json& values, const std::string& path) {
    return values.contains(path) ? values.at(path).dump() : std::string("none");
  };
  for (const std::string& path : paths)
    if (const std::string a = text(old_values, path), b = text(new_values, path); a != b)
      add(changes, prefix + readable_path(path) + " " + a + " -> " + b);
}

std::string differences(const KnownCell& before, const PlannedCell& now) {
  std::string changes;
  const ModelRecord& old_model = *before.model;
  const ModelRecord& new_model = now.model->record;
  const bool same_setting = before.setting->setting_hash == now.setting->record.setting_hash;
  if (old_model.mesh_hash != new_model.mesh_hash ||
      (new_model.mesh_hash.empty() && same_setting &&
       old_model.layers_hash != new_model.layers_hash))
    add(changes, "the model has changed");
  else if (same_setting && old_model.layers_hash != new_model.layers_hash)
    add(changes, "the model is cut into other layers");
  if (before.contender->name != now.contender->record.name)
    add(changes, "the contender was called " + before.contender->name);
  add_differences(changes, "", before.contender->variant_json, now.contender->record.variant_json);
  const auto refused = [](const std::string& hashes) {
    return hashes.find(kRefusedMark) != std::string::npos;
  };
  if (refused(before.plugin_hashes) != refused(now.contender->plugin_hashes))
    add(changes, refused(before.plugin_hashes) ? "the plugin of its planner had been refused"
                                               : "the plugin of its planner is refused now");
  else if (before.plugin_hashes != now.contender->plugin_hashes)
    add(changes, "the plugin file of its planner has changed");
  add_differences(changes, "task.", before.setting->task_json, now.setting->record.task_json);
  add_differences(changes, "printer.", before.setting->printer_json,
                  now.setting->record.printer_json);
  if (before.seed != now.seed)
    add(changes, "seed " + std::to_string(before.seed) + " -> " + std::to_string(now.seed));
  return changes.empty() ? "its key has changed" : changes;
}

std::string raised_limit(const KnownCell& before, const RunOptions& run) {
  if (before.outcome == Outcome::kTimedOut)
    return "it had timed out; timeout_s " + to_string(ParamValue(before.timeout_s)) + " -> " +
           to_string(ParamValue(run.timeout_s));
  return "it had run out of memory; memory_mb " + std::to_string(before.memory_mb) + " -> " +
         std::to_string(run.memory_mb);
}

/// Cells that the plan does not ask for, by what is compared. Of several the current one counts,
/// else the one that was executed last.
template <typename Name>
class Index {
 public:
  void add(const Name& name, const KnownCell& cell) {
    const KnownCell*& place = cells_[name];
    if (place == nullptr ||
        std::tie(place->current, place->cell_id) < std::tie(cell.current, cell.cell_id))
      place = &cell;
  }
  [[nodiscard]] const KnownCell* find(const Name& name) const {
    const auto found = cells_.find(name);
    return found == cells_.end() ? nullptr : found->second;
  }

 private:
  std::map<Name, const KnownCell*> cells_;
};

}  // namespace

std::map<const PlannedCell*, Predecessor> predecessors_of(const std::vector<CellState>& states,
                                                          const KnownCells& known,
                                                          const RunOptions& run) {
  std::set<std::string> asked_for;
  for (const CellState& state : states) asked_for.insert(state.cell->key);
  Index<CellName> by_name;
  Index<CellName> by_variant;  // instead of the contender's name
  Index<std::tuple<std::string, std::string, std::string>> by_all_but_seed;
  for (const auto& [key, cell] : known) {
    if (asked_for.contains(key)) continue;
    const std::string& spec = cell.model->spec;
    const std::string& label = cell.setting->label;
    by_name.add({spec, cell.contender->name, label, cell.seed}, cell);
    by_variant.add({spec, cell.contender->variant_hash, label, cell.seed}, cell);
    by_all_but_seed.add({spec, cell.contender->name, label}, cell);
  }

  std::map<const PlannedCell*, Predecessor> found;
  for (const CellState& state : states) {
    if (!state.is_to_execute()) continue;
    const PlannedCell& cell = *state.cell;
    if (const auto same = known.find(cell.key); same != known.end()) {
      found[&cell] = {&same->second, raised_limit(same->second, run)};
      continue;
    }
    const std::string& spec = cell.model->record.spec;
    const std::string& label = cell.setting->record.label;
    const ContenderRecord& contender = cell.contender->record;
    const KnownCell* before = by_name.find({spec, contender.name, label, cell.seed});
    if (before == nullptr)
      before = by_variant.find({spec, contender.variant_hash, label, cell.seed});
    if (before == nullptr) before = by_all_but_seed.find({spec, contender.name, label});
    if (before != nullptr) found[&cell] = {before, differences(*before, cell)};
  }
  return found;
}

}  // namespace routebench
