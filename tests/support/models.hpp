#pragma once
/// Where tests find real meshes, if this machine has them.

#include <gtest/gtest.h>

#include <filesystem>
#include <optional>

namespace routebench::test {

/// The folder of shared test models: the environment variable ROUTEBENCH_MODELS, else
/// `shared/models` beside the source tree; nothing if it is absent.
[[nodiscard]] std::optional<std::filesystem::path> models_dir();

}  // namespace routebench::test

/// Binds `dir` to the folder of test models or skips the test with a message.
#define ROUTEBENCH_MODELS_OR_SKIP(dir)                                                       \
  const std::optional<std::filesystem::path> dir##_found = routebench::test::models_dir();   \
  if (!dir##_found) GTEST_SKIP() << "no test models: set ROUTEBENCH_MODELS to their folder"; \
  const std::filesystem::path& dir = *dir##_found
