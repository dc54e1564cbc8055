#include "rings.hpp"

#include <algorithm>
#include <utility>

#include "routebench/geometry/region.hpp"
#include "routebench/planning/centre_lines.hpp"
#include "routebench/planning/walls.hpp"

namespace routebench::concentric {
namespace {

// What beads leave is sought with beads so much wider: outlines that all but coincide are slow to
// subtract, and what lies between them is noise.
constexpr double kMarginMm = 0.03;
// A square of a quarter of a millimetre: beads spread over it.
constexpr double kLeastBareMm2 = 0.06;
// Shorter lines in gaps, in widths of a line, are not worth a travel; in slivers, where there is
// nothing else, they are.
constexpr double kShortestInGap = 2;
constexpr double kShortestInSliver = 0.5;
// Compact places so wide get a dot.
constexpr double kDotInGap = 0.8;
constexpr double kDotInSliver = 0.5;

void append(std::vector<Stroke> more, std::vector<Stroke>& strokes) {
  std::move(more.begin(), more.end(), std::back_inserter(strokes));
}

CentreLineRule rule_for(double max_width_mm, const RingRule& rule, const PlanContext& context) {
  CentreLineRule lines;
  lines.min_width_mm = rule.min_gap_mm;
  lines.max_width_mm = max_width_mm;
  lines.min_length_mm = kShortestInGap * context.line_width_mm;
  lines.min_dot_mm = kDotInGap * context.line_width_mm;
  return lines;
}

/// What is left of an area without all that lies within reach_mm of `laid`, but for noise. Corners
/// up to the mitre limit count as reached.
Polygons bare_part(const Polygons& area, const Polygons& laid, double reach_mm) {
  // Most of the time there is nothing, which is soon told.
  if (!laid.empty() && area_mm2(area) - grown_area_mm2(laid, reach_mm) < kLeastBareMm2) return {};
  const Polygons cores = subtract(area, offset(laid, reach_mm + kMarginMm));
  if (laid.empty() || cores.empty()) return cores;
  return intersect(offset(cores, kMarginMm), area);
}

/// The narrowest place between walls that gets a line: below density 1 where that is nearer to what
/// is demanded than none. Without walls none would leave the place empty.
double narrowest_between_walls_mm(const RingRule& rule, const PlanContext& context) {
  return context.density < 1 && context.perimeters > 0
             ? std::max(rule.min_gap_mm, context.line_distance_mm() / 2)
             : rule.min_gap_mm;
}

/// Lines where the region is too narrow for the first loop; their beads may touch its boundary.
void lay_slivers(const Polygons& bare, const RingRule& rule, const PlanContext& context,
                 Rings& rings) {
  CentreLineRule lines = rule_for(context.line_width_mm + context.spacing_mm, rule, context);
  lines.width = CentreLineWidth::kInscribed;
  lines.min_width_mm = narrowest_between_walls_mm(rule, context);
  lines.min_length_mm = kShortestInSliver * context.line_width_mm;
  lines.min_dot_mm = kDotInSliver * context.line_width_mm;
  append(centre_lines(bare, lines, context), rings.centre_lines);
}

/// Dense: insets half a spacing apart are in turn loops and what their beads leave.
Rings dense_rings(const Polygons& polygons, const RingRule& rule, const PlanContext& context) {
  const double half_mm = context.spacing_mm / 2;
  const std::vector<Polygons> all =
      insets(polygons, context.line_width_mm / 2, half_mm, rule.method, context);
  Rings rings;
  if (all.empty()) lay_slivers(polygons, rule, context, rings);
  for (std::size_t i = 0; !all.empty() && i <= all.size(); i += 2) {
    stop_if_asked(context);
    // Parts of a loop that have nothing half a spacing inside are laid as one line.
    const Polygons inside = i + 1 < all.size() ? all[i + 1] : Polygons{};
    const double around_mm = half_mm + (i == 0 ? context.line_width_mm / 2 : half_mm);
    const Polygons bare = bare_part(i == 0 ? polygons : all[i - 1], inside, around_mm);
    if (i == 0)
      lay_slivers(bare, rule, context, rings);
    else
      append(centre_lines(bare, rule_for(2 * context.spacing_mm, rule, context), context),
             rings.centre_lines);
    if (inside.empty()) break;
    const bool lost = !offset(bare, -half_mm + 2 * kMarginMm).empty();
    rings.insets.push_back(lost ? intersect(offset(inside, half_mm), all[i]) : all[i]);
  }
  return rings;
}

/// Joins strokes of one width that follow each other.
std::vector<Stroke> joined(std::vector<Stroke> strokes) {
  std::vector<Stroke> all;
  for (Stroke& stroke : strokes) {
    if (!all.empty() && all.back().width_mm == stroke.width_mm &&
        all.back().points.back() == stroke.points.front())
      all.back().points.insert(all.back().points.end(), stroke.points.begin() + 1,
                               stroke.points.end());
    else
      all.push_back(std::move(stroke));
  }
  return all;
}

/// Lines in the middle of parts up to widest_mm wide, no wider than a line.
void lay_middles(const Polygons& parts, double widest_mm, bool between_walls, bool dots,
                 const RingRule& rule, const PlanContext& context, Rings& rings) {
  CentreLineRule lines = rule_for(widest_mm, rule, context);
  if (between_walls) lines.min_width_mm = narrowest_between_walls_mm(rule, context);
  lines.width = CentreLineWidth::kInscribed;
  lines.min_length_mm = context.line_distance_mm();
  // Elsewhere they are but the corners of loops.
  if (!dots) lines.min_dot_mm = widest_mm + context.line_distance_mm();
  std::vector<Stroke> strokes = centre_lines(parts, lines, context);
  for (Stroke& stroke : strokes) stroke.width_mm = std::min(stroke.width_mm, context.line_width_mm);
  append(joined(std::move(strokes)), rings.centre_lines);
}

/// Lines in the middle between the sides of a loop that are too near for the next one and yet more
/// than one and a half line distances apart: such a gap would be half empty.
void lay_between(const Polygons& loops, const Polygons& next, const RingRule& rule,
                 const PlanContext& context, Rings& rings) {
  const double apart_mm = context.line_distance_mm();
  if (area_mm2(loops) - grown_area_mm2(next, apart_mm) < apart_mm * apart_mm / 2) return;
  const Polygons bare = bare_part(offset(loops, -apart_mm / 2), next, apart_mm / 2);
  CentreLineRule lines = rule_for(apart_mm, rule, context);
  lines.min_width_mm = apart_mm / 2;
  lines.min_length_mm = apart_mm;
  std::vector<Stroke> strokes = centre_lines(bare, lines, context);
  for (Stroke& stroke : strokes) stroke.width_mm = context.line_width_mm;
  append(joined(std::move(strokes)), rings.centre_lines);
}

/// Sparse: loops where the place between two walls or loops is at least so many line distances
/// wide, else one line. That is as much as is demanded or a third off.
constexpr double kLoopFromDistances = 1.5;

Rings sparse_rings(const Polygons& polygons, const RingRule& rule, const PlanContext& context) {
  const double apart_mm = context.line_distance_mm(), width_mm = context.line_width_mm;
  const std::vector<Polygons> all = insets(polygons, width_mm / 2, apart_mm, rule.method, context);
  Rings rings;
  if (all.empty()) lay_slivers(polygons, rule, context, rings);
  for (std::size_t i = 0; i < all.size(); ++i) {
    stop_if_asked(context);
    // The sides of a loop are nearer to each other than the place between its neighbours is wide.
    const double room_mm = i == 0 ? width_mm : apart_mm;
    const double reach_mm =
        std::max(context.spacing_mm, kLoopFromDistances * apart_mm - room_mm) / 2;
    const Polygons inside = offset(all[i], -reach_mm);
    const Polygons lost = bare_part(all[i], inside, reach_mm);
    Polygons loops = lost.empty() ? all[i] : intersect(offset(inside, reach_mm), all[i]);
    if (i == 0) lay_slivers(bare_part(polygons, all[i], width_mm / 2), rule, context, rings);
    lay_middles(offset(lost, width_mm / 2), 2 * reach_mm + width_mm, i == 0,
                i == 0 && loops.empty(), rule, context, rings);
    // The sides of the first loop have no other beside them: they alone are nearer to what is
    // needed.
    if (i > 0)
      lay_between(all[i], i + 1 < all.size() ? all[i + 1] : Polygons{}, rule, context, rings);
    if (!loops.empty()) rings.insets.push_back(std::move(loops));
  }
  return rings;
}

}  // namespace

Rings rings_in(const Polygons& polygons, const RingRule& rule, const PlanContext& context) {
  if (!rule.thin)
    return {insets(polygons, context.line_width_mm / 2, context.line_distance_mm(), rule.method,
                   context),
            {}};
  return context.density >= 1 ? dense_rings(polygons, rule, context)
                              : sparse_rings(polygons, rule, context);
}

}  // namespace routebench::concentric
