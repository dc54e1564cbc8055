#pragma once
/// The pieces of which JSON documents and stored records are made: one form each, everywhere.

#include <nlohmann/json.hpp>
#include <string>

#include "routebench/geometry/model.hpp"
#include "routebench/geometry/slice.hpp"
#include "routebench/harness/contender.hpp"
#include "routebench/harness/metrics.hpp"
#include "routebench/harness/slicer.hpp"
#include "routebench/harness/task.hpp"
#include "routebench/planning/params.hpp"
#include "routebench/planning/plugin.hpp"
#include "routebench/planning/registry.hpp"

namespace routebench {

/// Keeps keys in the order in which they were set.
using Json = nlohmann::ordered_json;

[[nodiscard]] Json json_of(const ParamValue& value);
[[nodiscard]] Json json_of(const ParamSet& params);

/// Every key of the table with its value: numbers as numbers, points as [x, y], the rest as text.
[[nodiscard]] Json json_of(const Task& task);
[[nodiscard]] Json json_of(const Printer& printer);

/// name, shell, fill (each with planner and every parameter, null if absent), order.
[[nodiscard]] Json json_of(const Contender& contender);

/// What was asked for, and that with what was found.
[[nodiscard]] Json json_of(const SlicerSpec& slicer);
[[nodiscard]] Json json_of(const Slicer& slicer);

[[nodiscard]] Json json_of(const MeshReport& report);
[[nodiscard]] Json json_of(const SliceReport& report);

/// Every metric of the table by name, null where it does not apply. A whole number is written
/// without a point; any other reads back exactly.
[[nodiscard]] Json json_of(const Scores& scores);

/// An array of {"kind", "width_mm", "points": [[x, y], ...]}.
[[nodiscard]] Json json_of(const PlannedLayer& planned);

/// Parameters as a planner declares them.
[[nodiscard]] Json json_of(const std::vector<ParamSchema>& params);
[[nodiscard]] Json json_of(const Registry::Entry& entry);
[[nodiscard]] Json json_of(const PluginRecord& plugin);

/// The text of a document: two spaces a level, or one line if `compact`. Bytes that are no UTF-8
/// (of file names) become replacement characters.
[[nodiscard]] std::string text_of(const Json& document, bool compact = false);

}  // namespace routebench
