#pragma once
/// The way to the reader of 3MF files, which is a library of its own: libzip needs libcrypto, and
/// to load the two would take a quarter of a command's start.

#include <span>

#include "model/formats.hpp"

/// What that library defines: read_3mf() of formats.hpp.
extern "C" void routebench_read_3mf(std::span<const char> bytes,
                                    const routebench::models::ReadContext& context,
                                    routebench::models::RawMesh& mesh);
