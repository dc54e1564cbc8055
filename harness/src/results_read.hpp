#pragma once
/// What writers of a results database read of it.

#include "routebench/harness/results.hpp"
#include "sqlite.hpp"

namespace routebench {

[[nodiscard]] KnownCells read_known_cells(Database& database);

}  // namespace routebench
