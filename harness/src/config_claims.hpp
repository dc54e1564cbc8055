#pragma once
/// What others say of contenders: the tables [[claim]] and [[published]] of a config.

#include <string>

#include "config_table.hpp"
#include "routebench/harness/config.hpp"

namespace routebench {

/// Reads both tables into a config whose models and contenders are known.
/// Throws Error{kBadInput} with file, line and key.
void read_claims(const ConfigTable& top, const std::string& file, ExperimentConfig& config);

}  // namespace routebench
