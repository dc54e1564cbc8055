/// Fill by parallel lines.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "routebench/geometry/region.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/planning/frame.hpp"
#include "routebench/planning/hatch.hpp"
#include "routebench/planning/ordering.hpp"
#include "routebench/planning/plugin.hpp"
#include "routebench/planning/walls.hpp"

namespace {

using namespace routebench;

enum class Link { kNone, kFlows, kBoundary };
enum class Ends { kInset, kAlong };
enum class Sequence { kNearest, kZigzag };
enum class Thin { kFill, kDrop };
enum class Published { kNone, kDeKeyser, kSimpleSlicer };

constexpr double kLeastStripMm2 = 0.05;  // less is noise of offsets
constexpr double kSideMm = 0.015;        // more than offsets are cleaned of
// Nearer to a line than this share of the spacing the boundary counts as laid: half the spacing is
// how far a line has to reach anyway.
constexpr double kReach = 0.6;
// In regions that are narrower than so many lines, the rim is much of the whole: there traces come
// nearer to lines and may be half as short. In wider ones that costs travels and covers nothing to
// speak of.
constexpr double kNarrowLines = 4;
constexpr double kReachInNarrow = 0.45;
// Below density 1 joints come on top of the lines, and in narrow regions are longer than those. By
// this share of what a region and the walls about it need, more may be laid.
constexpr double kMostOver = 0.15;

struct RectilinearParams {
  Published published = Published::kNone;
  double angle_deg = 45;
  bool alternate = true;
  bool grid = false;
  bool fit = true;
  CrossingSearch search = CrossingSearch::kBucket;
  Ends ends = Ends::kInset;
  double end_gap = 0.5;
  Link link = Link::kBoundary;
  double max_link = 3;
  double min_length_mm = 0.02;
  bool trace = true;
  Thin thin = Thin::kFill;
  Sequence order = Sequence::kNearest;

  void bind(ParamBinder& bind) {
    bind("published", published,
         {{"none", Published::kNone},
          {"dekeyser", Published::kDeKeyser},
          {"simple_slicer", Published::kSimpleSlicer}},
         "a paper's rules; they stand for all other parameters but search");
    bind("angle_deg", angle_deg, {-180, 180}, "deg", "direction of the lines, 0 along x");
    bind("alternate", alternate, "turn the direction by 90 degrees on odd layers");
    bind("grid", grid, "below density 1: both directions in each layer, at half the density each");
    bind("fit", fit, "at density 1: spread the lines evenly over each region");
    bind("search", search,
         {{"bucket", CrossingSearch::kBucket},
          {"sweep", CrossingSearch::kSweep},
          {"naive", CrossingSearch::kNaive}},
         "how crossings are found: linear, by a sweep, every line with every edge; same route");
    bind("ends", ends, {{"inset", Ends::kInset}, {"along", Ends::kAlong}},
         "inset cuts lines at the region shrunk by half a line; along cuts them at the region's "
         "outline and pulls them in along the line, as published: beads may cross slanted walls");
    bind("end_gap", end_gap, {0, 10}, "line widths", "how far ends = along pulls in");
    bind(
        "link", link,
        {{"none", Link::kNone}, {"flows", Link::kFlows}, {"boundary", Link::kBoundary}},
        "flows joins neighbouring lines straight while their number stays the same; boundary joins "
        "them along the wall (with ends = along it does as flows)");
    bind("max_link", max_link, {0, 100}, "line distances", "longest joint along the wall");
    bind("min_length_mm", min_length_mm, {0, 100}, "mm", "shorter lines are left out");
    bind("trace", trace, "at density 1: lay the stretches along the wall that no line comes near");
    bind(
        "thin", thin, {{"fill", Thin::kFill}, {"drop", Thin::kDrop}},
        "at density 1, parts too narrow for two lines: one of their own width along the middle; or "
        "lines as elsewhere, and nothing where none fits");
    bind("order", order, {{"nearest", Sequence::kNearest}, {"zigzag", Sequence::kZigzag}},
         "of the strokes: always the nearest, or line by line, every other one reversed");
  }
};

/// How the lines of one layer are laid: the parameters, or what a paper says.
struct Rules {
  RectilinearParams params;
  double end_gap_mm = 0;
  double min_length_mm = 0;
  bool joints_may_leave = false;
};

Rules rules_of(const RectilinearParams& given, const Layer& layer, const PlanContext& context) {
  if (given.published == Published::kNone)
    return {given, given.end_gap * context.line_width_mm, given.min_length_mm, false};
  RectilinearParams params;
  params.search = given.search;
  params.angle_deg = 0;
  params.fit = false;
  params.trace = false;
  params.thin = Thin::kDrop;
  params.ends = Ends::kAlong;
  params.order = Sequence::kZigzag;
  if (given.published == Published::kDeKeyser) {
    params.grid = true;
    params.link = Link::kNone;
    return {params, 3 * layer.height_mm, 7 * layer.height_mm, false};
  }
  // Flows are closed only where the number of crossings changes: a joint may run over a hollow.
  params.link = Link::kFlows;
  return {params, context.line_width_mm, 0, true};
}

/// Turns every other stroke round, as one who lays line after line to and fro.
std::vector<Stroke> to_and_fro(std::vector<Stroke> strokes) {
  for (std::size_t i = 1; i < strokes.size(); i += 2)
    std::reverse(strokes[i].points.begin(), strokes[i].points.end());
  return strokes;
}

class Rectilinear final : public Planner {
 public:
  using Params = RectilinearParams;

  static PlannerInfo info() {
    return {"rectilinear",
            PlannerRole::kFill,
            "parallel lines, joined along the wall or straight",
            "K. De Keyser, 2016",
            {{"published", "simple_slicer"}},
            2};
  }

  explicit Rectilinear(const Params& params) : params_(params) {}

  [[nodiscard]] Route plan(const Layer& layer, const PlanContext& context) const override {
    const Frame frame(layer, context);
    const Rules rules = rules_of(params_, layer, context);
    const RectilinearParams& params = rules.params;
    const bool fills_thin =
        params.thin == Thin::kFill && params.ends == Ends::kInset && context.density >= 1;
    Polygons regions = params.ends == Ends::kInset
                           ? offset(frame.polygons(), -context.line_width_mm / 2)
                           : frame.polygons();
    if (fills_thin) regions = without_strips(std::move(regions), context);
    const double angle_deg = params.angle_deg + (params.alternate && layer.index % 2 != 0 ? 90 : 0);
    const bool both = params.grid && context.density < 1;
    std::vector<Stroke> strokes;
    for (const Polygon& region : regions) {
      fill(region, rules, angle_deg, both ? 2 : 1, context, strokes);
      if (both) fill(region, rules, angle_deg + 90, 2, context, strokes);
    }
    if (fills_thin)
      for (Stroke& stroke : gap_lines(frame.polygons(), {regions}, 1,
                                      context.line_width_mm + context.spacing_mm, context))
        strokes.push_back(std::move(stroke));
    return frame.from_frame({params.order == Sequence::kZigzag
                                 ? to_and_fro(std::move(strokes))
                                 : nearest_first(std::move(strokes), frame.start(), context)});
  }

 private:
  /// The regions without what is too narrow for two lines side by side: one line of its own width
  /// serves it better than a row of dots.
  static Polygons without_strips(Polygons regions, const PlanContext& context) {
    const double half_mm = context.spacing_mm / 2;
    const Polygons cores = offset(regions, -half_mm);
    if (area_mm2(regions) - grown_area_mm2(cores, half_mm) < kLeastStripMm2) return regions;
    // Grown a little farther, for sides that coincide would cross at every corner.
    return intersect(offset(cores, half_mm + kSideMm), regions);
  }

  static std::vector<std::vector<Point2>> traces(const Hatch& hatch,
                                                 std::span<const Stretch> stretches,
                                                 const std::vector<Joint>& joints,
                                                 const Polygon& region,
                                                 const PlanContext& context) {
    const double mean_width_mm = 2 * area_mm2(region) / perimeter_mm(region);
    const bool is_narrow = mean_width_mm < kNarrowLines * context.line_width_mm;
    return bare_boundary(hatch, stretches, joints,
                         (is_narrow ? kReachInNarrow : kReach) * context.spacing_mm,
                         (is_narrow ? 0.5 : 1) * context.line_width_mm, context);
  }

  /// Lays one direction in one region, its lines `sparser` times farther apart than demanded.
  static void fill(const Polygon& region, const Rules& rules, double angle_deg, int sparser,
                   const PlanContext& context, std::vector<Stroke>& strokes) {
    stop_if_asked(context);
    const RectilinearParams& params = rules.params;
    const double distance_mm = context.line_distance_mm() * sparser;
    HatchRule rule;
    rule.angle_deg = angle_deg;
    rule.lines = params.fit && params.ends == Ends::kInset && context.density >= 1
                     ? fitted_lines_over(region, angle_deg, context)
                     : lines_over(region, angle_deg, distance_mm);
    rule.search = params.search;
    rule.min_length_mm = rules.min_length_mm;
    if (params.ends == Ends::kAlong) rule.end_gap_mm = rules.end_gap_mm;
    const Hatch hatch(region, rule);
    const bool is_inset = params.ends == Ends::kInset;
    const bool traces_wall = params.trace && is_inset && context.density >= 1;
    const std::vector<Stretch> stretches =
        traces_wall || (is_inset && params.link == Link::kBoundary) ? boundary_stretches(hatch)
                                                                    : std::vector<Stretch>{};
    const std::vector<Joint> joints =
        joints_of(hatch, stretches, region, rules, distance_mm, context);
    const auto lay = [&](std::vector<std::vector<Point2>> polylines) {
      for (std::vector<Point2>& points : polylines)
        strokes.push_back({std::move(points), context.line_width_mm});
    };
    lay(joined_lines(hatch, joints));
    if (traces_wall) lay(traces(hatch, stretches, joints, region, context));
  }

  static std::vector<Joint> joints_of(const Hatch& hatch, std::span<const Stretch> stretches,
                                      const Polygon& region, const Rules& rules, double distance_mm,
                                      const PlanContext& context) {
    const RectilinearParams& params = rules.params;
    if (params.link == Link::kNone) return {};
    if (params.link == Link::kFlows || params.ends == Ends::kAlong)
      return join_flows(hatch, rules.joints_may_leave ? nullptr : &region);
    std::vector<Joint> joints =
        join_along_boundary(hatch, stretches, params.max_link * distance_mm);
    return context.density < 1 ? affordable(std::move(joints), hatch, region, distance_mm, context)
                               : joints;
  }

  /// Of joints as many, spread evenly, as make no more of lines and joints than is allowed.
  static std::vector<Joint> affordable(std::vector<Joint> joints, const Hatch& hatch,
                                       const Polygon& region, double distance_mm,
                                       const PlanContext& context) {
    // What is to be filled is half a line wider on all sides.
    const double rim_mm = perimeter_mm(region);
    const double needed_mm = (area_mm2(region) + context.line_width_mm / 2 * rim_mm) / distance_mm;
    const double over_mm = kMostOver * (needed_mm + context.perimeters * rim_mm);
    double lines_mm = 0, joints_mm = 0;
    for (std::size_t piece = 0; piece < hatch.pieces(); ++piece)
      lines_mm += distance(hatch.ends()[2 * piece].point, hatch.ends()[2 * piece + 1].point);
    for (const Joint& joint : joints) joints_mm += length_mm(joint.path);
    const double allowed_mm = needed_mm + over_mm - lines_mm;
    if (joints_mm <= allowed_mm) return joints;
    double seen_mm = 0, kept_mm = 0;
    std::erase_if(joints, [&](const Joint& joint) {
      const double mm = length_mm(joint.path);
      seen_mm += mm;
      const bool kept = kept_mm + mm <= allowed_mm / joints_mm * seen_mm;
      if (kept) kept_mm += mm;
      return !kept;
    });
    return joints;
  }

  RectilinearParams params_;
};

}  // namespace

ROUTEBENCH_REGISTER(rectilinear) { registry.add<Rectilinear>(); }
