/// The command new-planner; that its project builds and works is shown by tests/package.

#include <algorithm>

#include "program.hpp"
#include "scratch_dir.hpp"

namespace routebench {
namespace {

namespace fs = std::filesystem;

class NewPlannerCommand : public test::ProgramTest {};

TEST_F(NewPlannerCommand, WritesAProjectWithTheNameInEveryPlace) {
  const test::ProgramRun run = call({"new-planner", "my_spiral2", in_folder("project")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("check-planner my_spiral2 --plugin build/my_spiral2.so"),
            std::string::npos);
  const fs::path project = in_folder("project");
  for (const char* name : {"CMakeLists.txt", "my_spiral2.cpp", "experiment.toml"}) {
    const std::string text = test::content_of(project / name);
    EXPECT_NE(text.find("my_spiral2"), std::string::npos) << name;
    EXPECT_EQ(text.find('@'), std::string::npos) << name;
  }
  const std::string source = test::content_of(project / "my_spiral2.cpp");
  EXPECT_NE(source.find("class MySpiral2Planner final"), std::string::npos);
  EXPECT_LT(std::count(source.begin(), source.end(), '\n'), 80);
}

TEST_F(NewPlannerCommand, RefusesNamesAndFoldersThatWillNotDo) {
  const std::string folder = in_folder("project");
  for (const char* name : {"", "Spiral", "2fast", "a-b", "a b", "a/b", "ä"})
    expect_refused({"new-planner", name, folder}, "no name for a planner");
  expect_refused({"new-planner", "test", folder}, "CMake");
  expect_refused({"new-planner", "greedy_shell", folder}, "already");
  expect_refused({"new-planner", "spiral", "/dev/null/spiral"}, "/dev/null is not a folder");
  EXPECT_FALSE(fs::exists(folder));

  const test::ScratchDir taken;
  taken.write("mine.txt", "mine");
  expect_refused({"new-planner", "spiral", taken.path()}, "not empty");
  EXPECT_EQ(std::distance(fs::directory_iterator(taken.path()), fs::directory_iterator()), 1);
}

}  // namespace
}  // namespace routebench
