#include "run_cell.hpp"

#include <functional>

#include "byte_stream.hpp"
#include "json_parts.hpp"
#include "plan_timing.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/geometry/model.hpp"
#include "routebench/geometry/parallel.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/slice.hpp"
#include "routebench/harness/gcode_score.hpp"
#include "routebench/harness/metrics.hpp"
#include "routebench/planning/sha256.hpp"

namespace routebench {
namespace {

void add(ByteWriter& out, const std::vector<Point2>& points) {
  out.add(std::uint64_t{points.size()});
  for (const Point2 p : points) out.add(p.x).add(p.y);
}

void add(ByteWriter& out, const Polygons& polygons) {
  out.add(std::uint64_t{polygons.size()});
  for (const Polygon& polygon : polygons) {
    add(out, polygon.outer);
    out.add(std::uint64_t{polygon.holes.size()});
    for (const Ring& hole : polygon.holes) add(out, hole);
  }
}

std::string hash_of_route(const std::vector<PlannedLayer>& planned) {
  ByteWriter layers;
  for (const PlannedLayer& layer : planned) {
    ByteWriter out;
    for (std::size_t i = 0; i < layer.route.strokes.size(); ++i) {
      const Stroke& stroke = layer.route.strokes[i];
      out.add(static_cast<std::uint64_t>(layer.kinds.at(i))).add(stroke.width_mm);
      add(out, stroke.points);
    }
    layers.add(std::string_view(sha256(out.bytes())));
  }
  return sha256(layers.bytes());
}

void add(ByteWriter& out, const Scores& scores) {
  out.add(std::uint64_t{scores.size()});
  for (const std::optional<double>& score : scores)
    out.add(std::uint64_t{score.has_value()}).add(score.value_or(0));
}

Scores read_scores(ByteReader& in) {
  Scores scores(in.count(2 * sizeof(double)));
  for (std::optional<double>& score : scores) {
    const bool known = in.whole() != 0;
    const double value = in.real();
    if (known) score = value;
  }
  return scores;
}

std::string encode(const CellResult& result) {
  ByteWriter out;
  out.add(static_cast<std::uint64_t>(result.outcome)).add(std::string_view(result.reason));
  out.add(std::string_view(result.route_hash.value_or("")));
  add(out, result.totals);
  out.add(std::uint64_t{result.layers.size()});
  for (const LayerScore& layer : result.layers) {
    out.add(std::int64_t{layer.layer_index}).add(layer.z_mm).add(std::uint64_t{layer.repaired});
    add(out, layer.scores);
  }
  out.add(std::uint64_t{result.routes.size()});
  for (const RouteRecord& route : result.routes)
    out.add(std::uint64_t{route.layer_index}).add(std::string_view(route.strokes_json));
  out.add(std::uint64_t{result.timing.layers.size()});
  for (const PlanTime& time : result.timing.layers) out.add(time.wall_ns).add(time.cpu_ns);
  out.add(result.timing.minor_faults).add(result.timing.major_faults);
  out.add(result.timing.peak_rss_bytes);
  return out.bytes();
}

CellResult decode(const std::string& bytes) {
  ByteReader in(bytes);
  CellResult result;
  const std::uint64_t outcome = in.whole();
  if (outcome > static_cast<std::uint64_t>(outcomes().back()))
    throw Error(ErrorKind::kInternal, "a record has no outcome");
  result.outcome = static_cast<Outcome>(outcome);
  result.reason = in.text();
  if (std::string hash = in.text(); !hash.empty()) result.route_hash = std::move(hash);
  result.totals = read_scores(in);
  result.layers.resize(in.count(4 * sizeof(double)));
  for (LayerScore& layer : result.layers) {
    layer.layer_index = static_cast<int>(in.integer());
    layer.z_mm = in.real();
    layer.repaired = in.whole() != 0;
    layer.scores = read_scores(in);
  }
  result.routes.resize(in.count(2 * sizeof(double)));
  for (RouteRecord& route : result.routes) {
    route.layer_index = in.whole();
    route.strokes_json = in.text();
  }
  result.timing.layers.resize(in.count(2 * sizeof(double)));
  for (PlanTime& time : result.timing.layers) {
    time.wall_ns = in.integer();
    time.cpu_ns = in.integer();
    result.timing.cell.wall_ns += time.wall_ns;
    result.timing.cell.cpu_ns += time.cpu_ns;
  }
  result.timing.minor_faults = in.integer();
  result.timing.major_faults = in.integer();
  result.timing.peak_rss_bytes = in.integer();
  in.finish();
  return result;
}

/// The plain loop, telling where it is.
ParallelFor told_loop(const std::vector<Layer>& layers, ChildProgress& progress) {
  return [&layers, &progress](std::size_t count, const std::function<void(std::size_t)>& body) {
    for (std::size_t i = 0; i < count; ++i) {
      progress.layer = layers[i].index;
      body(i);
    }
  };
}

struct Planned {
  std::vector<PlannedLayer> layers;
  TimingSample timing;
};

/// Does work and adds the page faults that it met.
void count_faults(const std::function<void()>& work, TimingSample& sample) {
  rusage before{}, after{};
  getrusage(RUSAGE_SELF, &before);
  work();
  getrusage(RUSAGE_SELF, &after);
  sample.minor_faults += after.ru_minflt - before.ru_minflt;
  sample.major_faults += after.ru_majflt - before.ru_majflt;
}

Planned plan(const CellWork& work, ChildProgress& progress) {
  const SlicedModel& sliced = work.model->sliced;
  progress.phase = ChildProgress::kPlanning;
  const auto& contender = std::get<Contender>(*work.worker);
  Planned planned;
  count_faults(
      [&] {
        planned.layers = plan_layers(contender, *work.model, all_layers(sliced), work.judge->task(),
                                     work.seed, {}, told_loop(sliced.layers, progress));
      },
      planned.timing);
  for (const PlannedLayer& layer : planned.layers)
    planned.timing.layers.push_back({layer.plan_wall_ns, layer.plan_cpu_ns});
  // Resident pages that were inherited are part of it, for every cell alike.
  planned.timing.peak_rss_bytes = static_cast<std::int64_t>(contender.peak_rss_bytes());
  return planned;
}

std::string place_of(const ChildEnd& end) {
  if (end.phase == ChildProgress::kSlicing) return " while the slicer ran";
  if (end.phase == ChildProgress::kCutting) return " while cutting layers";
  if (end.layer < 0) return " before the first layer";
  return std::string(end.phase == ChildProgress::kJudging ? " while judging" : " while planning") +
         " layer " + std::to_string(end.layer);
}

/// What an exception said, and where, unless it has said that itself: a slicer's says what failed,
/// a contender's names planner and layer.
std::string told_with_place(const ChildEnd& end) {
  const std::string text = one_line(end.text);
  const bool placed = end.phase == ChildProgress::kSlicing ||
                      text.find(", layer " + std::to_string(end.layer) + ": ") != text.npos;
  return placed ? text : text + place_of(end);
}

CellResult without_result(Outcome outcome, const std::string& reason) {
  CellResult result;
  result.outcome = outcome;
  result.reason = reason;
  return result;
}

/// Puts verdict, scores and the routes of the layers that are kept into a result.
void add_judged(CellResult& result, JudgedCell judged, const std::vector<PlannedLayer>& planned,
                const CellWork& work) {
  result.outcome = judged.verdict.outcome;
  result.reason = std::move(judged.verdict.reason);
  result.route_hash = hash_of_route(planned);
  result.totals = std::move(judged.totals);
  result.layers = std::move(judged.layers);
  for (const std::size_t i : work.kept_layers)
    result.routes.push_back({static_cast<std::size_t>(work.model->sliced.layers[i].index),
                             text_of(json_of(planned[i]), true)});
}

std::string execute_slicer(const Slicer& slicer, const CellWork& work, ChildProgress& progress) {
  if (!slicer.missing().empty())
    return encode(without_result(Outcome::kNotInstalled, slicer.missing()));
  const SlicedModel& sliced = work.model->sliced;
  progress.phase = ChildProgress::kSlicing;
  if (!sliced.mesh)
    throw Error(ErrorKind::kBadInput, "a slicer needs a mesh, but the model is a file of layers");
  const SlicerRun run =
      slicer.run(load_model(sliced.spec, {.repair = work.repair}).mesh, work.judge->task(),
                 work.judge->printer(), work.scratch, work.memory_mb);
  progress.phase = ChildProgress::kJudging;
  const std::vector<std::size_t> chosen = all_layers(sliced);
  const ParallelFor loop = told_loop(sliced.layers, progress);
  const PlacedPrint placed = place_print(run.print, *work.model, chosen, run.offset_mm,
                                         work.judge->task().line_width_mm, loop);
  CellResult result;
  add_judged(result, judge_print(*work.judge, *work.model, chosen, placed, loop), placed.layers,
             work);
  result.totals.at(metric_index("peak_rss_bytes")) = run.peak_rss_bytes;
  result.totals.at(metric_index("job_wall_s")) = run.wall_s;
  result.totals.at(metric_index("job_cpu_s")) = run.cpu_s;
  return encode(result);
}

struct Cut {
  std::vector<Layer> layers;
  TimingSample timing;
};

/// Cuts the model anew, on one thread.
Cut cut(SliceMethod method, const CellWork& work, ChildProgress& progress) {
  progress.phase = ChildProgress::kCutting;
  const SlicedModel& sliced = work.model->sliced;
  const Task& task = work.judge->task();
  if (!sliced.mesh)
    throw Error(ErrorKind::kBadInput, "nothing to cut: the model is a file of layers");
  const Model model = load_model(sliced.spec, {.repair = work.repair});
  const SliceOptions options = slicing_for(task, {.method = method, .repair = work.repair});
  Cut made;
  PlanTime time;
  const auto slice = [&] { made.layers = slice_mesh(model.mesh, options, sliced.spec).layers; };
  count_faults([&] { add_time_of(slice, time); }, made.timing);
  made.timing.layers = {time};
  made.timing.cell = time;
  made.timing.peak_rss_bytes = static_cast<std::int64_t>(peak_rss_bytes());
  return made;
}

/// Layers are judged by the share of the model's that they cover and by what lies outside these.
CellResult judge_cut(const CellWork& work, Cut made) {
  const std::vector<Layer>& wanted = work.model->sliced.layers;
  double wanted_mm2 = 0, covered_mm2 = 0, outside_mm2 = 0;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const Polygons own = i < made.layers.size() ? made.layers[i].polygons : Polygons();
    const double area = area_mm2(wanted[i].polygons);
    const bool same = own == wanted[i].polygons;
    wanted_mm2 += area;
    covered_mm2 += same ? area : area_mm2(intersect(own, wanted[i].polygons));
    outside_mm2 += same ? 0 : area_mm2(subtract(own, wanted[i].polygons));
  }
  CellResult result;
  result.route_hash = hash_of_layers(made.layers);
  result.totals.resize(metric_table().size());
  result.totals.at(metric_index("covered")) = covered_mm2 / wanted_mm2;
  result.totals.at(metric_index("spilled")) = outside_mm2 / wanted_mm2;
  Verdict verdict = work.judge->verdict(result.totals);
  result.outcome = verdict.outcome;
  result.reason = std::move(verdict.reason);
  result.totals.at(metric_index("peak_rss_bytes")) =
      static_cast<double>(made.timing.peak_rss_bytes);
  result.timing = std::move(made.timing);
  return result;
}

}  // namespace

std::string execute_cell(const CellWork& work, ChildProgress& progress) {
  if (const Slicer* slicer = std::get_if<Slicer>(work.worker))
    return execute_slicer(*slicer, work, progress);
  if (const SliceMethod* method = std::get_if<SliceMethod>(work.worker))
    return encode(judge_cut(work, cut(*method, work, progress)));
  Planned plan_of_cell = plan(work, progress);
  const std::vector<PlannedLayer>& planned = plan_of_cell.layers;
  CellResult result;
  result.timing = std::move(plan_of_cell.timing);

  progress.phase = ChildProgress::kJudging;
  const SlicedModel& sliced = work.model->sliced;
  JudgedCell judged = judge_layers(*work.judge, *work.model, all_layers(sliced), planned,
                                   told_loop(sliced.layers, progress));
  add_judged(result, std::move(judged), planned, work);
  result.totals.at(metric_index("peak_rss_bytes")) =
      static_cast<double>(result.timing.peak_rss_bytes);
  return encode(result);
}

std::string time_cell(const CellWork& work, ChildProgress& progress) {
  CellResult result;
  result.outcome = Outcome::kValid;
  if (const SliceMethod* method = std::get_if<SliceMethod>(work.worker)) {
    Cut made = cut(*method, work, progress);
    result.timing = std::move(made.timing);
    result.route_hash = hash_of_layers(made.layers);
    return encode(result);
  }
  Planned planned = plan(work, progress);
  result.timing = std::move(planned.timing);
  result.route_hash = hash_of_route(planned.layers);
  return encode(result);
}

CellResult cell_result_of(const ChildEnd& end, const ChildLimits& limits) {
  switch (end.how) {
    case ChildEnd::How::kResult:
      try {
        return decode(end.text);
      } catch (const Error&) {
        return without_result(Outcome::kCrashed, "what its process told cannot be read");
      }
    case ChildEnd::How::kException:
      return without_result(Outcome::kFailed, told_with_place(end));
    case ChildEnd::How::kPlannerDied:
      return without_result(Outcome::kCrashed, told_with_place(end));
    case ChildEnd::How::kExited:
      return without_result(Outcome::kCrashed, "ended its process with exit code " +
                                                   std::to_string(end.code) + place_of(end) +
                                                   last_line_of(end.last_words));
    case ChildEnd::How::kSignal:
      return without_result(Outcome::kCrashed,
                            signal_name(end.code) + place_of(end) + last_line_of(end.last_words));
    case ChildEnd::How::kTimedOut:
      return without_result(
          Outcome::kTimedOut,
          "no result after " + to_string(ParamValue(limits.timeout_s)) + " s" + place_of(end));
    case ChildEnd::How::kOutOfMemory:
      return without_result(Outcome::kOutOfMemory, "more than " + std::to_string(limits.memory_mb) +
                                                       " MB wanted" + place_of(end));
  }
  throw Error(ErrorKind::kInternal, "a child process ended in no known way");
}

std::string hash_of_layers(const std::vector<Layer>& layers) {
  ByteWriter hashes;
  for (const Layer& layer : layers) {
    ByteWriter out;
    out.add(std::int64_t{layer.index}).add(layer.z_mm).add(layer.height_mm);
    out.add(std::uint64_t{layer.repaired});
    add(out, layer.polygons);
    add(out, layer.solid);
    hashes.add(std::string_view(sha256(out.bytes())));
  }
  return sha256(hashes.bytes());
}

}  // namespace routebench
