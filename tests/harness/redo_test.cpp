/// What is executed again, and why; and what a run would do.

#include <iomanip>
#include <sstream>

#include "database_content.hpp"
#include "routebench/geometry/model.hpp"
#include "runner_fixture.hpp"

namespace routebench {
namespace {

using test::culprit_contender;
using test::hatch_contender;
using test::squares_wkt;

class Redo : public test::RunnerTest {
 protected:
  /// Why a cell would be executed anew, and is, by the words of both; nothing if it is not.
  std::string why(const ExperimentConfig& config, const std::string& label) {
    std::string foreseen = "not executed";
    for (const ForeseenCell& cell : foresee_experiment(config, planners_, options_, {&log_}).cells)
      if (cell.label == label) foreseen = cell.why;
    execute(config);
    const std::string said = log_.str();
    const std::string line = "redoing " + label + ": ";
    const std::size_t at = said.find(line);
    const std::string told =
        at == std::string::npos
            ? ""
            : said.substr(at + line.size(), said.find('\n', at) - at - line.size());
    EXPECT_EQ(told, foreseen == "not executed" ? "" : foreseen) << said;
    return foreseen;
  }
};

TEST_F(Redo, TellsWhatHasChanged) {
  const std::string label = "small.wkt · a";
  EXPECT_EQ(why(config(hatch_contender("a")), label), "") << "new is not changed";
  EXPECT_EQ(why(config(hatch_contender("a")), label), "not executed");
  EXPECT_EQ(why(config(hatch_contender("a", ", version = 2")), label), "fill.version 1 -> 2");
  EXPECT_EQ(why(config(hatch_contender("a", ", version = 3, zigzag = false")), label),
            "fill.version 2 -> 3; fill.zigzag true -> false");
  const std::string now = hatch_contender("a", ", version = 3, zigzag = false");
  EXPECT_EQ(why(config(hatch_contender("b", ", version = 3, zigzag = false")), "small.wkt · b"),
            "the contender was called a");
  EXPECT_EQ(why(config(now), label), "not executed") << "it is there from before";
  EXPECT_EQ(why(config(now, "repetitions = 1", "seed = 7\n"), label), "seed 1 -> 7");
  EXPECT_EQ(why(config(now), label), "not executed");
  dir_.write("small.wkt", squares_wkt(9));
  EXPECT_EQ(why(config(now), label), "the model has changed");
  EXPECT_EQ(why(config(now), "large.wkt · a"), "not executed");
}

TEST_F(Redo, AMeshIsStoredWithWhatItIsKnownBy) {
  execute(config(hatch_contender("a"), "repetitions = 1", "", "\"shape:box?size=4\""));
  std::ostringstream hash;
  hash << std::hex << std::setw(16) << std::setfill('0')
       << content_hash(load_model("shape:box?size=4").mesh);
  EXPECT_EQ(test::rows_of(file(), "SELECT mesh_hash FROM model"),
            std::vector<std::string>{hash.str()});
}

TEST_F(Redo, TellsWhatOfTheTaskAndThePrinterHasChanged) {
  const auto with = [&](const std::string& task, const std::string& printer) {
    return parse_config("name = \"t\"\nmodels = [\"small.wkt\"]\n[task]\nperimeters = 0\n" + task +
                            "[printer]\n" + printer + "[run]\nrepetitions = 1\n" +
                            hatch_contender("a"),
                        dir_.path() / "t.toml");
  };
  const std::string label = "small.wkt · a";
  EXPECT_EQ(why(with("density = 1\n", ""), label), "");
  EXPECT_EQ(why(with("density = 0.5\n", ""), label), "task.density 1 -> 0.5");
  EXPECT_EQ(why(with("density = 0.5\n", "retract_over_mm = 3\n"), label),
            "printer.retract_over_mm 2 -> 3");
}

TEST_F(Redo, TellsOfARaisedLimit) {
  const auto with_timeout = [&](const char* timeout) {
    return config(culprit_contender("nap"), std::string("repetitions = 1\ntimeout_s = ") + timeout,
                  "", "\"small.wkt\"");
  };
  execute(with_timeout("0.1"));
  EXPECT_EQ(why(with_timeout("20"), "small.wkt · nap"), "it had timed out; timeout_s 0.1 -> 20");
}

TEST_F(Redo, ForesightCountsCellsAndSamplesAndWritesNothing) {
  const ExperimentConfig both =
      config(hatch_contender("a") + hatch_contender("b"), "repetitions = 3");
  const auto foresee = [&] { return foresee_experiment(both, planners_, options_, {&log_}); };
  const Foresight first = foresee();
  EXPECT_EQ(first.cells.size(), 4u);
  EXPECT_EQ(first.cells[0].label, "small.wkt · a");
  EXPECT_EQ(first.samples, 8u) << "with one job the execution itself is a sample";
  EXPECT_EQ(first.known_cells, 0u);
  EXPECT_GT(first.cells_s, 0);
  EXPECT_GT(first.cells[2].seconds, first.cells[0].seconds) << "the larger model takes longer";
  EXPECT_FALSE(std::filesystem::exists(options_.out));

  execute(config(hatch_contender("a"), "repetitions = 3"));
  const Foresight second = foresee();
  EXPECT_EQ(second.cells.size(), 2u);
  EXPECT_EQ(second.found, 2u);
  EXPECT_EQ(second.samples, 4u);
  EXPECT_EQ(second.known_cells, 2u);
  EXPECT_EQ(cells().size(), 2u);
  std::ostringstream text;
  write_foresight(text, second);
  EXPECT_NE(text.str().find("would execute small.wkt · b\nwould execute large.wkt · b\n"
                            "2 cells to execute, 2 done, 4 timing samples to take\nabout "),
            std::string::npos)
      << text.str();
  EXPECT_NE(text.str().find("estimated from the times of 2 cells in the database\n"),
            std::string::npos);

  options_.jobs = 4;
  EXPECT_EQ(foresee().samples, 6u);
  options_.jobs = 1;
  execute(both);
  const Foresight done = foresee();
  EXPECT_TRUE(done.cells.empty());
  EXPECT_EQ(done.samples, 0u);
}

TEST_F(Redo, ForesightFollowsTheTimesThatAreKnown) {
  // The nap is longer than anything else here.
  execute(config(culprit_contender("nap") + hatch_contender("a"), "repetitions = 1", "",
                 "\"small.wkt\""));
  const Foresight foresight = foresee_experiment(
      config(culprit_contender("nap") + hatch_contender("a")), planners_, options_, {&log_});
  ASSERT_EQ(foresight.cells.size(), 2u);
  EXPECT_EQ(foresight.cells[0].label, "large.wkt · nap");
  EXPECT_GT(foresight.cells[0].seconds, 0.3);
  EXPECT_LT(foresight.cells[1].seconds, foresight.cells[0].seconds);
}

}  // namespace
}  // namespace routebench
