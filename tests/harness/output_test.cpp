#include "routebench/harness/output.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <ostream>
#include <sstream>
#include <stdexcept>

#include "routebench/geometry/error.hpp"

namespace routebench {
namespace {

namespace fs = std::filesystem;

class Output : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) /
              ("routebench_output_" + std::to_string(getpid()) + "_" + info->name());
    fs::remove_all(folder_);
    fs::create_directory(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] std::size_t entries() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  static std::string content_of(const fs::path& file) {
    std::ifstream in(file);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
  }
  static OutputSet::Write saying(std::string text) {
    return [text](std::ostream& out) { out << text; };
  }
  /// The message of the Error that an action throws.
  template <typename Act>
  static std::string error_of(Act&& act) {
    try {
      act();
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }

  fs::path folder_;
};

TEST_F(Output, FilesAppearTogetherAtTheEnd) {
  OutputSet outputs;
  outputs.add(folder_ / "a", saying("one"));
  outputs.add(folder_ / "b", saying("two"));
  EXPECT_FALSE(fs::exists(folder_ / "a"));
  outputs.commit();
  EXPECT_EQ(content_of(folder_ / "a"), "one");
  EXPECT_EQ(content_of(folder_ / "b"), "two");
  EXPECT_EQ(entries(), 2u);
}

TEST_F(Output, NothingIsLeftOfWhatWasNotCommitted) {
  {
    OutputSet outputs;
    outputs.add_folder(folder_ / "made");
    outputs.add(folder_ / "made" / "a", saying("one"));
    EXPECT_THROW(outputs.add(folder_ / "b",
                             [](std::ostream& out) {
                               out << "half";
                               throw std::runtime_error("no more");
                             }),
                 std::runtime_error);
  }
  EXPECT_EQ(entries(), 0u);
}

TEST_F(Output, AnOldFileStaysWholeUntilTheNewOneIs) {
  std::ofstream(folder_ / "a") << "old";
  {
    OutputSet outputs;
    outputs.add(folder_ / "a", saying("new"));
    EXPECT_EQ(content_of(folder_ / "a"), "old");
  }
  EXPECT_EQ(content_of(folder_ / "a"), "old");
  OutputSet outputs;
  outputs.add(folder_ / "a", saying("new"));
  outputs.commit();
  EXPECT_EQ(content_of(folder_ / "a"), "new");
  EXPECT_EQ(entries(), 1u);
}

TEST_F(Output, ADashIsNoFile) {
  OutputSet outputs;
  const auto text = saying("text");
  EXPECT_NE(error_of([&] { outputs.add("-", text); }).find("the name of a file"),
            std::string::npos);
  outputs.commit();
  EXPECT_FALSE(fs::exists("-"));
}

TEST_F(Output, AFullDiskIsAnErrorThatNamesTheFile) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full on this system";
  OutputSet outputs;
  const auto much = saying(std::string(5'000'000, 'x'));
  EXPECT_NE(error_of([&] { outputs.add("/dev/full", much); }).find("/dev/full: cannot be written"),
            std::string::npos);
  EXPECT_TRUE(fs::is_character_file("/dev/full")) << "a device is never replaced";
}

TEST_F(Output, PlacesThatCannotBeWrittenAreNamed) {
  OutputSet outputs;
  EXPECT_EQ(error_of([&] { outputs.add(folder_, saying("x")); }),
            folder_.string() + ": cannot be written: it is a folder");
  std::ofstream(folder_ / "file") << "x";
  const fs::path file = folder_ / "file";
  EXPECT_EQ(error_of([&] { outputs.add_folder(file); }),
            file.string() + ": cannot be written: it is not a folder");
  EXPECT_EQ(error_of([&] { outputs.add(file / "a", saying("x")); }),
            (file / "a").string() + ": cannot be written: " + file.string() + " is not a folder");
  EXPECT_EQ(
      error_of([&] { outputs.add(file / "b" / "a", saying("x")); }),
      (file / "b" / "a").string() + ": cannot be written: " + file.string() + " is not a folder");
}

TEST_F(Output, MissingFoldersAreMadeAndGoWithWhatWasNotCommitted) {
  const fs::path file = folder_ / "x" / "y" / "a";
  {
    OutputSet outputs;
    outputs.add(file, saying("one"));
    outputs.add_folder(folder_ / "p" / "q" / "");
    EXPECT_TRUE(fs::is_directory(folder_ / "p" / "q"));
  }
  EXPECT_EQ(entries(), 0u);
  OutputSet outputs;
  outputs.add(file, saying("one"));
  outputs.add_folder(folder_ / "p" / "q" / "");
  outputs.commit();
  EXPECT_EQ(content_of(file), "one");
  EXPECT_TRUE(fs::is_directory(folder_ / "p" / "q"));
}

TEST_F(Output, OneFileCannotBeTwoOutputs) {
  OutputSet outputs;
  outputs.add(folder_ / "a", saying("x"));
  EXPECT_NE(error_of([&] { outputs.add(folder_ / "." / "a", saying("y")); }).find("two outputs"),
            std::string::npos);
}

TEST_F(Output, ALinkKeepsPointingWhereItDoes) {
  std::ofstream(folder_ / "real") << "old";
  fs::create_symlink("real", folder_ / "link");
  OutputSet outputs;
  outputs.add(folder_ / "link", saying("new"));
  outputs.commit();
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_EQ(content_of(folder_ / "real"), "new");
}

TEST_F(Output, LargeContentArrivesWhole) {
  OutputSet outputs;
  std::string expected;
  for (int i = 0; i < 400'000; ++i) expected += std::to_string(i) + '\n';
  outputs.add(folder_ / "a", [&](std::ostream& out) {
    for (int i = 0; i < 400'000; ++i) out << i << '\n';
  });
  outputs.commit();
  EXPECT_EQ(content_of(folder_ / "a"), expected);
}

}  // namespace
}  // namespace routebench
