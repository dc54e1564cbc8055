#pragma once
/// The tables of a results database.

#include <string>

#include "sqlite.hpp"

namespace routebench {

/// The name of the file in a folder of results.
inline constexpr const char* kResultsFileName = "results.sqlite";

/// Makes all tables in an empty database and fills the metric table.
void create_schema(Database& database, const std::string& experiment);

/// Throws Error{kBadInput} if the database is not one of ours, or was written by a program with
/// another schema or other metrics.
void require_our_schema(Database& database);

/// The experiment that a database of ours belongs to; empty if it is none.
[[nodiscard]] std::string experiment_of(Database& database);

/// Brings a cell's plan times, the medians of its timing samples, up to date.
void update_plan_times(Database& database, std::int64_t cell_id);

/// Whether a metric comes from timing samples.
[[nodiscard]] bool is_time_metric(std::string_view name);

/// Throws Error{kBadInput} if the database is not one of ours or belongs to another experiment.
void require_experiment(Database& database, const std::string& experiment);

}  // namespace routebench
