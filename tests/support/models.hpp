#pragma once
/// Where tests find real meshes, if this machine has them.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <optional>

namespace routebench::test {

/// The folder of shared test models: the environment variable ROUTEBENCH_MODELS, else
/// `shared/models` beside the source tree; nothing if it is absent.
inline std::optional<std::filesystem::path> models_dir() {
  const char* named = std::getenv("ROUTEBENCH_MODELS");
  const std::filesystem::path folder =
      named != nullptr
          ? std::filesystem::path(named)
          : std::filesystem::path(ROUTEBENCH_SOURCE_DIR).parent_path() / "shared" / "models";
  if (!std::filesystem::is_directory(folder)) return std::nullopt;
  return folder;
}

}  // namespace routebench::test

/// Binds `dir` to the folder of test models or skips the test with a message.
#define ROUTEBENCH_MODELS_OR_SKIP(dir)                                                       \
  const std::optional<std::filesystem::path> dir##_found = routebench::test::models_dir();   \
  if (!dir##_found) GTEST_SKIP() << "no test models: set ROUTEBENCH_MODELS to their folder"; \
  const std::filesystem::path& dir = *dir##_found
