#include "routebench/harness/config.hpp"

#include <gtest/gtest.h>

#include "routebench/geometry/error.hpp"

namespace routebench {
namespace {

using testing::TestWithParam;

/// A planner that does nothing but have parameters.
template <PlannerRole role>
class Idle final : public Planner {
 public:
  struct Params {
    double angle_deg = 0;
    int passes = 1;
    bool alternate = true;
    void bind(ParamBinder& bind) {
      bind("angle_deg", angle_deg, {-180, 180}, "deg", "direction");
      bind("passes", passes, {1, 4}, "", "how often");
      bind("alternate", alternate, "every other layer the other way");
    }
  };
  static PlannerInfo info() {
    return {role == PlannerRole::kShell ? "idle_shell" : "idle_fill", role, "does nothing", ""};
  }
  explicit Idle(const Params&) {}
  [[nodiscard]] Route plan(const Layer&, const PlanContext&) const override { return {}; }
};

Registry idle_planners() {
  Registry registry;
  registry.add<Idle<PlannerRole::kShell>>();
  registry.add<Idle<PlannerRole::kFill>>();
  return registry;
}

/// The least that a config needs, for tests that add to it.
constexpr const char* kHead = "name = \"t\"\nmodels = [\"shape:box\"]\n";
constexpr const char* kContender =
    "[[contender]]\nname = \"c\"\nfill = { planner = \"idle_fill\" }\n";

ExperimentConfig parsed(const std::string& text) { return parse_config(text, "dir/x.toml"); }

/// What is said of a config by reading it or by checking it against the idle planners.
std::string complaint_about(const std::string& text) {
  try {
    check_contenders(parsed(text), idle_planners());
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
    return error.what();
  }
  return "none";
}

std::vector<std::string> contender_names(const ExperimentConfig& config) {
  std::vector<std::string> names;
  for (const ConfiguredContender& contender : config.contenders)
    names.push_back(contender.spec.name);
  return names;
}

std::vector<std::string> texts(const std::vector<KeyValue>& values) {
  std::vector<std::string> result;
  for (const KeyValue& pair : values) result.push_back(pair.key + "=" + pair.value);
  return result;
}

std::vector<std::string> setting_labels(const ExperimentConfig& config) {
  std::vector<std::string> labels;
  for (const Setting& setting : config.settings) labels.push_back(setting.label);
  return labels;
}

constexpr const char* kClaim = "[[claim]]\ncontender = \"c\"\nsize = \"layers\"\nexponent = 1\n";
constexpr const char* kPublished =
    "[[published]]\nmodel = \"shape:box\"\nprogram = \"theirs\"\nmetric = \"travel_mm\"\n"
    "value = 12.5\nsource = \"a paper\"\n";

TEST(Config, ClaimsAndPublishedFiguresAreKept) {
  const ExperimentConfig config = parsed(std::string(kHead) + kContender + kClaim + kPublished);
  ASSERT_EQ(config.claims.size(), 1U);
  EXPECT_EQ(config.claims[0].contender, "c");
  EXPECT_EQ(config.claims[0].size, "layers");
  EXPECT_EQ(config.claims[0].exponent, 1);
  ASSERT_EQ(config.published.size(), 1U);
  EXPECT_EQ(config.published[0].value, 12.5);
  const std::string resolved = resolved_json(config, idle_planners());
  EXPECT_NE(resolved.find("\"claims\""), std::string::npos);
  EXPECT_NE(resolved.find("a paper"), std::string::npos);
}

TEST(Config, ClaimsAreAboutWhatTheConfigHas) {
  const auto replaced = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  const std::string head = std::string(kHead) + kContender;
  EXPECT_EQ(complaint_about(head + replaced(kClaim, "\"c\"", "\"d\"")),
            "dir/x.toml:7: key `contender`: there is no `d`; did you mean `c`?");
  EXPECT_EQ(complaint_about(head + replaced(kClaim, "layers", "layer")),
            "dir/x.toml:8: key `size`: there is no `layer`; did you mean `layers`?");
  EXPECT_EQ(complaint_about(head + replaced(kPublished, "travel_mm", "travel")),
            "dir/x.toml:9: key `metric`: there is no `travel`; did you mean `travels`?");
  EXPECT_EQ(complaint_about(head + replaced(kPublished, "shape:box", "shape:bow")),
            "dir/x.toml:7: key `model`: there is no `shape:bow`; did you mean `shape:box`?");
}

TEST(Config, AWayOfSlicingIsAContenderOfItsOwn) {
  const ExperimentConfig config = parsed(
      std::string(kHead) + "[[contender]]\nname = \"c\"\nslicing = [\"bucket\", \"naive\"]\n");
  EXPECT_EQ(contender_names(config),
            (std::vector<std::string>{"c [slicing=bucket]", "c [slicing=naive]"}));
  EXPECT_EQ(config.contenders[1].spec.slicing, SliceMethod::kNaive);
  EXPECT_NE(complaint_about(std::string(kHead) + kContender + "slicing = \"bucket\"\n")
                .find("give either"),
            std::string::npos);
}

TEST(Config, WhatIsNotWrittenHasTheDocumentedDefault) {
  const ExperimentConfig config = parsed(std::string(kHead) + kContender);
  EXPECT_EQ(config.name, "t");
  EXPECT_EQ(config.seeds, (std::vector<std::uint64_t>{1}));
  EXPECT_EQ(config.run.repetitions, 5);
  EXPECT_EQ(config.run.timeout_s, 120);
  EXPECT_EQ(config.run.memory_mb, 4096);
  EXPECT_EQ(config.run.keep_layers.of(9), (std::vector<std::size_t>{4}));
  ASSERT_EQ(config.settings.size(), 1u);
  EXPECT_EQ(config.settings[0].label, "");
  EXPECT_EQ(texts(task_values(config.settings[0].task)), texts(task_values(Task{})));
  EXPECT_EQ(texts(printer_values(config.settings[0].printer)), texts(printer_values(Printer{})));
  ASSERT_EQ(config.contenders.size(), 1u);
  EXPECT_EQ(config.contenders[0].spec.order, LayerOrder::kIsland);
  EXPECT_FALSE(config.contenders[0].spec.shell);
  EXPECT_EQ(config.cell_count(), 1u);
}

TEST(Config, ReadsEveryKey) {
  const ExperimentConfig config = parsed(R"(
    name = "all-keys_1.0"
    seed = 7
    models = ["shape:box?size=20", "cgal:meshes/elephant.off", "parts/a.stl?size=60", "/abs/b.stl"]
    optional_models = ["cgal:meshes/knot.off"]
    plugins = ["p.so"]
    [task]
    layer_height_mm = 0.3
    line_width_mm = 0.5
    perimeters = 3
    density = 0
    start_mm = [1, -2.5]
    gate_covered_min = 0.9
    [printer]
    retract_policy = "manhattan"
    travel_mm_s = 200
    [run]
    repetitions = 2
    timeout_s = 0.5
    memory_mb = 100
    jobs = 3
    keep_layers = [7, 0, 7]
    [[contender]]
    name = "both"
    order = "stage"
    shell = { planner = "idle_shell", passes = 2 }
    fill.planner = "idle_fill"
    fill.alternate = false
  )");
  EXPECT_EQ(config.seeds, (std::vector<std::uint64_t>{7}));
  ASSERT_EQ(config.models.size(), 5u);
  EXPECT_EQ(config.models[0].source, "shape:box?size=20");
  EXPECT_EQ(config.models[1].source, "cgal:meshes/elephant.off");
  EXPECT_EQ(config.models[2].spec, "parts/a.stl?size=60");
  EXPECT_EQ(config.models[2].source, "dir/parts/a.stl?size=60");
  EXPECT_EQ(config.models[3].source, "/abs/b.stl");
  EXPECT_FALSE(config.models[3].optional);
  EXPECT_EQ(config.models[4].source, "cgal:meshes/knot.off");
  EXPECT_TRUE(config.models[4].optional);
  EXPECT_EQ(config.plugins, (std::vector<std::string>{"dir/p.so"}));
  const Task& task = config.settings.at(0).task;
  EXPECT_EQ(task.layer_height_mm, 0.3);
  EXPECT_EQ(task.perimeters, 3);
  EXPECT_EQ(task.density, 0);
  EXPECT_EQ(task.start_mm, (Point2{1, -2.5}));
  EXPECT_EQ(task.gate.covered_min, 0.9);
  EXPECT_EQ(config.settings[0].printer.retract_policy, RetractPolicy::kManhattan);
  EXPECT_EQ(config.settings[0].printer.travel_mm_s, 200);
  EXPECT_EQ(config.run.jobs, 3);
  EXPECT_EQ(config.run.keep_layers.of(5), (std::vector<std::size_t>{0}));
  EXPECT_EQ(config.run.keep_layers.of(8), (std::vector<std::size_t>{0, 7}));
  const ContenderSpec& both = config.contenders.at(0).spec;
  EXPECT_EQ(both.order, LayerOrder::kStage);
  EXPECT_EQ(both.shell->params.at("passes"), ParamValue(std::int64_t{2}));
  EXPECT_EQ(both.fill->planner, "idle_fill");
  EXPECT_EQ(both.fill->params.at("alternate"), ParamValue(false));
  EXPECT_NO_THROW(check_contenders(config, idle_planners()));
}

TEST(Config, ListsOfAContenderMultiplyInTheOrderInWhichTheyAreWritten) {
  const ExperimentConfig config = parsed(std::string(kHead) + R"(
    [[contender]]
    name = "c"
    order = ["stage", "island"]
    fill = { planner = "idle_fill", passes = 2, angle_deg = [0, 22.5] }
    [[contender]]
    name = "one point"
    fill = { planner = "idle_fill", angle_deg = [45] }
  )");
  EXPECT_EQ(contender_names(config),
            (std::vector<std::string>{
                "c [order=stage, fill.angle_deg=0]", "c [order=stage, fill.angle_deg=22.5]",
                "c [order=island, fill.angle_deg=0]", "c [order=island, fill.angle_deg=22.5]",
                "one point [fill.angle_deg=45]"}));
  EXPECT_EQ(config.contenders[1].base_name, "c");
  EXPECT_EQ(config.contenders[1].spec.fill->params.at("angle_deg"), ParamValue(22.5));
  EXPECT_EQ(config.contenders[3].spec.order, LayerOrder::kIsland);
}

TEST(Config, PlannersCanBeSweptToo) {
  const ExperimentConfig config = parsed(std::string(kHead) + R"(
    [[contender]]
    name = "c"
    fill = { planner = ["idle_fill", "other"], passes = 2 }
  )");
  EXPECT_EQ(contender_names(config),
            (std::vector<std::string>{"c [fill.planner=idle_fill]", "c [fill.planner=other]"}));
  EXPECT_EQ(config.contenders[1].spec.fill->planner, "other");
}

TEST(Config, TaskAndPrinterMultiplyToSettingsAndSeedsStandBeside) {
  const ExperimentConfig config = parsed(R"(
    seed = [3, 1]
    name = "t"
    models = ["shape:box", "shape:gear"]
    [printer]
    retract_over_mm = [1, 2]
    [task]
    density = [0.2, 1]
    perimeters = 3
    [[contender]]
    name = "c"
    fill = { planner = "idle_fill" }
  )");
  EXPECT_EQ(
      setting_labels(config),
      (std::vector<std::string>{"density=0.2, retract_over_mm=1", "density=0.2, retract_over_mm=2",
                                "density=1, retract_over_mm=1", "density=1, retract_over_mm=2"}));
  EXPECT_EQ(config.settings[1].task.density, 0.2);
  EXPECT_EQ(config.settings[1].printer.retract_over_mm, 2);
  EXPECT_EQ(config.settings[1].task.perimeters, 3);
  EXPECT_EQ(config.seeds, (std::vector<std::uint64_t>{3, 1}));
  EXPECT_EQ(config.cell_count(), 2u * 1 * 4 * 2);
}

TEST(Config, SeveralTasksHaveNamesAndSweepsOfTheirOwn) {
  const ExperimentConfig config = parsed(std::string(kHead) + kContender +
                                         "[[task]]\nname = \"walls\"\ndensity = 0\n"
                                         "[[task]]\nname = \"inside\"\ndensity = [0.2, 1]\n"
                                         "[printer]\nretract_over_mm = [1, 2]\n");
  EXPECT_EQ(setting_labels(config),
            (std::vector<std::string>{
                "walls, retract_over_mm=1", "walls, retract_over_mm=2",
                "inside, density=0.2, retract_over_mm=1", "inside, density=0.2, retract_over_mm=2",
                "inside, density=1, retract_over_mm=1", "inside, density=1, retract_over_mm=2"}));
  EXPECT_EQ(config.settings[1].task.density, 0);
  EXPECT_EQ(config.settings[5].task.density, 1);
  EXPECT_EQ(config.settings[5].printer.retract_over_mm, 2);
}

TEST(Config, APairIsAValueAndAListOfPairsAnAxis) {
  const auto with_start = [](const std::string& start) {
    return parsed(kHead + ("[task]\nstart_mm = " + start + "\n") + kContender);
  };
  EXPECT_EQ(setting_labels(with_start("[0, 10]")), (std::vector<std::string>{""}));
  const ExperimentConfig swept = with_start("[[0, 0], [5, 2.5]]");
  EXPECT_EQ(setting_labels(swept), (std::vector<std::string>{"start_mm=0,0", "start_mm=5,2.5"}));
  EXPECT_EQ(swept.settings[1].task.start_mm, (Point2{5, 2.5}));
}

TEST(Config, KeepLayers) {
  const auto kept = [](const std::string& rule, std::size_t layers) {
    return parsed(kHead + ("[run]\nkeep_layers = " + rule + "\n") + kContender)
        .run.keep_layers.of(layers);
  };
  EXPECT_EQ(kept("\"none\"", 5), (std::vector<std::size_t>{}));
  EXPECT_EQ(kept("\"middle\"", 5), (std::vector<std::size_t>{2}));
  EXPECT_EQ(kept("\"middle\"", 1), (std::vector<std::size_t>{0}));
  EXPECT_EQ(kept("\"middle\"", 0), (std::vector<std::size_t>{}));
  EXPECT_EQ(kept("\"all\"", 3), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(kept("[4, 1]", 4), (std::vector<std::size_t>{1}));
  EXPECT_EQ(kept("[]", 4), (std::vector<std::size_t>{}));
}

TEST(Config, ResolvedTextHoldsDefaultsAndNumbersAsNumbers) {
  const ExperimentConfig config = parsed(std::string(kHead) + kContender);
  const std::string resolved = resolved_json(config, idle_planners());
  for (const char* part :
       {"\"density\": 0.2", "\"perimeters\": 2", "\"retract_policy\": \"length\"",
        "\"timeout_s\": 120.0", "\"passes\": 1", "\"keep_layers\": \"middle\""})
    EXPECT_NE(resolved.find(part), std::string::npos) << part << " in\n" << resolved;
}

TEST(Config, AFileThatIsNotThereOrAFolderIsNamed) {
  for (const char* file : {"no/such.toml", "/"}) {
    try {
      static_cast<void>(load_config(file));
      FAIL() << file;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
      EXPECT_TRUE(std::string(error.what()).starts_with(std::string(file) + ": ")) << error.what();
    }
  }
}

struct BadConfig {
  const char* label;
  std::string text;
  const char* complaint;  ///< all of it, or its beginning if it ends in "..."
};

void PrintTo(const BadConfig& bad, std::ostream* out) { *out << bad.text; }

class BadConfigs : public TestWithParam<BadConfig> {};

TEST_P(BadConfigs, AreRefusedWithFileLineKeyAndWhatWouldBeRight) {
  const std::string complaint = complaint_about(GetParam().text);
  std::string expected = GetParam().complaint;
  EXPECT_EQ(complaint.find('\n'), std::string::npos);
  if (expected.ends_with("...")) {
    expected.resize(expected.size() - 3);
    EXPECT_EQ(complaint.substr(0, expected.size()), expected);
  } else {
    EXPECT_EQ(complaint, expected);
  }
}

/// Lines after the two of kHead, and then a contender.
std::string with(const std::string& lines) { return kHead + (lines + "\n") + kContender; }
/// A contender of these lines; its first line is the third of the file.
std::string contender(const std::string& lines) {
  return std::string(kHead) + "[[contender]]\n" + lines + "\n";
}

INSTANTIATE_TEST_SUITE_P(
    Table, BadConfigs,
    testing::Values(
        BadConfig{"syntax", "name = \"t\"\nmodels = [\n", "dir/x.toml:2:12: ..."},
        BadConfig{"twice", "name = \"t\"\nname = \"u\"\n", "dir/x.toml:2:..."},
        BadConfig{"no_text", "name = \"\xff\"", "dir/x.toml:1:..."},
        BadConfig{"empty", "", "dir/x.toml:1: key `name`: missing from the config"},
        BadConfig{"top_key", with("sede = 3"),
                  "dir/x.toml:3: key `sede`: unknown key of the config; did you mean `seed`?"},
        BadConfig{
            "far_key", with("zzzzzzzz = 3"),
            "dir/x.toml:3: key `zzzzzzzz`: unknown key of the config; known are name, seed, "
            "models, optional_models, plugins, task, printer, run, contender, claim, published"},
        BadConfig{"name_path", "name = \"../up\"",
                  "dir/x.toml:1: key `name`: must be made of letters, digits, - _ and . (it names "
                  "the folder of the results), not \"../up\""},
        BadConfig{"name_type", "name = 3",
                  "dir/x.toml:1: key `name`: must be a text in quotes, not 3"},
        BadConfig{"models_text", "name = \"t\"\nmodels = \"shape:box\"\n",
                  "dir/x.toml:2: key `models`: must be a list of models, not \"shape:box\""},
        BadConfig{"models_none", "name = \"t\"\nmodels = []\n",
                  "dir/x.toml:2: key `models`: an empty list; an experiment needs a model"},
        BadConfig{"optional_twice", "name = \"t\"\nmodels = [\"a\"]\noptional_models = [\"a\"]\n",
                  "dir/x.toml:3: key `optional_models`: the model a stands twice"},
        BadConfig{"models_twice", "name = \"t\"\nmodels = [\"a\",\n\"a\"]\n",
                  "dir/x.toml:3: key `models`: the model a stands twice"},
        BadConfig{"task_nameless", with("[[task]]\ndensity = 1"),
                  "dir/x.toml:3: key `name`: missing from [[task]]"},
        BadConfig{"task_twice", with("[[task]]\nname = \"a\"\n[[task]]\nname = \"a\""),
                  "dir/x.toml:6: key `name`: the name a is taken by the task at dir/x.toml:4"},
        BadConfig{"task_name", with("[task]\nname = \"a\""),
                  "dir/x.toml:4: key `name`: unknown key of [task]; ..."},
        BadConfig{"seed_negative", with("seed = -1"),
                  "dir/x.toml:3: key `seed`: must be a whole number from 0 to 9223372036854775807, "
                  "not -1"},
        BadConfig{"seed_empty", with("seed = []"),
                  "dir/x.toml:3: key `seed`: an empty list sweeps over nothing; give a value, or "
                  "several in a list"},
        BadConfig{"seed_twice", with("seed = [1, 2, 1]"),
                  "dir/x.toml:3: key `seed`: the value 1 stands twice in the list"},
        BadConfig{"run_key", with("[run]\nrepetition = 3"),
                  "dir/x.toml:4: key `repetition`: unknown key of [run]; did you mean "
                  "`repetitions`?"},
        BadConfig{"run_range", with("[run]\nrepetitions = 0"),
                  "dir/x.toml:4: key `repetitions`: must be a whole number from 1 to 10000, not 0"},
        BadConfig{"run_type", with("[run]\ntimeout_s = \"fast\""),
                  "dir/x.toml:4: key `timeout_s`: must be a number from 0.01 to 1e+06, not "
                  "\"fast\""},
        BadConfig{"run_nan", with("[run]\ntimeout_s = nan"),
                  "dir/x.toml:4: key `timeout_s`: must be a number from 0.01 to 1e+06, not nan"},
        BadConfig{"run_sweep", with("[run]\njobs = [1, 2]"),
                  "dir/x.toml:4: key `jobs`: must be a whole number from 0 to 1024, not a list"},
        BadConfig{"run_no_table", with("run = 3"),
                  "dir/x.toml:3: key `run`: must be a table such as [run], not 3"},
        BadConfig{
            "keep_word", with("[run]\nkeep_layers = \"some\""),
            "dir/x.toml:4: key `keep_layers`: must be \"middle\", \"all\", \"none\" or a list "
            "of layer indices, not \"some\""},
        BadConfig{"keep_index", with("[run]\nkeep_layers = [3, -1]"),
                  "dir/x.toml:4: key `keep_layers`: must be a whole number from 0 to 10000000, not "
                  "-1"},
        BadConfig{"task_key", with("[task]\ndensitiy = 0.2"),
                  "dir/x.toml:4: key `densitiy`: unknown key of [task]; did you mean `density`?"},
        BadConfig{"task_range", with("[task]\nperimeters = 2\ndensity = [0.2, 3]"),
                  "dir/x.toml:5: key `density`: task: density = '3' is not a number from 0 to 1"},
        BadConfig{"task_type", with("[task]\ndensity = \"0.2\""),
                  "dir/x.toml:4: key `density`: must be a number, not \"0.2\""},
        BadConfig{
            "task_pair", with("[task]\nstart_mm = 3"),
            "dir/x.toml:4: key `start_mm`: must be two numbers in brackets such as [0, 0], not "
            "3"},
        BadConfig{"task_nested", with("[task]\ndensity = [[0.2]]"),
                  "dir/x.toml:4: key `density`: must be a number, a text or a truth value, not a "
                  "list"},
        BadConfig{"task_clash", with("[task]\nlayer_height_mm = 0.6"),
                  "dir/x.toml:3: key `task`: task: line_width_mm = 0.45 is less than "
                  "layer_height_mm = 0.6..."},
        BadConfig{"printer_type", with("[printer]\nretract_policy = 3"),
                  "dir/x.toml:4: key `retract_policy`: must be a text in quotes, not 3"},
        BadConfig{
            "printer_word", with("[printer]\nretract_policy = \"lenght\""),
            "dir/x.toml:4: key `retract_policy`: printer: retract_policy = 'lenght' is not one "
            "of length, length_and_crossing, manhattan; did you mean 'length'?"},
        BadConfig{"no_contender", kHead, "dir/x.toml:1: key `contender`: missing from the config"},
        BadConfig{"contender_table", std::string(kHead) + "[contender]\nname = \"c\"\n",
                  "dir/x.toml:3: key `contender`: must be one or more tables, each headed "
                  "[[contender]], not a table"},
        BadConfig{"contender_key", contender("name = \"c\"\nfillx = { planner = \"idle_fill\" }"),
                  "dir/x.toml:5: key `fillx`: unknown key of [[contender]]; did you mean `fill`?"},
        BadConfig{"contender_unnamed", contender("fill = { planner = \"idle_fill\" }"),
                  "dir/x.toml:3: key `name`: missing from [[contender]]"},
        BadConfig{"contender_empty", contender("name = \"c\""),
                  "dir/x.toml:4: key `name`: the contender has neither `shell` nor `fill` nor "
                  "`slicer`; give at least one"},
        BadConfig{"contender_twice", with(std::string(kContender)),
                  "dir/x.toml:8: key `name`: the name c is taken by the contender at dir/x.toml:4"},
        BadConfig{"slicer_name", contender("name = \"c\"\nslicer = \"prusaslicer\""),
                  "dir/x.toml:5: key `slicer`: unknown slicer 'prusaslicer'; did you mean "
                  "prusa-slicer?"},
        BadConfig{"slicer_with_planner",
                  contender("name = \"c\"\nslicer = \"slic3r\"\nfill = { planner = "
                            "\"idle_fill\" }"),
                  "dir/x.toml:6: key `fill`: a contender with a `slicer` has no planners; give "
                  "either"},
        BadConfig{"slicer_table", contender("name = \"c\"\nslicer = { comand = \"a\" }"),
                  "dir/x.toml:5: key `comand`: unknown key of `slicer`; did you mean `command`?"},
        BadConfig{"slicer_command", contender("name = \"c\"\nslicer = { command = \"a {model}\" }"),
                  "dir/x.toml:5: key `slicer`: the command lacks {gcode}; write something like "
                  "\"slicer --output {gcode} {model}\""},
        BadConfig{"slicer_number", contender("name = \"c\"\nslicer = 3"),
                  "dir/x.toml:5: key `slicer`: must be a text in quotes, not 3"},
        BadConfig{
            "order_word",
            contender("name = \"c\"\nfill = { planner = \"idle_fill\" }\norder = \"islands\""),
            "dir/x.toml:6: key `order`: must be \"island\" or \"stage\", not \"islands\""},
        BadConfig{"slot_text", contender("name = \"c\"\nfill = \"idle_fill\""),
                  "dir/x.toml:5: key `fill`: must be a table such as { planner = \"rectilinear\", "
                  "angle_deg = 45 }, not \"idle_fill\""},
        BadConfig{"slot_planner", contender("name = \"c\"\nfill = { passes = 2 }"),
                  "dir/x.toml:5: key `planner`: missing from `fill`"},
        BadConfig{"planner_name", contender("name = \"c\"\nfill = { planner = \"idle_fil\" }"),
                  "dir/x.toml:5: key `fill.planner`: ..."},
        BadConfig{"planner_role", contender("name = \"c\"\nfill = { planner = \"idle_shell\" }"),
                  "dir/x.toml:4: ..."},
        BadConfig{"param_name",
                  contender("name = \"c\"\nfill = { planner = \"idle_fill\", angel_deg = 2 }"),
                  "dir/x.toml:5: key `fill.angel_deg`: planner idle_fill: ..."},
        BadConfig{"param_range",
                  contender("name = \"c\"\n[contender.fill]\nplanner = \"idle_fill\"\npasses = "
                            "[1, 5]"),
                  "dir/x.toml:7: key `fill.passes`: planner idle_fill: ..."},
        BadConfig{
            "param_table",
            contender("name = \"c\"\nfill = { planner = \"idle_fill\", passes = {} }"),
            "dir/x.toml:5: key `fill.passes`: must be a number, a text or a truth value, not a "
            "table"},
        BadConfig{
            "param_date",
            contender("name = \"c\"\nfill = { planner = \"idle_fill\", passes = 2020-01-01 }"),
            "dir/x.toml:5: key `fill.passes`: must be a number, a text or a truth value, not a "
            "date or time"}),
    [](const testing::TestParamInfo<BadConfig>& bad) { return std::string(bad.param.label); });

TEST(Config, ASweepThatNobodyCanMeanIsRefusedBeforeItFillsTheMemory) {
  std::string axes;
  for (const char* key : {"layer_height_mm", "density", "join_mm", "gate_covered_min"}) {
    axes += std::string(key) + " = [";
    for (int i = 1; i <= 100; ++i) axes += (i == 1 ? "" : ", ") + std::to_string(0.001 * i);
    axes += "]\n";
  }
  EXPECT_EQ(complaint_about(with("[task]\n" + axes)),
            "dir/x.toml:6: key `join_mm`: the sweep has more than 10000 combinations; sweep over "
            "fewer values");
}

}  // namespace
}  // namespace routebench
