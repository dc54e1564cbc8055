#pragma once
/// What slicers say in comments.

#include <string_view>

#include "gcode/machine.hpp"
#include "gcode/place.hpp"
#include "gcode/print_builder.hpp"

namespace routebench::gcode {

/// Reads a line that is a comment, without its semicolon. What is no mark is passed over.
/// Throws Error{kBadInput} for the mark of a width or height that is no number, and of a height
/// that
///        is not positive. A width of 0 or less means that none is known.
void read_comment(std::string_view text, const Place& place, PrintBuilder& print, Machine& machine);

}  // namespace routebench::gcode
