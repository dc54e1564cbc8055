/// The commands slice, planners and doctor, and what all commands have in common.

#include <sys/resource.h>

#include <cmath>
#include <set>

#include "program.hpp"

namespace routebench {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::keys_of;
using test::ProgramRun;

constexpr const char* kToys = ROUTEBENCH_TOY_PLUGIN;

class Program : public test::ProgramTest {};

TEST_F(Program, HelpIsThereForEveryCommand) {
  const ProgramRun help = call({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  for (const std::string command :
       {"run", "plan", "score", "slice", "planners", "check-planner", "new-planner", "plot", "gate",
        "report", "view", "export", "merge", "reproduce", "doctor"}) {
    EXPECT_NE(help.out.find("\n  " + command + " "), help.out.npos) << command;
    const ProgramRun own = call({command, "--help"});
    EXPECT_EQ(own.exit_code, 0) << command;
    EXPECT_NE(own.out.find("routebench " + command), own.out.npos) << command << own.out;
  }
  EXPECT_NE(call({"plan", "--help"}).out.find("gate_covered_min=0.95"), std::string::npos)
      << "the keys of the task are listed with their defaults";
}

TEST_F(Program, UnknownCommandsAndOptionsAreRefusedWithAHint) {
  expect_refused({"plann"}, "there is no command 'plann'; did you mean 'plan'?");
  expect_refused({}, "subcommand");
  expect_refused({"plan", "shape:box", "--fill", "voxel", "--task", "density=1", "perimeters=1"},
                 "'perimeters=1' was not expected; write --task before every KEY=VALUE");
  expect_refused({"slice", "shape:box", "--methd", "sweep"}, "did you mean '--method'?");
  expect_refused({"--frobnicate"}, "--frobnicate");
}

TEST_F(Program, ModelsThatCannotBeReadAreRefusedByName) {
  expect_refused({"slice", in_folder("none.stl")}, "none.stl");
  expect_refused({"slice", "shape:bocks"}, "box");
  expect_refused({"slice", folder_.string()}, folder_.filename().string());
}

TEST_F(Program, AFileThatMayNotGrowIsAnErrorLikeAFullDisk) {
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{4096, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  const ProgramRun sliced = call({"slice", "shape:sphere", "--wkt", in_folder("a.wkt")});
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(sliced.exit_code, 2) << sliced.err;
  EXPECT_EQ(sliced.err,
            "routebench: " + in_folder("a.wkt") + ": cannot be written: File too large\n");
  EXPECT_TRUE(fs::is_empty(folder_));
}

class SliceCommand : public test::ProgramTest {};

TEST_F(SliceCommand, MeasuresABoxByHand) {
  const ProgramRun run = call({"slice", "shape:box?size=12", "--json", "-"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json document = run.json();
  EXPECT_EQ(keys_of(document),
            (std::set<std::string>{"model", "mesh", "warnings", "method", "report", "layers"}));
  EXPECT_EQ(document["method"], "bucket");
  EXPECT_EQ(document["report"]["cracks_closed"], 0);
  const json& mesh = document["mesh"];
  EXPECT_EQ(mesh["open_edges"], 0);
  EXPECT_EQ(mesh["components"], 1);
  const auto side = [&](std::size_t axis) {
    return mesh["upper_mm"][axis].get<double>() - mesh["lower_mm"][axis].get<double>();
  };
  EXPECT_NEAR(std::max({side(0), side(1), side(2)}), 12, 1e-9);
  EXPECT_NEAR(mesh["volume_mm3"].get<double>(), side(0) * side(1) * side(2), 1e-6);
  int index = 0;
  for (const json& layer : document["layers"]) {
    EXPECT_EQ(keys_of(layer),
              (std::set<std::string>{"layer", "z_mm", "height_mm", "area_mm2", "perimeter_mm",
                                     "polygons", "holes", "repaired"}));
    EXPECT_EQ(layer["layer"], index);
    EXPECT_NEAR(layer["z_mm"].get<double>(), 0.2 * index + 0.1, 1e-9);
    EXPECT_NEAR(layer["area_mm2"].get<double>(), side(0) * side(1), 1e-4);
    EXPECT_NEAR(layer["perimeter_mm"].get<double>(), 2 * (side(0) + side(1)), 1e-4);
    EXPECT_EQ(layer["polygons"], 1);
    EXPECT_EQ(layer["holes"], 0);
    ++index;
  }
  EXPECT_EQ(index, std::lround(side(2) / 0.2));
}

TEST_F(SliceCommand, MethodsAndThreadsGiveTheSameLayers) {
  const auto layers = [&](const char* method, const char* jobs, const char* wkt) {
    const ProgramRun run = call({"slice", "shape:torus", "--method", method, "--jobs", jobs,
                                 "--wkt", in_folder(wkt), "--json", "-"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return run.json()["layers"];
  };
  const json expected = layers("bucket", "1", "a");
  EXPECT_EQ(layers("sweep", "2", "b"), expected);
  EXPECT_EQ(layers("naive", "3", "c"), expected);
  EXPECT_EQ(test::content_of(in_folder("b")), test::content_of(in_folder("a")));
  EXPECT_EQ(test::content_of(in_folder("c")), test::content_of(in_folder("a")));
}

TEST_F(SliceCommand, WritesLayersThatReadBackAsTheyWere) {
  const json of_mesh = call({"slice", "shape:torus", "--wkt", in_folder("a.wkt"), "--svg",
                             in_folder("svg"), "--json", "-"})
                           .json();
  const json of_file = call({"slice", in_folder("a.wkt"), "--json", "-"}).json();
  EXPECT_EQ(of_file["layers"], of_mesh["layers"]);
  EXPECT_TRUE(of_file["mesh"].is_null());
  EXPECT_EQ(static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_ / "svg"), {})),
            of_mesh["layers"].size());
  EXPECT_EQ(call({"slice", in_folder("a.wkt"), "--wkt", in_folder("b.wkt")}).exit_code, 0);
  EXPECT_EQ(test::content_of(in_folder("b.wkt")), test::content_of(in_folder("a.wkt")));
}

TEST_F(SliceCommand, ThePeoplesSummaryHasTheMeshReport) {
  const ProgramRun run = call({"slice", "shape:box?size=12"});
  EXPECT_EQ(run.exit_code, 0);
  for (const char* label : {"Triangles", "Open edges", "Volume", "Layers", "Cracks closed"})
    EXPECT_NE(run.out.find(label), run.out.npos) << label;
}

TEST_F(SliceCommand, BadUsageIsOneLine) {
  expect_refused({"slice", "shape:box", "--method", "buckets"}, "bucket");
  expect_refused({"slice", "shape:box", "--task", "layer_height_mm=-1"}, "layer_height_mm");
  expect_refused({"slice", "shape:box", "--wkt", "/dev/null/a.wkt"}, "/dev/null is not a folder");
}

TEST_F(SliceCommand, VoxelsSayWhatTheyNeedAndTakeTheLineWidth) {
  const ProgramRun run =
      call({"slice", "shape:box?size=12", "--method", "voxel", "--task", "line_width_mm=0.5",
            "--task", "layer_height_mm=0.4", "--json", "-"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json document = run.json();
  EXPECT_EQ(document["method"], "voxel");
  const json& mesh = document["mesh"];
  const auto cells = [&](std::size_t axis) {
    return std::floor(
               (mesh["upper_mm"][axis].get<double>() - mesh["lower_mm"][axis].get<double>()) / 0.5 +
               0.5) +
           1;
  };
  for (const json& layer : document["layers"])
    EXPECT_EQ(layer["area_mm2"], cells(0) * cells(1) * 0.25);
  // One empty cell all round.
  EXPECT_NE(run.err.find(" of " + std::to_string(std::lround(cells(0)) + 2) + " x "), run.err.npos)
      << run.err;
  EXPECT_EQ(call({"slice", "shape:box?size=12", "--method", "voxel", "--cell", "0.5", "--task",
                  "layer_height_mm=0.4", "--json", "-"})
                .json()["layers"],
            document["layers"]);
  expect_refused({"slice", "shape:box", "--method", "voxel", "--cell", "0.0001"}, "GiB");
  expect_refused({"slice", "shape:box", "--method", "voxel", "--cell", "-1"},
                 "--cell -1: must be a number of millimetres above 0");
  expect_refused({"slice", "shape:box", "--method", "voxel", "--cell", "nan"}, "--cell nan");
  expect_refused({"slice", "shape:box", "--cell", "1"}, "--cell");
}

class PlannersCommand : public test::ProgramTest {};

TEST_F(PlannersCommand, ListsWhatIsRegisteredAndFromWhere) {
  const ProgramRun run = call({"planners", "--plugin", kToys});
  EXPECT_EQ(run.exit_code, 0);
  for (const std::string part : {"greedy_shell", "rectilinear", "built in", "leash", kToys})
    EXPECT_NE(run.out.find(part), run.out.npos) << part;
}

TEST_F(PlannersCommand, DescribesParametersAsTheyAreDeclared) {
  const ProgramRun run = call({"planners", "leash", "--json", "--plugin", kToys});
  EXPECT_EQ(run.json(), (json{{"name", "leash"},
                              {"role", "fill"},
                              {"summary", "nozzle to corners"},
                              {"source", "nobody"},
                              {"origin", kToys},
                              {"params", json::array({{{"name", "lift_mm"},
                                                       {"type", "real"},
                                                       {"default", 0.0},
                                                       {"lowest", -10},
                                                       {"highest", 10},
                                                       {"choices", json::array()},
                                                       {"unit", "mm"},
                                                       {"help", "added to y"}}})}}));
  const ProgramRun text = call({"planners", "wrongdoer", "--plugin", kToys});
  EXPECT_NE(text.out.find("wrong = one_point"), text.out.npos) << text.out;
  EXPECT_NE(text.out.find("one of one_point, not_finite"), text.out.npos) << text.out;
}

TEST_F(PlannersCommand, JsonHoldsPlannersAndPlugins) {
  const json document = call({"planners", "--json", "--plugin", kToys}).json();
  EXPECT_EQ(keys_of(document), (std::set<std::string>{"planners", "plugins", "plugin_folders"}));
  ASSERT_EQ(document["plugins"].size(), 1u);
  EXPECT_EQ(document["plugins"][0]["loaded"], true);
  EXPECT_TRUE(document["plugins"][0]["refused_because"].is_null());
  EXPECT_EQ(document["plugins"][0]["planners"].size(), 4u);
  EXPECT_EQ(document["plugins"][0]["sha256"].get<std::string>().size(), 64u);
}

TEST_F(PlannersCommand, ARefusedPluginIsListedAndIsAnError) {
  std::ofstream(folder_ / "fake.so") << "no library";
  const ProgramRun run = call({"planners", "--plugin", in_folder("fake.so")});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.out.find("greedy_shell"), run.out.npos) << "the others are there all the same";
  EXPECT_NE(run.out.find("refused: " + in_folder("fake.so")), run.out.npos);
  EXPECT_NE(run.err.find("fake.so: refused: "), run.err.npos);
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
}

TEST_F(PlannersCommand, AnUnknownNameIsRefusedWithTheNearest) {
  expect_refused({"planners", "rectilinaer"}, "rectilinear");
}

class DoctorCommand : public test::ProgramTest {};

TEST_F(DoctorCommand, EveryLineSaysOkOrMissing) {
  const ProgramRun run = call({"doctor"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.err, "");
  std::istringstream lines(run.out);
  std::set<std::string> seen;
  for (std::string line; std::getline(lines, line);) {
    EXPECT_TRUE(line.starts_with("ok  ") || line.starts_with("missing  ")) << line;
    std::istringstream words(line);
    std::string state, name;
    words >> state >> name;
    seen.insert(name);
  }
  for (const char* name : {"routebench", "libraries", "machine", "timers", "planners", "write",
                           "python", "three.js", "cgal:", "prusa-slicer", "slic3r", "CuraEngine"})
    EXPECT_TRUE(seen.contains(name)) << name;
}

}  // namespace
}  // namespace routebench
