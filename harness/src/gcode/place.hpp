#pragma once
/// Where in a file something is wrong.

#include <cstddef>
#include <string>

#include "routebench/geometry/error.hpp"

namespace routebench::gcode {

struct Place {
  std::string name;      ///< of the file
  std::size_t line = 0;  ///< from 1

  /// Throws Error{kBadInput} "NAME:LINE: reason".
  [[noreturn]] void refuse(const std::string& reason) const {
    throw Error(ErrorKind::kBadInput, name + ":" + std::to_string(line) + ": " + reason);
  }
};

}  // namespace routebench::gcode
