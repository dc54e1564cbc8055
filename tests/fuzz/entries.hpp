#pragma once
/// What is done with arbitrary bytes, by the fuzzers and by the tests that replay their seeds.

#include <span>

namespace routebench::fuzz {

/// Each reads bytes as a file of one kind and goes on with what was read. The only way out beside
/// returning is a promise that is broken: std::logic_error, or whatever the code under test throws
/// or does. Input that is refused is no failure.
void read_as_gcode(std::span<const char> bytes);
void read_as_stl(std::span<const char> bytes);
void read_as_config(std::span<const char> bytes);

}  // namespace routebench::fuzz
