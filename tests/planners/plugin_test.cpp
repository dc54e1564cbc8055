#include "routebench/planning/plugin.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "routebench/geometry/error.hpp"

namespace routebench {
namespace {

namespace fs = std::filesystem;

fs::path plugin_file(const std::string& name) {
  return fs::path(ROUTEBENCH_TEST_PLUGINS) / (name + ".so");
}

/// A place for files of one test.
class PluginTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              (std::string("plugin_test_") +
               testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_;
};

/// Loads a file that must be refused for a reason with these words, leaving the registry untouched.
void expect_refused(const fs::path& file, const std::vector<std::string>& mentions) {
  Registry registry;
  registry.set_origin("mine");
  ASSERT_TRUE(load_plugin(registry, plugin_file("outline")).loaded);
  const PluginRecord record = load_plugin(registry, file);
  EXPECT_FALSE(record.loaded);
  EXPECT_EQ(record.file, file.string());
  EXPECT_TRUE(record.planners.empty());
  EXPECT_EQ(record.refused_because.find('\n'), std::string::npos);
  for (const std::string& part : mentions) {
    EXPECT_NE(record.refused_because.find(part), std::string::npos)
        << "'" << record.refused_because << "' lacks '" << part << "'";
  }
  ASSERT_EQ(registry.entries().size(), 1U);
  EXPECT_EQ(registry.entries().begin()->first, "outline");
  EXPECT_EQ(registry.origin(), "mine");
}

TEST_F(PluginTest, AGoodOneIsLoadedAndPlans) {
  Registry registry;
  const PluginRecord record = load_plugin(registry, plugin_file("outline"));
  EXPECT_TRUE(record.loaded) << record.refused_because;
  EXPECT_EQ(record.refused_because, "");
  EXPECT_EQ(record.planners, std::vector<std::string>{"outline"});
  EXPECT_EQ(record.build_id, plugin_build_id());
  EXPECT_EQ(record.sha256.size(), 64U);
  EXPECT_EQ(registry.at("outline").origin, plugin_file("outline").string());

  Layer layer;
  layer.polygons = {{{{0, 0}, {4, 0}, {4, 3}, {0, 3}}, {}}};
  const Route route = registry.at("outline").make({})->plan(layer, {});
  ASSERT_EQ(route.strokes.size(), 1U);
  EXPECT_EQ(route.strokes[0].points.size(), 5U);
}

TEST_F(PluginTest, ItsErrorsAreCaughtByTypeInTheProgram) {
  Registry registry;
  ASSERT_TRUE(load_plugin(registry, plugin_file("outline")).loaded);
  EXPECT_THROW((void)registry.at("outline").make({{"hole", true}}), Error);
  Layer layer;
  layer.polygons = {{{{0, 0}, {4, 0}, {4, 3}, {0, 3}}, {}}};
  std::stop_source source;
  source.request_stop();
  PlanContext context;
  context.stop = source.get_token();
  try {
    (void)registry.at("outline").make({})->plan(layer, context);
    ADD_FAILURE() << "it did not stop";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kStopped);
  }
}

TEST_F(PluginTest, IsFoundByARelativeName) {
  const fs::path before = fs::current_path();
  fs::current_path(ROUTEBENCH_TEST_PLUGINS);
  Registry registry;
  const PluginRecord record = load_plugin(registry, "outline.so");
  fs::current_path(before);
  EXPECT_TRUE(record.loaded) << record.refused_because;
}

TEST_F(PluginTest, PlannersAddedLaterKeepTheirOwnOrigin) {
  Registry registry;
  ASSERT_TRUE(load_plugin(registry, plugin_file("outline")).loaded);
  EXPECT_EQ(registry.origin(), "built in");
}

TEST_F(PluginTest, TheSameNamesAreRefusedASecondTime) {
  expect_refused(plugin_file("outline"), {"outline", "taken", plugin_file("outline").string()});
}

TEST_F(PluginTest, OtherAbi) {
  expect_refused(plugin_file("faulty_Abi"),
                 {"ABI " + std::to_string(kPluginAbi + 1), std::to_string(kPluginAbi)});
}

TEST_F(PluginTest, OtherBuildIsRefusedWithBothNames) {
  expect_refused(plugin_file("faulty_BuildId"), {"libodd++ 7", plugin_build_id()});
  expect_refused(plugin_file("faulty_NoBuildId"), {plugin_build_id()});
}

TEST_F(PluginTest, NoFunctionToCall) {
  expect_refused(plugin_file("faulty_NoFunction"), {"function"});
}

TEST_F(PluginTest, AnExceptionWhileRegisteringLeavesNothingBehind) {
  expect_refused(plugin_file("faulty_Throws"), {"no licence found: buy one"});
  expect_refused(plugin_file("faulty_ThrowsNumber"), {"exception"});
  expect_refused(plugin_file("faulty_Twice"), {"idle_a", "taken"});
  expect_refused(plugin_file("faulty_BadDefault"), {"bad_default", "share", "range"});
}

TEST_F(PluginTest, NoPlanner) { expect_refused(plugin_file("faulty_Nothing"), {"no planner"}); }

TEST_F(PluginTest, ALibraryThatIsNoPlugin) {
  expect_refused(plugin_file("no_symbol"), {"routebench_plugin", "ROUTEBENCH_REGISTER"});
}

TEST_F(PluginTest, FilesThatAreNoLibrary) {
  expect_refused(folder_ / "absent.so", {"no such file"});
  expect_refused(folder_, {"not a regular file"});

  std::ofstream(folder_ / "text.so") << "a note\n";
  expect_refused(folder_ / "text.so", {"not a shared library"});

  std::ofstream(folder_ / "empty.so").flush();
  expect_refused(folder_ / "empty.so", {"not a shared library"});

  fs::copy_file(plugin_file("no_symbol"), folder_ / "cut.so");
  fs::resize_file(folder_ / "cut.so", 100);
  expect_refused(folder_ / "cut.so", {"not a shared library"});
}

TEST_F(PluginTest, ANamedPipeDoesNotHang) {
  const fs::path pipe = folder_ / "pipe.so";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  expect_refused(pipe, {"not a regular file"});
}

}  // namespace
}  // namespace routebench
