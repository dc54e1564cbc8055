#include <CLI/CLI.hpp>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arguments.hpp"
#include "json_documents.hpp"
#include "kept_memory.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/geometry/layer_io.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/harness/commands.hpp"
#include "routebench/harness/parallel.hpp"
#include "routebench/harness/pipeline.hpp"

namespace routebench {
namespace {

struct SliceArguments {
  std::string model;
  std::vector<std::string> task;
  std::string method = "bucket";
  std::optional<double> cell_mm;
  std::string wkt;
  std::string svg;
  std::string json;
  int jobs = 0;
  bool repair = false;
};

std::string extent(double lower, double upper) {
  return readable(upper - lower) + " (" + readable(lower) + " to " + readable(upper) + ")";
}

std::vector<Row> rows_of(const MeshReport& mesh) {
  const auto count = [](std::size_t number) { return std::to_string(number); };
  std::vector<Row> rows = {{"Triangles", count(mesh.triangles), ""},
                           {"Vertices", count(mesh.vertices), ""},
                           {"Extent x", extent(mesh.lower_mm.x, mesh.upper_mm.x), "mm"},
                           {"Extent y", extent(mesh.lower_mm.y, mesh.upper_mm.y), "mm"},
                           {"Extent z", extent(mesh.lower_mm.z, mesh.upper_mm.z), "mm"},
                           {"Volume", readable(mesh.volume_mm3), "mm3"},
                           {"Components", count(mesh.components), ""},
                           {"Open edges", count(mesh.open_edges), ""},
                           {"Non-manifold edges", count(mesh.non_manifold_edges), ""},
                           {"Flipped triangles", count(mesh.flipped_triangles), ""},
                           {"Degenerate triangles", count(mesh.degenerate_triangles), ""},
                           {"Duplicate triangles", count(mesh.duplicate_triangles), ""}};
  if (mesh.simplification) {
    rows.push_back({"Left of the triangles", count(mesh.simplification->triangles_after), ""});
    rows.push_back({"Moved by at most", readable(mesh.simplification->deviation_mm), "mm"});
  }
  return rows;
}

std::vector<Row> rows_of(const SliceReport& report, const std::vector<Layer>& layers) {
  std::size_t polygons = 0, empty = 0;
  double volume_mm3 = 0;
  for (const Layer& layer : layers) {
    polygons += layer.polygons.size();
    empty += layer.polygons.empty() ? 1u : 0u;
    volume_mm3 += area_mm2(layer.polygons) * layer.height_mm;
  }
  std::vector<Row> rows = {{"Layers", std::to_string(layers.size()), ""},
                           {"Empty layers", std::to_string(empty), ""},
                           {"Polygons", std::to_string(polygons), ""},
                           {"Volume of the layers", readable(volume_mm3), "mm3"},
                           {"Cracks closed", std::to_string(report.cracks_closed), ""},
                           {"Gaps repaired", std::to_string(report.gaps_repaired), ""},
                           {"Repaired layers", std::to_string(report.repaired_layers), ""}};
  if (report.cracks_closed > 0)
    rows.push_back({"Widest crack", readable(report.widest_crack_mm), "mm"});
  if (report.gaps_repaired > 0)
    rows.push_back({"Widest gap", readable(report.widest_gap_mm), "mm"});
  return rows;
}

void print_summary(std::ostream& out, const SlicedModel& model) {
  out << model.spec << '\n';
  std::vector<Row> rows;
  if (model.mesh) rows = rows_of(*model.mesh);
  for (Row& row : rows_of(model.report, model.layers)) rows.push_back(std::move(row));
  print_rows(out, rows);
}

void print_container(const std::string& model, const VoxelContainer& container) {
  constexpr double kMebibyte = 1048576;
  std::cerr << "routebench: " << model << ": a container of " << container.cells[0] << " x "
            << container.cells[1] << " x " << container.cells[2] << " cells takes "
            << readable(container.bytes / kMebibyte) << " MiB\n";
}

void slice(const SliceArguments& arguments) {
  const Task task = task_of(arguments.task);
  const SliceMethod method = slice_method(arguments.method);
  if (arguments.cell_mm && method != SliceMethod::kVoxel)
    throw Error(ErrorKind::kBadUsage, "--cell: only --method voxel has cells");
  if (arguments.cell_mm && !(*arguments.cell_mm > 0 && std::isfinite(*arguments.cell_mm)))
    throw Error(ErrorKind::kBadUsage, "--cell " + readable(*arguments.cell_mm) +
                                          ": must be a number of millimetres above 0");
  SlicedModel model = slice_model(
      arguments.model, task,
      {.method = method,
       .repair = arguments.repair,
       .find_skins = !arguments.svg.empty(),
       .cell_mm = arguments.cell_mm,
       .on_container =
           [&](const VoxelContainer& container) { print_container(arguments.model, container); }},
      parallel_loop(arguments.jobs));
  print_warnings(arguments.model, model.warnings);
  OutputSet outputs;
  if (!arguments.wkt.empty())
    outputs.add(arguments.wkt, [&](std::ostream& out) { write_wkt(out, model.layers); });
  if (!arguments.svg.empty()) {
    outputs.add_folder(arguments.svg);
    for (const Layer& layer : model.layers)
      outputs.add(layer_picture(arguments.svg, layer.index),
                  [&](std::ostream& out) { write_svg(out, layer); });
  }
  if (!arguments.json.empty() && arguments.json != "-")
    write_json(outputs, arguments.json, slice_document(model, arguments.method));
  outputs.commit();
  if (arguments.json == "-") {
    write_json(outputs, "-", slice_document(model, arguments.method));
  } else {
    print_summary(std::cout, model);
  }
  keep_until_exit(std::move(model));
}

}  // namespace

void add_slice_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<SliceArguments>();
  CLI::App& command =
      *app.add_subcommand("slice", "Cut a model into layers and report on its mesh");
  add_model_argument(command, arguments->model);
  add_task_option(command, arguments->task);
  command
      .add_option("--method", arguments->method,
                  "How triangles become layers: the first three give the same; voxel approximates "
                  "them by the outlines of cells in which or inside which the surface runs")
      ->type_name("bucket|sweep|naive|voxel")
      ->capture_default_str();
  command
      .add_option("--cell", arguments->cell_mm,
                  "Side of a voxel in x and y (in z it is a layer high); the task's line width if "
                  "not given")
      ->type_name("MM");
  command.add_option("--wkt", arguments->wkt, "Write the layers, one MULTIPOLYGON a line")
      ->type_name("FILE");
  command.add_option("--svg", arguments->svg, "Draw each layer into a folder")->type_name("DIR");
  command
      .add_option("--json", arguments->json,
                  "Write the report and each layer's measures; - is the standard output, alone")
      ->type_name("FILE|-");
  add_jobs_option(command, arguments->jobs);
  add_repair_flag(command, arguments->repair);
  command.callback([arguments, &exit_code] {
    slice(*arguments);
    exit_code = 0;
  });
}

}  // namespace routebench
