/// Fill by cells that a plough can take without lifting: boustrophedon cellular decomposition, the
/// cells in an order and direction that local search has made short.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "routebench/geometry/region.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/planning/frame.hpp"
#include "routebench/planning/hatch.hpp"
#include "routebench/planning/plugin.hpp"
#include "routebench/planning/tour.hpp"
#include "routebench/planning/walls.hpp"

namespace {

using namespace routebench;

enum class Direction { kAlternate, kFewest };

constexpr double kReach = 0.6;   // of a spacing: the boundary nearer to a line counts as laid
constexpr int kDirections = 12;  // tried by direction = fewest
constexpr double kLeastLineMm = 0.02;

/// A hatch and the boundary between neighbouring ends.
struct Field {
  explicit Field(const Polygon& region, const HatchRule& rule)
      : hatch(region, rule),
        stretches(boundary_stretches(hatch)),
        leaving(hatch.ends().size(), kNoEnd) {
    for (std::size_t i = 0; i < stretches.size(); ++i) {
      lengths_mm.push_back(length_mm(stretches[i].path));
      if (stretches[i].from_end != kNoEnd) leaving[stretches[i].from_end] = i;
    }
  }

  /// The stretch between two ends, in either direction, if it is at most max_mm long.
  [[nodiscard]] const Stretch* between(std::size_t a, std::size_t b, double max_mm) const {
    for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, a}})
      if (stretches[leaving[from]].to_end == to && lengths_mm[leaving[from]] <= max_mm)
        return &stretches[leaving[from]];
    return nullptr;
  }

  Hatch hatch;
  std::vector<Stretch> stretches;
  std::vector<double> lengths_mm;    // of stretches
  std::vector<std::size_t> leaving;  // of an end: the stretch that begins there
  std::vector<Joint> joints{};       // stretches that are laid
};

/// What is laid in one go.
struct Line {
  std::vector<Point2> points;
  std::vector<Joint> joints{};  // that it uses
  std::size_t first_end = kNoEnd;
  std::size_t last_end = kNoEnd;
};

Line reversed(Line line) {
  std::reverse(line.points.begin(), line.points.end());
  std::swap(line.first_end, line.last_end);
  return line;
}

/// A cell of a field and the ways of ploughing it, each followed by its reverse.
struct Cell {
  std::size_t field;
  std::vector<Line> ways{};
};

void append(const std::vector<Point2>& more, bool forward, std::vector<Point2>& points) {
  const auto go_to = [&](Point2 p) {
    if (points.empty() || p != points.back()) points.push_back(p);
  };
  if (forward)
    std::for_each(more.begin(), more.end(), go_to);
  else
    std::for_each(more.rbegin(), more.rend(), go_to);
}

/// To and fro over neighbouring pieces, from the first (side 0) or last end of the first of them.
Line plough(const Field& field, const std::vector<std::size_t>& pieces, std::size_t side,
            double max_mm) {
  Line way;
  way.first_end = 2 * pieces.front() + side;
  std::size_t end = way.first_end;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (i > 0) {
      const std::size_t next = 2 * pieces[i] + end % 2;
      const Stretch& stretch = *field.between(end, next, max_mm);
      append(stretch.path, stretch.from_end == end, way.points);
      way.joints.push_back({stretch.from_end, stretch.to_end, {}});
      end = next;
    }
    append({field.hatch.ends()[end].point, field.hatch.ends()[end ^ 1U].point}, true, way.points);
    end ^= 1U;
  }
  way.last_end = end;
  return way;
}

/// Cells are as high as a piece has just one neighbour above, which has just one below: then the
/// boundary leads from each end of the one to an end of the other.
void add_cells(const Field& field, std::size_t number, double max_mm, std::vector<Cell>& cells) {
  const Hatch& hatch = field.hatch;
  std::vector<bool> taken(hatch.pieces(), false);
  for (std::size_t first = 0; first < hatch.pieces(); ++first) {
    if (taken[first]) continue;
    std::vector<std::size_t> pieces{first};
    const auto next = [&](std::size_t piece) -> std::optional<std::size_t> {
      const std::uint32_t line = hatch.line_of_end(2 * piece) + 1;
      if (line == hatch.lines()) return std::nullopt;
      for (std::size_t above = hatch.first_piece(line); above < hatch.first_piece(line + 1);
           ++above)
        if (!taken[above] && field.between(2 * piece, 2 * above, max_mm) != nullptr &&
            field.between(2 * piece + 1, 2 * above + 1, max_mm) != nullptr)
          return above;
      return std::nullopt;
    };
    while (const auto above = next(pieces.back())) {
      taken[*above] = true;
      pieces.push_back(*above);
    }
    Cell cell{number};
    for (const std::size_t side : {0U, 1U}) {
      Line way = plough(field, pieces, side, max_mm);
      cell.ways.push_back(way);
      cell.ways.push_back(reversed(std::move(way)));
    }
    cells.push_back(std::move(cell));
  }
}

/// Lays cells one after the other, along the boundary from one to the next where that is short, and
/// notes in the fields which stretches that takes.
std::vector<std::vector<Point2>> ploughed(const std::vector<Cell>& cells,
                                          std::vector<Field>& fields, double max_mm, Point2 start,
                                          const PlanContext& context) {
  std::vector<TourItem> items;
  for (const Cell& cell : cells) {
    items.emplace_back();
    for (const Line& way : cell.ways)
      items.back().ways.push_back({way.points.front(), way.points.back()});
  }
  std::vector<std::vector<Point2>> lines;
  std::size_t field = kNoEnd, last_end = kNoEnd;
  for (const Visit& visit : short_tour(items, start, context)) {
    const Cell& cell = cells[visit.item];
    const Line& way = cell.ways[visit.way];
    Field& here = fields[cell.field];
    const Stretch* step =
        cell.field == field ? here.between(last_end, way.first_end, max_mm) : nullptr;
    if (step == nullptr) lines.emplace_back();
    if (step != nullptr) {
      append(step->path, step->from_end == last_end, lines.back());
      here.joints.push_back({step->from_end, step->to_end, {}});
    }
    append(way.points, true, lines.back());
    here.joints.insert(here.joints.end(), way.joints.begin(), way.joints.end());
    field = cell.field;
    last_end = way.last_end;
  }
  return lines;
}

struct BoustrophedonParams {
  Direction direction = Direction::kAlternate;
  double angle_deg = 45;
  double max_link = 3;

  void bind(ParamBinder& bind) {
    bind("direction", direction,
         {{"alternate", Direction::kAlternate}, {"fewest", Direction::kFewest}},
         "of the lines: by angle_deg, and across that on odd layers; or for each region the one of "
         "twelve that needs the fewest lines");
    bind("angle_deg", angle_deg, {-180, 180}, "deg", "direction of the lines, 0 along x");
    bind("max_link", max_link, {0, 100}, "line distances", "longest way along the wall");
  }
};

class Boustrophedon final : public Planner {
 public:
  using Params = BoustrophedonParams;

  static PlannerInfo info() {
    return {"boustrophedon", PlannerRole::kFill,
            "lines to and fro in cells that are put in a short order",
            "H. Choset and P. Pignon, 1997"};
  }

  explicit Boustrophedon(const Params& params) : params_(params) {}

  [[nodiscard]] Route plan(const Layer& layer, const PlanContext& context) const override {
    const Frame frame(layer, context);
    const bool dense = context.density >= 1;
    const double max_mm = params_.max_link * context.line_distance_mm();
    const Polygons regions = offset(frame.polygons(), -context.line_width_mm / 2);
    std::vector<Field> fields;
    std::vector<Cell> cells;
    for (const Polygon& region : regions) {
      stop_if_asked(context);
      fields.emplace_back(region, rule_for(region, layer, context));
      add_cells(fields.back(), fields.size() - 1, max_mm, cells);
    }
    std::vector<Stroke> strokes;
    const auto lay = [&](std::vector<std::vector<Point2>> lines) {
      for (std::vector<Point2>& line : lines)
        strokes.push_back({std::move(line), context.line_width_mm});
    };
    lay(ploughed(cells, fields, max_mm, frame.start(), context));
    if (!dense) return frame.from_frame({std::move(strokes)});
    // What no line comes near, and what is too narrow for one.
    for (const Field& field : fields)
      lay(bare_boundary(field.hatch, field.stretches, field.joints, kReach * context.spacing_mm,
                        context.line_width_mm, context));
    for (Stroke& stroke : gap_lines(frame.polygons(), {regions}, 1, context.line_width_mm, context))
      strokes.push_back(std::move(stroke));
    return frame.from_frame({in_short_order(std::move(strokes), frame.start(), context)});
  }

 private:
  [[nodiscard]] HatchRule rule_for(const Polygon& region, const Layer& layer,
                                   const PlanContext& context) const {
    const auto rule_at = [&](double angle_deg) {
      HatchRule rule;
      rule.angle_deg = angle_deg;
      rule.lines = context.density >= 1 ? fitted_lines_over(region, angle_deg, context)
                                        : lines_over(region, angle_deg, context.line_distance_mm());
      rule.min_length_mm = kLeastLineMm;
      return rule;
    };
    if (params_.direction == Direction::kAlternate)
      return rule_at(params_.angle_deg + (layer.index % 2 != 0 ? 90 : 0));
    HatchRule best = rule_at(params_.angle_deg);
    for (int i = 1; i < kDirections; ++i) {
      HatchRule rule = rule_at(params_.angle_deg + i * 180.0 / kDirections);
      if (rule.lines.count < best.lines.count) best = rule;
    }
    return best;
  }

  BoustrophedonParams params_;
};

}  // namespace

ROUTEBENCH_REGISTER(boustrophedon) { registry.add<Boustrophedon>(); }
