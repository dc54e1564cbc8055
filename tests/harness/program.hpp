#pragma once
/// Runs the built program and looks at what it says.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

namespace routebench::test {

inline std::string content_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

struct ProgramRun {
  int exit_code = -1;  ///< or minus the signal that ended it
  std::string out;
  std::string err;
  [[nodiscard]] nlohmann::json json() const { return nlohmann::json::parse(out); }
};

/// Tests that call the program in a folder of their own.
class ProgramTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) /
              ("routebench_" + std::to_string(getpid()) + "_" + info->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directory(folder_);
    outside_ = folder_.string() + "_streams";
    std::filesystem::create_directory(outside_);
    setenv("XDG_DATA_HOME", outside_.c_str(), 1);  // no plugins of the user's own
  }
  void TearDown() override {
    std::filesystem::remove_all(folder_);
    std::filesystem::remove_all(outside_);
  }

  /// Runs `routebench arguments...`. Takes the file that the standard output goes to, if not ours.
  ProgramRun call(const std::vector<std::string>& arguments, std::string out_file = {}) {
    if (out_file.empty()) out_file = (outside_ / "out").string();
    const std::string err_file = (outside_ / "err").string();
    std::vector<std::string> words = {ROUTEBENCH_PROGRAM};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    const int flags = O_WRONLY | O_CREAT | O_TRUNC;
    posix_spawn_file_actions_addopen(&actions, 1, out_file.c_str(), flags, 0600);
    posix_spawn_file_actions_addopen(&actions, 2, err_file.c_str(), flags, 0600);
    pid_t child = 0;
    const int failure = posix_spawn(&child, argv[0], &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    EXPECT_EQ(failure, 0) << "cannot start " << words[0];
    int status = 0;
    waitpid(child, &status, 0);
    ProgramRun run;
    run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    if (std::filesystem::is_regular_file(out_file)) run.out = content_of(out_file);
    run.err = content_of(err_file);
    return run;
  }

  /// Expects a refusal: exit code 2, nothing on stdout, one line on stderr with the given part, and
  /// no file left behind.
  void expect_refused(const std::vector<std::string>& arguments, const std::string& part) {
    const ProgramRun run = call(arguments);
    EXPECT_EQ(run.exit_code, 2) << run.err;
    EXPECT_EQ(run.out, "");
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_TRUE(run.err.starts_with("routebench: ")) << run.err;
    EXPECT_NE(run.err.find(part), std::string::npos) << run.err << "lacks: " << part;
    EXPECT_TRUE(std::filesystem::is_empty(folder_)) << "left behind something";
  }

  [[nodiscard]] std::string in_folder(const std::string& name) const {
    return (folder_ / name).string();
  }

  std::filesystem::path folder_;

 private:
  std::filesystem::path outside_;
};

/// The keys of an object.
inline std::set<std::string> keys_of(const nlohmann::json& object) {
  std::set<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.insert(key);
  return keys;
}

}  // namespace routebench::test
