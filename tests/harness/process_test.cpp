/// Other programs, run and measured.

#include "slicers/process.hpp"

#include <gtest/gtest.h>
#include <signal.h>

#include "routebench/geometry/error.hpp"
#include "scratch_dir.hpp"

namespace routebench {
namespace {

class Process : public testing::Test {
 protected:
  /// Runs a script of the shell.
  ProcessEnd run(const std::string& script, std::optional<int> memory_mb = {},
                 std::optional<double> timeout_s = {}) {
    return run_process({"/bin/sh",
                        {"-c", script},
                        {{"ROUTEBENCH_TEST", "a b=c"}},
                        dir_.path(),
                        dir_.path() / "log",
                        memory_mb,
                        timeout_s});
  }
  [[nodiscard]] std::string log() const { return test::text_of_file(dir_.path() / "log"); }

  test::ScratchDir dir_;
};

TEST_F(Process, TellsHowItEnded) {
  EXPECT_EQ(run("exit 0").exit_code, 0);
  EXPECT_EQ(run("exit 7").exit_code, 7);
  const ProcessEnd killed = run("kill -SEGV $$");
  EXPECT_EQ(killed.signal, SIGSEGV);
}

TEST_F(Process, RunsInItsFolderWithItsVariablesAndWritesToItsLog) {
  static_cast<void>(run("pwd; echo \"$ROUTEBENCH_TEST\"; echo wrong >&2"));
  EXPECT_EQ(log(), std::filesystem::canonical(dir_.path()).string() + "\na b=c\nwrong\n");
}

TEST_F(Process, HasNothingOfOurs) {
  static_cast<void>(run("cat; ls /proc/self/fd | wc -l"));
  // Three streams and the folder that ls itself reads.
  EXPECT_EQ(log(), "4\n");
}

TEST_F(Process, AProgramThatCannotBeStartedIsRefused) {
  try {
    static_cast<void>(run_process(
        {dir_.write("text", "no program"), {}, {}, dir_.path(), dir_.path() / "log", {}, {}}));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
    EXPECT_EQ(error.what(),
              (dir_.path() / "text").string() + ": cannot be started: Permission denied");
  }
}

TEST_F(Process, TimeAndMemoryAreItsOwn) {
  const ProcessEnd idle = run("sleep 0.2");
  EXPECT_GE(idle.wall_s, 0.2);
  EXPECT_LT(idle.cpu_s, idle.wall_s);
  EXPECT_GT(idle.peak_rss_bytes, 1e5);

  // What this process holds is not counted as its.
  const std::vector<char> ballast(std::size_t{300} << 20, 'x');
  EXPECT_LT(run("sleep 0.2").peak_rss_bytes, 1e8);
  EXPECT_EQ(ballast.back(), 'x');

  const ProcessEnd busy = run("i=0; while [ $i -lt 200000 ]; do i=$((i+1)); done");
  EXPECT_GT(busy.cpu_s, 0.01);
}

TEST_F(Process, LimitsHold) {
  EXPECT_NE(run("/usr/bin/python3 -c 'x = bytearray(400 << 20)'", 200).exit_code, 0);
  EXPECT_NE(log().find("MemoryError"), std::string::npos) << log();
  EXPECT_EQ(run("exec sleep 60", {}, 0.1).signal, SIGKILL);
}

}  // namespace
}  // namespace routebench
