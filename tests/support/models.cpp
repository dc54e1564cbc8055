#include "models.hpp"

#include <cstdlib>

namespace routebench::test {

std::optional<std::filesystem::path> models_dir() {
  const char* named = std::getenv("ROUTEBENCH_MODELS");
  const std::filesystem::path folder =
      named != nullptr
          ? std::filesystem::path(named)
          : std::filesystem::path(ROUTEBENCH_SOURCE_DIR).parent_path() / "shared" / "models";
  if (!std::filesystem::is_directory(folder)) return std::nullopt;
  return folder;
}

}  // namespace routebench::test
