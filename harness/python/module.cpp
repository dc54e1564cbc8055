/// The module routebench._routebench: what the program does, for Python. The package beside it
/// makes of it what users see.

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <chrono>
#include <future>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "arrays.hpp"
#include "json_documents.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/geometry/model.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/harness/parallel.hpp"
#include "routebench/harness/pipeline.hpp"
#include "routebench/harness/version.hpp"
#include "routebench/planning/ordering.hpp"

namespace routebench::python {
namespace {

namespace py = pybind11;

/// How soon Ctrl-C is noticed.
constexpr std::chrono::milliseconds kSignalCheck{50};

/// Runs work that may take long, without the lock of Python. Ctrl-C asks it to stop.
template <typename Work>
auto without_lock(Work&& work) {
  std::stop_source stop;
  std::optional<py::gil_scoped_release> released(std::in_place);
  auto result = std::async(std::launch::async, [&] { return work(stop.get_token()); });
  while (result.wait_for(kSignalCheck) != std::future_status::ready) {
    const py::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() == 0) continue;
    stop.request_stop();
    const py::gil_scoped_release again;
    result.wait();
    break;
  }
  released.reset();
  // Ctrl-C may have ended the planner's own process, too: then that is no error of its.
  if (PyErr_Occurred() != nullptr || PyErr_CheckSignals() != 0) throw py::error_already_set();
  return result.get();
}

struct SlicedFor {
  Task task;
  PreparedModel model;
};

struct PlannedModel {
  std::shared_ptr<const SlicedFor> of;
  Contender contender;
  std::uint64_t seed;
  std::vector<std::size_t> chosen;
  std::vector<PlannedLayer> layers;
  double peak_rss_bytes;
};

SliceMethod method_of(const std::string& name) {
  for (const auto& [known, method] :
       {std::pair<const char*, SliceMethod>{"bucket", SliceMethod::kBucket},
        {"sweep", SliceMethod::kSweep},
        {"naive", SliceMethod::kNaive},
        {"voxel", SliceMethod::kVoxel}})
    if (name == known) return method;
  throw Error(ErrorKind::kBadUsage,
              "method '" + name + "' is unknown; it is bucket, sweep, naive or voxel");
}

std::shared_ptr<SlicedFor> slice(const std::string& spec, bool repair, const std::string& method,
                                 int jobs, const py::kwargs& task) {
  auto sliced = std::make_shared<SlicedFor>();
  for (const auto& [key, value] : task)
    set_task_value(sliced->task, std::string(py::str(key)), setting_text(py::str(key), value));
  check_task(sliced->task);
  const SliceModelOptions options{.method = method_of(method), .repair = repair};
  sliced->model = without_lock([&](const std::stop_token&) {
    return prepare_model(spec, sliced->task, options, parallel_loop(jobs));
  });
  return sliced;
}

py::tuple layers_of(const std::shared_ptr<SlicedFor>& sliced) {
  const py::object owner = py::cast(sliced);
  const py::object make = py::module_::import("routebench.planner").attr("Layer");
  const std::vector<Layer>& layers = sliced->model.sliced.layers;
  py::tuple all(layers.size());
  for (std::size_t i = 0; i < layers.size(); ++i)
    all[i] = make(layers[i].index, layers[i].z_mm, layers[i].height_mm,
                  tuple_of(layers[i].polygons, owner), tuple_of(layers[i].solid, owner));
  return all;
}

/// "rectilinear", or { "planner": ..., "angle_deg": 45 }, or { "command": ... } as in a config.
std::optional<SlotSpec> slot_of(const py::object& given, const char* slot) {
  if (given.is_none()) return std::nullopt;
  if (py::isinstance<py::str>(given)) return SlotSpec{given.cast<std::string>(), {}};
  if (!py::isinstance<py::dict>(given))
    throw Error(ErrorKind::kBadUsage,
                std::string(slot) + " must be a planner's name or a dict with the key planner");
  SlotSpec spec{"", params_of(given.cast<py::dict>())};
  for (const auto& [key, prefix] : {std::pair<std::string, std::string>{"planner", ""},
                                    {"command", std::string(kCommandPrefix)}})
    if (const auto found = spec.params.extract(key)) {
      if (!spec.planner.empty() || !std::holds_alternative<std::string>(found.mapped()))
        throw Error(ErrorKind::kBadUsage,
                    std::string(slot) + " needs the name of one planner or command");
      spec.planner = prefix + std::get<std::string>(found.mapped());
    }
  if (spec.planner.empty())
    throw Error(ErrorKind::kBadUsage, std::string(slot) + " lacks the key planner");
  return spec;
}

std::vector<std::size_t> chosen_layers(const SlicedModel& model,
                                       const std::optional<std::vector<std::size_t>>& wanted) {
  if (!wanted) return all_layers(model);
  std::vector<std::size_t> chosen = *wanted;
  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  if (!chosen.empty() && chosen.back() >= model.layers.size())
    throw Error(ErrorKind::kBadUsage, "layer " + std::to_string(chosen.back()) +
                                          " is not there; the model has " +
                                          std::to_string(model.layers.size()) + " layers");
  return chosen;
}

PlannerSet planners_of(const std::vector<std::string>& plugins,
                       const std::vector<std::string>& names) {
  PlannerSet planners = load_planners(plugins);
  require_all_loaded(planners);
  add_commands(planners, names);
  return planners;
}

std::shared_ptr<PlannedModel> plan(const std::shared_ptr<SlicedFor>& model, const py::object& shell,
                                   const py::object& fill, const std::string& order,
                                   std::uint64_t seed,
                                   const std::optional<std::vector<std::size_t>>& layers,
                                   const std::vector<std::string>& plugins, int jobs) {
  ContenderSpec spec;
  spec.shell = slot_of(shell, "shell");
  spec.fill = slot_of(fill, "fill");
  spec.order = layer_order(order);
  std::vector<std::string> names;
  for (const std::optional<SlotSpec>& slot : {spec.shell, spec.fill}) {
    if (!slot) continue;
    names.push_back(slot->planner);
    spec.name += (spec.name.empty() ? "" : " + ") + slot->planner;
  }
  return without_lock([&](const std::stop_token& stop) {
    Contender contender(spec, planners_of(plugins, names).registry);
    const SlicedModel& sliced = model->model.sliced;
    std::vector<std::size_t> chosen = chosen_layers(sliced, layers);
    std::vector<PlannedLayer> planned =
        plan_layers(contender, model->model, chosen, model->task, seed, stop, parallel_loop(jobs));
    const double peak_bytes = contender.peak_rss_bytes();
    return std::make_shared<PlannedModel>(PlannedModel{
        model, std::move(contender), seed, std::move(chosen), std::move(planned), peak_bytes});
  });
}

py::tuple strokes_of_plan(const std::shared_ptr<PlannedModel>& plan, std::size_t place) {
  if (place >= plan->layers.size()) throw py::index_error("no such planned layer");
  const PlannedLayer& layer = plan->layers[place];
  const py::object owner = py::cast(plan);
  const py::object make = py::module_::import("routebench.planner").attr("Stroke");
  py::tuple all(layer.route.strokes.size());
  for (std::size_t i = 0; i < all.size(); ++i)
    all[i] = make(view_of<double>(layer.route.strokes[i].points, owner),
                  layer.route.strokes[i].width_mm, to_string(layer.kinds[i]));
  return all;
}

std::string score(const PlannedModel& plan, int jobs, const py::kwargs& printer_values) {
  Printer printer;
  for (const auto& [key, value] : printer_values)
    set_printer_value(printer, std::string(py::str(key)), setting_text(py::str(key), value));
  const Judge judge(plan.of->task, printer);
  return without_lock([&](const std::stop_token&) {
    JudgedCell cell =
        judge_layers(judge, plan.of->model, plan.chosen, plan.layers, parallel_loop(jobs));
    cell.totals[metric_index("peak_rss_bytes")] = plan.peak_rss_bytes;
    return text_of(plan_document({json_of(plan.contender), plan.of->model.sliced, judge, plan.seed,
                                  plan.chosen.size(), &cell}),
                   true);
  });
}

py::tuple ordered(const py::iterable& strokes, const std::pair<double, double>& start) {
  constexpr double kNoWidth = -1;
  std::vector<Stroke> all = strokes_of(strokes, kNoWidth);
  all = nearest_first(std::move(all), {start.first, start.second}, PlanContext{});
  auto held = std::make_unique<std::vector<Stroke>>(std::move(all));
  const std::vector<Stroke>& view = *held;
  const py::capsule owner(held.release(),
                          [](void* p) { delete static_cast<std::vector<Stroke>*>(p); });
  const py::object make = py::module_::import("routebench.planner").attr("Stroke");
  py::tuple result(view.size());
  for (std::size_t i = 0; i < view.size(); ++i) {
    const double width = view[i].width_mm;
    result[i] = make(view_of<double>(view[i].points, owner),
                     width == kNoWidth ? py::object(py::none()) : py::object(py::float_(width)));
  }
  return result;
}

std::string metrics() {
  Json all = Json::array();
  for (const MetricInfo& metric : metric_table())
    all.push_back({{"name", metric.name},
                   {"label", metric.label},
                   {"unit", metric.unit},
                   {"better", metric.better == Better::kLower    ? "lower"
                              : metric.better == Better::kHigher ? "higher"
                                                                 : "neither"},
                   {"meaning", metric.meaning}});
  return text_of(all, true);
}

void add_mesh(py::module_& module) {
  py::class_<Model, std::shared_ptr<Model>>(module, "Mesh", "Triangles over shared vertices.")
      .def_readonly("spec", &Model::spec, "The model as it was named.")
      .def_readonly("warnings", &Model::warnings, "What reading it brought up, one line each.")
      .def_property_readonly(
          "vertices",
          [](const py::object& self) {
            return view_of<double>(self.cast<const Model&>().mesh.vertices, self);
          },
          "Corners, mm: shape (n, 3), read-only, not copied.")
      .def_property_readonly(
          "triangles",
          [](const py::object& self) {
            return view_of<std::uint32_t>(self.cast<const Model&>().mesh.triangles, self);
          },
          "Places of three vertices each, counter-clockwise from outside: shape (m, 3), "
          "read-only,\n"
          "not copied.")
      .def("_report_json", [](const Model& model) { return text_of(json_of(model.report), true); })
      .def("__repr__", [](const Model& model) {
        return "<routebench.Mesh " + model.spec + ", " +
               std::to_string(model.mesh.triangles.size()) + " triangles>";
      });
  module.def(
      "load_mesh",
      [](const std::string& spec, bool repair) {
        return without_lock([&](const std::stop_token&) {
          return std::make_shared<Model>(load_model(spec, {.repair = repair}));
        });
      },
      py::arg("spec"), py::kw_only(), py::arg("repair") = false,
      "Reads or makes a model: a path (STL, OBJ, OFF, PLY, 3MF), \"shape:gear\", \"cgal:...\".");
}

void add_sliced_model(py::module_& module) {
  py::class_<SlicedFor, std::shared_ptr<SlicedFor>>(module, "SlicedModel",
                                                    "A model cut into layers for one task.")
      .def_property_readonly("spec", [](const SlicedFor& self) { return self.model.sliced.spec; })
      .def_property_readonly("warnings",
                             [](const SlicedFor& self) { return self.model.sliced.warnings; })
      .def_property_readonly("layers", &layers_of,
                             "Layers, lowest first, with read-only rings that are not copied.")
      .def_property_readonly(
          "origin",
          [](const SlicedFor& self) {
            const Point2 origin = self.model.sliced.origin;
            return std::pair(origin.x, origin.y);
          },
          "Lower corner of all layers together, mm: where planners anchor their patterns.")
      .def("_task_json", [](const SlicedFor& self) { return text_of(json_of(self.task), true); })
      .def("__len__", [](const SlicedFor& self) { return self.model.sliced.layers.size(); })
      .def("__repr__", [](const SlicedFor& self) {
        return "<routebench.SlicedModel " + self.model.sliced.spec + ", " +
               std::to_string(self.model.sliced.layers.size()) + " layers>";
      });
  module.def("slice_model", &slice, py::arg("spec"), py::kw_only(), py::arg("repair") = false,
             py::arg("method") = "bucket", py::arg("jobs") = 1,
             "Cuts a model into layers and finds what has to be dense. Further arguments are keys\n"
             "of the task, such as layer_height_mm=0.3 or density=1.");
}

void add_plan(py::module_& module) {
  py::class_<PlannedModel, std::shared_ptr<PlannedModel>>(module, "Plan",
                                                          "The routes of a model's layers.")
      .def_property_readonly(
          "indices",
          [](const PlannedModel& self) {
            std::vector<int> indices;
            for (const std::size_t place : self.chosen)
              indices.push_back(self.of->model.sliced.layers[place].index);
            return indices;
          },
          "The layers that were planned, by index.")
      .def("strokes", &strokes_of_plan, py::arg("place"),
           "Strokes of the layer at that place of `indices`, in the order in which they are laid;\n"
           "read-only, not copied.")
      .def_property_readonly(
          "plan_ns",
          [](const PlannedModel& self) {
            std::vector<std::pair<std::int64_t, std::int64_t>> times;
            for (const PlannedLayer& layer : self.layers)
              times.emplace_back(layer.plan_wall_ns, layer.plan_cpu_ns);
            return times;
          },
          "Wall and processor time of each layer's planning, ns.")
      .def("_score_json", &score, py::arg("jobs"))
      .def("__len__", [](const PlannedModel& self) { return self.layers.size(); })
      .def("__repr__", [](const PlannedModel& self) {
        return "<routebench.Plan of " + self.of->model.sliced.spec + " by " +
               self.contender.spec().name + ", " + std::to_string(self.layers.size()) + " layers>";
      });
  module.def("plan", &plan, py::arg("model"), py::arg("shell") = py::none(),
             py::arg("fill") = py::none(), py::kw_only(), py::arg("order") = "island",
             py::arg("seed") = 1, py::arg("layers") = py::none(),
             py::arg("plugins") = std::vector<std::string>{}, py::arg("jobs") = 1,
             "Plans the routes of a model. A slot is a planner's name, or a dict with the key\n"
             "planner (or command) and the planner's parameters. Other threads of Python go on\n"
             "meanwhile; Ctrl-C stops it.");
}

}  // namespace

PYBIND11_MODULE(_routebench, module) {
  module.attr("__version__") = kVersion;
  py::register_exception<Error>(module, "Error", PyExc_ValueError).attr("__doc__") =
      "What cannot be used or done, in one line.";
  module.attr("Error").attr("__module__") = "routebench";
  add_mesh(module);
  add_sliced_model(module);
  add_plan(module);
  module.def(
      "offset",
      [](const py::iterable& polygons, double distance_mm) {
        return tuple_of(offset(polygons_of(polygons), distance_mm));
      },
      py::arg("polygons"), py::arg("distance_mm"),
      "Polygons grown by a distance, or shrunk by a negative one.");
  module.def(
      "nearest_first", &ordered, py::arg("strokes"), py::arg("start"),
      "Strokes in greedy order: from start, and then from each stroke's end, to the nearest\n"
      "end of one that is left, which is turned round if need be.");
  module.def(
      "_planners_json",
      [](const std::vector<std::string>& plugins) {
        return without_lock([&](const std::stop_token&) {
          return text_of(planners_document(planners_of(plugins, {})), true);
        });
      },
      py::arg("plugins"));
  module.def("_metrics_json", &metrics);
}

}  // namespace routebench::python
