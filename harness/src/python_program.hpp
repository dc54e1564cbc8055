#pragma once
/// The part of the program that is Python: packages that read databases and draw.

#include <string>
#include <vector>

namespace routebench {

/// The distribution's Python: one that stands earlier in the search path may lack numpy and
/// matplotlib.
inline constexpr const char* kPython = "/usr/bin/python3";

/// Runs a package of the folder experiments (or of the installed program's data) and waits for it.
/// Ctrl-C reaches the package alone, which then cleans up behind itself.
///
/// Returns its exit code.
/// Throws  Error{kBadInput} if it or Python is not there, Error{kInternal} if a signal ended it.
int run_python_package(const std::string& package, const std::vector<std::string>& arguments);

/// Appends an option of a package as one word, so that its value may begin with a dash; an empty
/// value appends nothing.
void add_argument(std::vector<std::string>& arguments, const char* name, const std::string& value);

}  // namespace routebench
