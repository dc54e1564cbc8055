#include "routebench/planning/sha256.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

namespace routebench {
namespace {

TEST(Sha256, AgreesWithTheStandardsExamples) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, AFileCountsAsItsBytes) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "sha256_test.bin";
  for (const std::size_t size : {0U, 1U, 65536U, 65537U, 200000U}) {
    std::string bytes(size, '\0');
    for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<char>(i * 31 % 251);
    std::ofstream(file, std::ios::binary) << bytes;
    EXPECT_EQ(sha256_of_file(file), sha256(bytes)) << size;
  }
  std::filesystem::remove(file);
}

TEST(Sha256, WhatCannotBeReadHasNone) {
  EXPECT_EQ(sha256_of_file("/no/such/file"), std::nullopt);
  EXPECT_EQ(sha256_of_file(std::filesystem::temp_directory_path()), std::nullopt);
}

}  // namespace
}  // namespace routebench
