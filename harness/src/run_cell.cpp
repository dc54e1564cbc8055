#include "run_cell.hpp"

#include <sys/resource.h>

#include <algorithm>

#include "byte_stream.hpp"
#include "json_parts.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/geometry/model.hpp"
#include "routebench/geometry/parallel.hpp"
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

std::vector<PlannedLayer> plan(const CellWork& work, ChildProgress& progress) {
  const SlicedModel& sliced = work.model->sliced;
  progress.phase = ChildProgress::kPlanning;
  return plan_layers(std::get<Contender>(*work.worker), *work.model, all_layers(sliced),
                     work.judge->task(), work.seed, {}, told_loop(sliced.layers, progress));
}

TimingSample timing_of(const std::vector<PlannedLayer>& planned) {
  TimingSample sample;
  for (const PlannedLayer& layer : planned)
    sample.layers.push_back({layer.plan_wall_ns, layer.plan_cpu_ns});
  return sample;
}

/// So far; resident pages that were inherited are part of it, for every cell alike.
double peak_rss_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024;
}

std::string place_of(const ChildEnd& end) {
  if (end.phase == ChildProgress::kSlicing) return " while the slicer ran";
  if (end.layer < 0) return " before the first layer";
  return std::string(end.phase == ChildProgress::kJudging ? " while judging" : " while planning") +
         " layer " + std::to_string(end.layer);
}

/// The last line that a process wrote, if any, for a reason.
std::string last_line_of(const std::string& words) {
  const std::size_t end = words.find_last_not_of(" \t\r\n");
  if (end == std::string::npos) return {};
  const std::size_t begin = words.find_last_of("\r\n", end);
  std::string line = words.substr(begin == std::string::npos ? 0 : begin + 1,
                                  begin == std::string::npos ? end + 1 : end - begin);
  constexpr std::size_t kMostBytes = 300;
  if (line.size() > kMostBytes) line.resize(kMostBytes);
  for (char& c : line)
    if (static_cast<unsigned char>(c) < ' ' || static_cast<unsigned char>(c) > '~') c = '?';
  return "; it last wrote: " + line;
}

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
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
  if (!sliced.mesh)
    throw Error(ErrorKind::kBadInput, "a slicer needs a mesh, but the model is a file of layers");
  progress.phase = ChildProgress::kSlicing;
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

}  // namespace

std::string execute_cell(const CellWork& work, ChildProgress& progress) {
  if (const Slicer* slicer = std::get_if<Slicer>(work.worker))
    return execute_slicer(*slicer, work, progress);
  const std::vector<PlannedLayer> planned = plan(work, progress);
  CellResult result;
  result.timing = timing_of(planned);
  const double peak_bytes = peak_rss_bytes();

  progress.phase = ChildProgress::kJudging;
  const SlicedModel& sliced = work.model->sliced;
  JudgedCell judged = judge_layers(*work.judge, *work.model, all_layers(sliced), planned,
                                   told_loop(sliced.layers, progress));
  add_judged(result, std::move(judged), planned, work);
  result.totals.at(metric_index("peak_rss_bytes")) = peak_bytes;
  return encode(result);
}

std::string time_cell(const CellWork& work, ChildProgress& progress) {
  const std::vector<PlannedLayer> planned = plan(work, progress);
  CellResult result;
  result.outcome = Outcome::kValid;
  result.timing = timing_of(planned);
  result.route_hash = hash_of_route(planned);
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
      // A slicer's failure says itself what failed.
      return without_result(
          Outcome::kFailed,
          one_line(end.text) + (end.phase == ChildProgress::kSlicing ? "" : place_of(end)));
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
