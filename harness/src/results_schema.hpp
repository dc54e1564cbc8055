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

/// Throws Error{kBadInput} if the database is not one of ours or belongs to another experiment.
void require_experiment(Database& database, const std::string& experiment);

}  // namespace routebench
