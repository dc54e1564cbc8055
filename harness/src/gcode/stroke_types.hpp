#pragma once
/// The names that slicers give to what they lay.

#include <optional>
#include <string_view>

#include "gcode/print_builder.hpp"

namespace routebench::gcode {

/// What the name of a `;TYPE:` mark means; nothing for an unknown one.
[[nodiscard]] std::optional<StrokeType> stroke_type(std::string_view name);

}  // namespace routebench::gcode
