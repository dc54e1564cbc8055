/// Plugins: where they are looked for, and that none of them takes the program down.

#include "plugin_files.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "program.hpp"
#include "routebench/planning/plugin.hpp"

namespace routebench {
namespace {

namespace fs = std::filesystem;
using test::ProgramRun;

fs::path test_plugin(const std::string& name) {
  return fs::path(ROUTEBENCH_TEST_PLUGINS) / (name + ".so");
}

struct Bad {
  std::string name;
  std::vector<std::string> reason;  ///< words of it
};

/// Bad files, by the name that a test gives them.
const std::vector<Bad>& bad_plugins() {
  static const std::vector<Bad> all{
      {"spoilt_throws", {"thrown before main"}},
      {"spoilt_exits", {"ends the program", "exit code 0"}},
      {"spoilt_aborts", {"crashes", "SIGABRT"}},
      {"spoilt_crashes", {"crashes", "SIGSEGV"}},
      {"other_containers", {"debug-containers", plugin_build_id()}},
      {"other_strings", {"libstdc++ abi 0", plugin_build_id()}},
      {"other_version", {"plugin ABI 1"}},
      {"lacks_a_symbol", {"routebench::from_a_later_version(int)"}},
      {"cut", {""}},
      {"text", {"not a shared library"}},
  };
  return all;
}

/// Makes the bad file of that name in a folder.
fs::path place_in(const fs::path& folder, const std::string& name) {
  const fs::path file = folder / (name + ".so");
  if (name == "text") {
    std::ofstream(file) << "a note\n";
    return file;
  }
  fs::copy_file(name == "cut" ? fs::path(ROUTEBENCH_TOY_PLUGIN) : test_plugin(name), file);
  // What comes last in a file may be debug information, which no one misses.
  if (name == "cut") fs::resize_file(file, fs::file_size(file) / 8);
  return file;
}

class PluginFiles : public test::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    setenv("ROUTEBENCH_PLUGIN_PATH", folder_.c_str(), 1);
  }
  void TearDown() override {
    unsetenv("ROUTEBENCH_PLUGIN_PATH");
    ProgramTest::TearDown();
  }

  /// A config whose first contender needs a planner `idle`.
  std::string config_with(const std::string& plugin) {
    std::ofstream(in_folder("square.wkt"))
        << "MULTIPOLYGON Z (((0 0 0.1, 9 0 0.1, 9 9 0.1, 0 9 0.1, 0 0 0.1)))\n";
    std::ofstream(in_folder("t.toml"))
        << "name = \"t\"\nmodels = [\"square.wkt\"]\nplugins = [\"" << plugin
        << "\"]\n[task]\ndensity = 1\n[[contender]]\nname = \"needs it\"\n"
           "fill = { planner = \"idle\", pitch = 2 }\n[[contender]]\nname = \"needs it not\"\n"
           "shell = { planner = \"greedy_shell\" }\nfill = { planner = \"rectilinear\" }\n";
    return in_folder("t.toml");
  }
};

TEST_F(PluginFiles, AGoodOneHasNoTrouble) {
  EXPECT_EQ(trouble_of_plugin({}, ROUTEBENCH_TOY_PLUGIN), "");
}

TEST_F(PluginFiles, OneThatHangsIsGivenUp) {
  const std::string trouble = trouble_of_plugin({}, test_plugin("spoilt_hangs"), 0.5);
  EXPECT_NE(trouble.find("not loaded after 0.5 s"), std::string::npos) << trouble;
}

TEST_F(PluginFiles, EveryBadOneOnTheSearchPathIsNamedWithItsReasonAndStopsNothing) {
  for (const Bad& bad : bad_plugins()) place_in(folder_, bad.name);
  fs::copy_file(ROUTEBENCH_TOY_PLUGIN, folder_ / "toys.so");
  fs::copy_file(ROUTEBENCH_TOY_PLUGIN, folder_ / "twins.so");
  std::ofstream(folder_ / "notes.txt") << "no business of ours\n";
  const ProgramRun run = call({"planners", "--json"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const nlohmann::json document = run.json();
  ASSERT_EQ(document["plugins"].size(), bad_plugins().size() + 2);
  for (const nlohmann::json& plugin : document["plugins"]) {
    const fs::path file = plugin["file"].get<std::string>();
    SCOPED_TRACE(file);
    EXPECT_EQ(plugin["by_name"], false);
    EXPECT_EQ(plugin["loaded"], file.stem() == "toys");
    if (plugin["loaded"]) continue;
    const std::string reason = plugin["refused_because"];
    EXPECT_FALSE(reason.empty());
    EXPECT_EQ(reason.find('\n'), std::string::npos);
    EXPECT_EQ(plugin["sha256"].get<std::string>().size(), 64U);
    std::vector<std::string> words{"taken"};  // the twins' names
    for (const Bad& bad : bad_plugins())
      if (file.stem() == bad.name) words = bad.reason;
    for (const std::string& word : words)
      EXPECT_NE(reason.find(word), std::string::npos) << reason << " lacks " << word;
  }
  EXPECT_EQ(document["plugin_folders"][0]["folder"], folder_.string());
  EXPECT_EQ(document["plugin_folders"][0]["exists"], true);
}

TEST_F(PluginFiles, FoldersAreListedInTheirOrderAndMayBeMissing) {
  const std::string missing = in_folder("missing");
  setenv("ROUTEBENCH_PLUGIN_PATH", (missing + "::" + folder_.string()).c_str(), 1);
  fs::copy_file(ROUTEBENCH_TOY_PLUGIN, folder_ / "toys.so");
  const ProgramRun run = call({"planners"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err, "");
  const std::size_t first = run.out.find("searched: " + missing + " (is not there)\n");
  const std::size_t second = run.out.find("searched: " + folder_.string() + "\n");
  EXPECT_NE(first, std::string::npos) << run.out;
  EXPECT_LT(first, second) << run.out;
  EXPECT_NE(run.out.find("lib/routebench/plugins", second), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("loaded: " + in_folder("toys.so") + ": "), std::string::npos) << run.out;
}

TEST_F(PluginFiles, TheUsersOwnFolderIsSearchedToo) {
  const fs::path data = folder_ / "data";
  fs::create_directories(data / "routebench" / "plugins");
  fs::copy_file(ROUTEBENCH_TOY_PLUGIN, data / "routebench" / "plugins" / "toys.so");
  setenv("XDG_DATA_HOME", data.c_str(), 1);
  const ProgramRun run = call({"planners", "leash"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
}

TEST_F(PluginFiles, AFileThatIsAskedForIsNotLookedAtAgain) {
  fs::copy_file(ROUTEBENCH_TOY_PLUGIN, folder_ / "toys.so");
  for (const std::vector<std::string>& twice :
       {std::vector<std::string>{}, {"--plugin", in_folder("toys.so")}}) {
    std::vector<std::string> words{"planners", "--json", "--plugin", in_folder("./toys.so")};
    words.insert(words.end(), twice.begin(), twice.end());
    const ProgramRun run = call(words);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    ASSERT_EQ(run.json()["plugins"].size(), 1U);
    EXPECT_EQ(run.json()["plugins"][0]["by_name"], true);
    EXPECT_EQ(run.json()["plugins"][0]["loaded"], true);
  }
}

TEST_F(PluginFiles, ABadOneOnTheSearchPathIsAWarningElsewhere) {
  const fs::path file = place_in(folder_, "spoilt_exits");
  const ProgramRun run =
      call({"plan", "shape:box?size=4", "--shell", "greedy_shell", "--fill", "rectilinear",
            "--task", "density=1", "--layers", "3", "--jobs", "1"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(run.err.starts_with("routebench: warning: plugin " + file.string() + ": refused: "))
      << run.err;
}

TEST_F(PluginFiles, ABadOneThatIsAskedForIsRefused) {
  unsetenv("ROUTEBENCH_PLUGIN_PATH");
  for (const Bad& bad : bad_plugins()) {
    SCOPED_TRACE(bad.name);
    const fs::path file = place_in(folder_, bad.name);
    const ProgramRun run = call({"plan", "shape:box", "--fill", "rectilinear", "--plugin", file});
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    for (const std::string& word : bad.reason)
      EXPECT_NE(run.err.find(word), std::string::npos) << run.err << " lacks " << word;
  }
}

TEST_F(PluginFiles, ABadOneCostsAnExperimentOnlyWhatNeedsIt) {
  unsetenv("ROUTEBENCH_PLUGIN_PATH");
  for (const Bad& bad : bad_plugins()) {
    SCOPED_TRACE(bad.name);
    place_in(folder_, bad.name);
    const std::string config = config_with(bad.name + ".so");
    const ProgramRun run = call({"run", config, "--fresh", "--out", in_folder("out")});
    EXPECT_EQ(run.exit_code, 1) << run.err;
    EXPECT_TRUE(run.out.starts_with("2 cells: 1 valid, 1 failed\n")) << run.out;
    for (const std::string& word : bad.reason)
      EXPECT_NE(run.out.find(word), std::string::npos) << run.out << " lacks " << word;
    EXPECT_NE(run.err.find("warning: plugin " + in_folder(bad.name)), std::string::npos) << run.err;
  }
}

TEST_F(PluginFiles, WhereNothingWasRefusedAnUnknownPlannerIsAMistakeOfTheConfig) {
  fs::copy_file(ROUTEBENCH_TOY_PLUGIN, folder_ / "good.so");
  const ProgramRun run = call({"run", config_with("good.so"), "--out", in_folder("out")});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("unknown planner 'idle'"), std::string::npos) << run.err;
}

TEST_F(PluginFiles, ARepairedOneIsExecutedAnew) {
  unsetenv("ROUTEBENCH_PLUGIN_PATH");
  place_in(folder_, "text");
  const std::string config = config_with("text.so");
  EXPECT_EQ(call({"run", config, "--out", in_folder("out")}).exit_code, 1);
  fs::copy_file(test_plugin("spoilt_crashes"), folder_ / "text.so",
                fs::copy_options::overwrite_existing);
  const ProgramRun again = call({"run", config, "--out", in_folder("out")});
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_NE(again.err.find("executing 1 cells"), std::string::npos) << again.err;
  EXPECT_NE(again.out.find("SIGSEGV"), std::string::npos) << again.out;
}

}  // namespace
}  // namespace routebench
