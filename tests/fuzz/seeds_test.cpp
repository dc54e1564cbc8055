/// The fuzzers' seeds, and their shortened and damaged copies, through the same functions.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "entries.hpp"

namespace routebench {
namespace {

namespace fs = std::filesystem;

using Entry = void (*)(std::span<const char>);

void replay(const std::string& kind, Entry entry) {
  std::vector<fs::path> files;
  for (const auto& file : fs::directory_iterator(ROUTEBENCH_FUZZ_SEEDS "/" + kind))
    files.push_back(file.path());
  std::sort(files.begin(), files.end());
  ASSERT_GE(files.size(), 3u);
  std::mt19937 random(1);
  for (const fs::path& file : files) {
    std::ifstream in(file, std::ios::binary);
    const std::string whole{std::istreambuf_iterator<char>(in), {}};
    ASSERT_FALSE(whole.empty()) << file;
    EXPECT_NO_THROW(entry(whole)) << file;
    for (int k = 0; k < 200; ++k) {
      std::string damaged = whole.substr(0, 1 + random() % whole.size());
      for (int changes = static_cast<int>(random() % 4); changes > 0; --changes)
        damaged[random() % damaged.size()] = static_cast<char>(random() % 256);
      EXPECT_NO_THROW(entry(damaged)) << file << ", damage " << k;
    }
  }
}

TEST(FuzzSeeds, GcodeIsReadOrRefused) { replay("gcode", fuzz::read_as_gcode); }
TEST(FuzzSeeds, StlIsReadOrRefused) { replay("stl", fuzz::read_as_stl); }
TEST(FuzzSeeds, ConfigsAreReadOrRefused) { replay("config", fuzz::read_as_config); }

}  // namespace
}  // namespace routebench
