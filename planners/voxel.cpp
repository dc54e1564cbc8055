/// Fill by the cells of a grid.

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "routebench/geometry/edge_grid.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/planning/cell_circuits.hpp"
#include "routebench/planning/cell_grid.hpp"
#include "routebench/planning/cell_strokes.hpp"
#include "routebench/planning/frame.hpp"
#include "routebench/planning/ordering.hpp"
#include "routebench/planning/plugin.hpp"

namespace {

using namespace routebench;

enum class Variant { kDefault, kPublished };
enum class Inside { kRows, kEuler };
enum class Rim { kInside, kPublished };

struct VoxelParams {
  Variant variant = Variant::kDefault;
  Inside inside = Inside::kRows;
  Rim rim = Rim::kInside;
  bool alternate = true;
  bool fit = true;
  double max_link = 3;

  void bind(ParamBinder& bind) {
    bind("variant", variant, {{"default", Variant::kDefault}, {"published", Variant::kPublished}},
         "published is rim = published and inside = rows, whatever those say: beads leave the "
         "region");
    bind("inside", inside, {{"rows", Inside::kRows}, {"euler", Inside::kEuler}},
         "rows lays the inner cells row by row, to and fro; euler goes once round a spanning tree "
         "of blocks of two by two cells");
    bind("rim", rim, {{"inside", Rim::kInside}, {"published", Rim::kPublished}},
         "where the outline's cells are laid: moved onto the region shrunk by half a line, or at "
         "their centres, as published: beads leave the region");
    bind("alternate", alternate, "turn rows by 90 degrees on odd layers");
    bind("fit", fit, "at density 1 with rim = inside: stretch the cells so that they fit a region");
    bind("max_link", max_link, {0, 100}, "row distances",
         "longest joint between neighbouring rows");
  }
};

class Voxel final : public Planner {
 public:
  using Params = VoxelParams;

  static PlannerInfo info() {
    return {"voxel",
            PlannerRole::kFill,
            "cells of a grid: the outline's as walls, the inner in rows",
            "K. De Keyser, 2016",
            {{"rim", "published"}, {"variant", "published"}},
            2};
  }

  explicit Voxel(const Params& params) : params_(params) {
    if (params_.variant != Variant::kPublished) return;
    params_.rim = Rim::kPublished;
    params_.inside = Inside::kRows;
  }

  [[nodiscard]] Route plan(const Layer& layer, const PlanContext& context) const override {
    const Frame frame(layer, context);
    const bool turned = params_.alternate && layer.index % 2 != 0;
    std::vector<Stroke> strokes;
    Polygons regions = frame.polygons();
    if (moves_inside()) regions = offset(regions, -context.line_width_mm / 2);
    for (Polygon& region : regions) {
      stop_if_asked(context);
      if (turned) transpose(region);
      for (std::vector<Point2>& points : fill(region, context)) {
        if (turned) transpose(points);
        strokes.push_back({std::move(points), context.line_width_mm});
      }
    }
    return frame.from_frame({nearest_first(std::move(strokes), frame.start(), context)});
  }

 private:
  [[nodiscard]] bool moves_inside() const { return params_.rim == Rim::kInside; }

  static void transpose(std::vector<Point2>& points) {
    for (Point2& p : points) std::swap(p.x, p.y);
  }
  static void transpose(Polygon& polygon) {
    transpose(polygon.outer);
    for (Ring& hole : polygon.holes) transpose(hole);
  }

  /// Polylines that fill one region, whose boundary is that of the centre lines.
  [[nodiscard]] std::vector<std::vector<Point2>> fill(const Polygon& region,
                                                      const PlanContext& context) const {
    const bool dense = context.density >= 1;
    const bool rows = params_.inside == Inside::kRows;
    RowRule rule;
    // So many rows of cells make a line distance: none is wider than a spacing.
    if (rows) rule.every = static_cast<std::uint32_t>(std::ceil(1 / context.density));
    rule.max_link_mm = params_.max_link * context.line_distance_mm();
    rule.ends = !moves_inside() ? RowEnds::kCentres
                : dense         ? RowEnds::kBesideRim
                                : RowEnds::kBoundary;
    rule.rim_distance_mm = context.spacing_mm;

    const Box2 box = bounding_box(region);
    const CellMap map =
        map_cells(dense && moves_inside() && params_.fit
                      ? fitted_cells(box, context)
                      : anchored_cells(box, context.line_distance_mm() / rule.every),
                  region);
    std::vector<std::vector<Point2>> polylines;
    if (dense)
      polylines = rim_lines(map, moves_inside() ? RimPlace::kOutline : RimPlace::kCentres,
                            context.spacing_mm, context);

    // Where no rim is laid and the rows are led to the boundary, its cells are theirs.
    std::vector<bool> free(map.grid.size());
    for (std::uint32_t cell = 0; cell < free.size(); ++cell)
      free[cell] = rule.ends == RowEnds::kBoundary ? (map.flags[cell] & kInsideCell) != 0
                                                   : map.is_inner(cell);
    const EdgeGrid edges({region});
    if (!rows) append(polylines, circuits(map, free, edges));
    append(polylines, row_lines(map, free, edges, rule, context));
    return polylines;
  }

  static std::vector<std::vector<Point2>> circuits(const CellMap& map, std::vector<bool>& free,
                                                   const EdgeGrid& edges) {
    std::vector<std::vector<Point2>> polylines;
    const auto clear = [&](std::uint32_t from, std::uint32_t to) {
      return edges.covers(map.grid.centre(from), map.grid.centre(to));
    };
    for (const std::vector<std::uint32_t>& cells : cell_circuits(map, free, clear))
      polylines.push_back(closed_line(map.grid, cells));
    return polylines;
  }

  static void append(std::vector<std::vector<Point2>>& all, std::vector<std::vector<Point2>> more) {
    for (std::vector<Point2>& points : more) all.push_back(std::move(points));
  }

  VoxelParams params_;
};

}  // namespace

ROUTEBENCH_REGISTER(voxel) { registry.add<Voxel>(); }
