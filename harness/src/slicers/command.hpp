#pragma once
/// Commands of slicers that are not known here.

#include <string>
#include <vector>

#include "slicers/slicer_kind.hpp"

namespace routebench::slicers {

/// The words of a command, with placeholders as they were written. See check_slicer for the rules.
/// Throws Error{kBadInput} for what is no such command.
[[nodiscard]] std::vector<std::string> command_words(const std::string& command);

/// The words with what their placeholders stand for. Takes what command_words has returned.
[[nodiscard]] std::vector<std::string> filled_words(const std::vector<std::string>& words,
                                                    const SliceJob& job);

}  // namespace routebench::slicers
