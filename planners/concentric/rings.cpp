#include "rings.hpp"

#include <algorithm>
#include <utility>

#include "routebench/geometry/region.hpp"
#include "routebench/planning/centre_lines.hpp"

namespace routebench::concentric {
namespace {

// What beads leave is sought with beads so much wider: outlines that all but coincide are slow to
// subtract, and what lies between them is noise.
constexpr double kMarginMm = 0.03;
// Shorter lines in gaps, in widths of a line, are not worth a travel; in slivers, where there is
// nothing else, they are.
constexpr double kShortestInGap = 2;
constexpr double kShortestInSliver = 0.5;
// Compact places so wide get a dot.
constexpr double kSmallestDot = 0.5;

void append(std::vector<Stroke> more, std::vector<Stroke>& strokes) {
  std::move(more.begin(), more.end(), std::back_inserter(strokes));
}

CentreLineRule rule_for(double max_width_mm, const RingRule& rule, const PlanContext& context) {
  CentreLineRule lines;
  lines.min_width_mm = rule.min_gap_mm;
  lines.max_width_mm = max_width_mm;
  lines.min_length_mm = kShortestInGap * context.line_width_mm;
  lines.min_dot_mm = kSmallestDot * context.line_width_mm;
  return lines;
}

/// What is left of an area without all that lies within reach_mm of `laid`, but for noise. Corners
/// up to the mitre limit count as reached.
Polygons bare_part(const Polygons& area, const Polygons& laid, double reach_mm) {
  const Polygons cores = subtract(area, offset(laid, reach_mm + kMarginMm));
  if (laid.empty() || cores.empty()) return cores;
  return intersect(offset(cores, kMarginMm), area);
}

/// Lines where the region is too narrow for the first loop; their beads may touch its boundary.
void lay_slivers(const Polygons& bare, const RingRule& rule, const PlanContext& context,
                 Rings& rings) {
  CentreLineRule lines = rule_for(context.line_width_mm + context.spacing_mm, rule, context);
  lines.width = CentreLineWidth::kInscribed;
  lines.min_length_mm = kShortestInSliver * context.line_width_mm;
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

/// Sparse: loops, and lines where their sides would lie on each other.
Rings sparse_rings(const Polygons& polygons, const RingRule& rule, const PlanContext& context) {
  std::vector<Polygons> all =
      insets(polygons, context.line_width_mm / 2, context.line_distance_mm(), rule.method, context);
  Rings rings;
  if (all.empty()) lay_slivers(polygons, rule, context, rings);
  const double half_mm = context.line_width_mm / 2;
  for (std::size_t i = 0; i < all.size(); ++i) {
    stop_if_asked(context);
    // Parts of a loop that have nothing half a spacing inside are laid as one line.
    const Polygons inside = offset(all[i], -context.spacing_mm / 2);
    const Polygons lost = bare_part(all[i], inside, context.spacing_mm / 2);
    Polygons loops =
        lost.empty() ? all[i] : intersect(offset(inside, context.spacing_mm / 2), all[i]);
    if (i == 0)
      lay_slivers(bare_part(polygons, loops, half_mm), rule, context, rings);
    else
      append(centre_lines(offset(lost, half_mm), rule_for(context.line_width_mm, rule, context),
                          context),
             rings.centre_lines);
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
