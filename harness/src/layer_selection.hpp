#pragma once
/// Which layers of a model are meant.

#include <cstddef>
#include <string>
#include <vector>

#include "routebench/geometry/types.hpp"

namespace routebench {

/// Places of the layers that a text like `3,10..20` names by their index: numbers and closed
/// ranges, separated by commas, in any order. An empty text means all of them.
/// Returns ascending places, each once.
/// Throws  Error{kBadUsage} for what cannot be read or names a layer that is not there.
[[nodiscard]] std::vector<std::size_t> select_layers(const std::string& text,
                                                     const std::vector<Layer>& layers);

}  // namespace routebench
