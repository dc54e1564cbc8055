#pragma once
/// "Did you mean ...?"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace routebench {

/// The candidate most like a word, if one is near enough to be meant: by letters put in, left out,
/// changed or exchanged with their neighbour, at most a third of the longer word; a beginning of
/// three letters or more is meant as well. Of equals the first in the alphabet.
[[nodiscard]] std::optional<std::string> nearest_name(std::string_view word,
                                                      const std::vector<std::string>& candidates);

}  // namespace routebench
