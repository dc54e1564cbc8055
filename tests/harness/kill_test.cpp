/// Runs that are killed at random moments, again and again, come to the same results.

#include <signal.h>
#include <sys/wait.h>

#include <chrono>
#include <random>

#include "runner_fixture.hpp"

namespace routebench {
namespace {

using test::culprit_contender;
using test::hatch_contender;

class Killed : public test::RunnerTest {
 protected:
  /// Starts a run, lets it live for so long, and ends it. True if it had come to its end before.
  bool run_for(std::chrono::microseconds life, const ExperimentConfig& config, int signal) {
    const pid_t process = test::run_elsewhere(config, planners_, options_);
    usleep(static_cast<useconds_t>(life.count()));
    kill(process, signal);
    int status = 0;
    waitpid(process, &status, 0);
    EXPECT_FALSE(WIFEXITED(status) && WEXITSTATUS(status) == 3) << "the run threw";
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
  }
};

TEST_F(Killed, AtAnyMomentItGoesOnToTheSameDatabase) {
  constexpr int kKills = 60;
  const ExperimentConfig all = config(
      hatch_contender("a", ", version = [1, 2, 3]") + hatch_contender("b", ", zigzag = false") +
          culprit_contender("skip") + culprit_contender("throw") + culprit_contender("segfault"),
      "repetitions = 2\nkeep_layers = \"all\"", "seed = [1, 2]\n");
  const auto began = std::chrono::steady_clock::now();
  execute(all);
  const auto whole = std::chrono::duration_cast<std::chrono::microseconds>(
      std::chrono::steady_clock::now() - began);
  const std::vector<std::string> undisturbed = content();
  ASSERT_EQ(test::rows_of(file(), "SELECT count(*) FROM cell"), std::vector<std::string>{"28"});

  // A run that came to its end is looked at, and the next one begins in another folder: so there is
  // something left to do at every kill. Every other folder holds an old run that --fresh replaces.
  std::mt19937 random(20260101);
  std::uniform_int_distribution<std::int64_t> life_us(0, whole.count());
  int kills = 0;
  for (int folder = 0; kills < kKills; ++folder) {
    options_.out = dir_.path() / ("killed" + std::to_string(folder));
    options_.jobs = 1 + folder % 2;
    if (folder % 2 == 1) {
      execute(config(hatch_contender("old")));
      options_.fresh = true;
      for (int i = 0; i < 2 && !run_for(std::chrono::microseconds(life_us(random)), all, SIGKILL);
           ++i)
        ++kills;
      options_.fresh = false;
    }
    // Later attempts live longer, or an unlucky machine would never come to an end.
    for (int attempt = 1; attempt < 12; ++attempt) {
      const int signal = random() % 3 == 0 ? SIGINT : SIGKILL;
      if (run_for(std::chrono::microseconds(life_us(random) / 4 * attempt), all, signal)) break;
      ++kills;
    }
    execute(all);
    ASSERT_EQ(content(), undisturbed) << "after " << kills << " kills, in " << options_.out;
    EXPECT_EQ(test::rows_of(file(), "SELECT count(*) FROM cell JOIN current_cell USING(cell_id)"),
              std::vector<std::string>{"28"});
    std::filesystem::remove_all(options_.out);
  }
}

}  // namespace
}  // namespace routebench
