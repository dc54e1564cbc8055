/// Fill by parallel lines.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "routebench/geometry/region.hpp"
#include "routebench/planning/frame.hpp"
#include "routebench/planning/hatch.hpp"
#include "routebench/planning/ordering.hpp"
#include "routebench/planning/plugin.hpp"

namespace {

using namespace routebench;

enum class Link { kNone, kFlows, kBoundary };
enum class Ends { kInset, kAlong };

// Offsets wave by up to this where their outline is level (see region.hpp).
constexpr double kWaveMm = 0.01;
// Nearer to a line than this share of the spacing the boundary counts as laid: half the spacing is
// how far a line has to reach anyway.
constexpr double kReach = 0.6;

struct RectilinearParams {
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

  void bind(ParamBinder& bind) {
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
  }
};

class Rectilinear final : public Planner {
 public:
  using Params = RectilinearParams;

  static PlannerInfo info() {
    return {"rectilinear", PlannerRole::kFill, "parallel lines, joined along the wall or straight",
            "K. De Keyser, 2016"};
  }

  explicit Rectilinear(const Params& params) : params_(params) {}

  [[nodiscard]] Route plan(const Layer& layer, const PlanContext& context) const override {
    const Frame frame(layer, context);
    const bool inset = params_.ends == Ends::kInset;
    const Polygons regions =
        inset ? offset(frame.polygons(), -context.line_width_mm / 2) : frame.polygons();
    const double angle_deg =
        params_.angle_deg + (params_.alternate && layer.index % 2 != 0 ? 90 : 0);
    const bool both = params_.grid && context.density < 1;
    std::vector<Stroke> strokes;
    for (const Polygon& region : regions) {
      fill(region, angle_deg, both ? 2 : 1, context, strokes);
      if (both) fill(region, angle_deg + 90, 2, context, strokes);
    }
    return frame.from_frame({nearest_first(std::move(strokes), frame.start(), context)});
  }

 private:
  /// Lays one direction in one region, its lines `sparser` times farther apart than demanded.
  void fill(const Polygon& region, double angle_deg, int sparser, const PlanContext& context,
            std::vector<Stroke>& strokes) const {
    stop_if_asked(context);
    const double distance_mm = context.line_distance_mm() * sparser;
    HatchRule rule;
    rule.angle_deg = angle_deg;
    rule.lines = lines_over(region, angle_deg, distance_mm, context);
    rule.search = params_.search;
    rule.min_length_mm = params_.min_length_mm;
    if (params_.ends == Ends::kAlong) rule.end_gap_mm = params_.end_gap * context.line_width_mm;
    const Hatch hatch(region, rule);
    const std::vector<Joint> joints = joints_of(hatch, region, distance_mm);
    const auto lay = [&](std::vector<std::vector<Point2>> polylines) {
      for (std::vector<Point2>& points : polylines)
        strokes.push_back({std::move(points), context.line_width_mm});
    };
    lay(joined_lines(hatch, joints));
    if (params_.trace && params_.ends == Ends::kInset && context.density >= 1)
      lay(bare_boundary(hatch, joints, kReach * context.spacing_mm, context.line_width_mm,
                        context));
  }

  [[nodiscard]] std::vector<Joint> joints_of(const Hatch& hatch, const Polygon& region,
                                             double distance_mm) const {
    if (params_.link == Link::kNone) return {};
    if (params_.link == Link::kFlows || params_.ends == Ends::kAlong)
      return join_flows(hatch, region);
    return join_along_boundary(hatch, params_.max_link * distance_mm);
  }

  [[nodiscard]] EvenLines lines_over(const Polygon& region, double angle_deg, double distance_mm,
                                     const PlanContext& context) const {
    const Turn turn(angle_deg);
    double low = turn.to_level(region.outer.front()).y, high = low;
    for (const Point2 p : region.outer) {
      low = std::min(low, turn.to_level(p).y);
      high = std::max(high, turn.to_level(p).y);
    }
    if (params_.fit && params_.ends == Ends::kInset && context.density >= 1)
      return fitted_lines(low, high, context);
    // Multiples of the distance, so that lines of one layer lie over those of another.
    const double first = std::ceil(low / distance_mm);
    const double last = std::floor(high / distance_mm);
    return {first * distance_mm, distance_mm, static_cast<std::uint32_t>(last - first + 1)};
  }

  /// The first and the last line on the region's edge, the others evenly between them: nearly a
  /// spacing apart, and never more than a line's width.
  static EvenLines fitted_lines(double low, double high, const PlanContext& context) {
    const double inner_mm = high - low - 2 * kWaveMm;
    if (inner_mm < context.spacing_mm / 2) return {(low + high) / 2, context.spacing_mm, 1};
    const double gaps = std::max(std::round(inner_mm / context.spacing_mm),
                                 std::ceil(inner_mm / context.line_width_mm));
    return {low + kWaveMm, inner_mm / gaps, static_cast<std::uint32_t>(gaps) + 1};
  }

  RectilinearParams params_;
};

}  // namespace

ROUTEBENCH_REGISTER(rectilinear) { registry.add<Rectilinear>(); }
