#pragma once
/// Libraries of routebench that are loaded when they are needed.

#include <string>

namespace routebench {

/// The address of a function in a library that lies beside this one and holds what only few calls
/// of the program need: if it were loaded with the program, all would wait for it and for all that
/// it depends on. Loaded once, for good.
/// Takes   the library's file name, the function's name, and what the library is, for the message.
/// Throws  Error{kInternal} if it cannot be loaded.
[[nodiscard]] void* function_in_library(const std::string& library, const std::string& function,
                                        const std::string& what);

}  // namespace routebench
