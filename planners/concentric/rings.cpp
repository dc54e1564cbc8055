#include "rings.hpp"

#include <algorithm>
#include <utility>

#include "routebench/geometry/region.hpp"
#include "routebench/planning/centre_lines.hpp"

namespace routebench::concentric {
namespace {

// Shorter centre lines, in widths of a line, are not worth a travel.
constexpr double kShortestLine = 1;

void append(std::vector<Stroke> more, std::vector<Stroke>& strokes) {
  std::move(more.begin(), more.end(), std::back_inserter(strokes));
}

/// Without the parts of a loop whose sides are nearer to each other than a spacing.
Polygons wide_part(const Polygons& inset, const PlanContext& context) {
  return without_thin_parts(inset, context.spacing_mm);
}

CentreLineRule rule_for(double max_width_mm, const RingRule& rule, const PlanContext& context) {
  CentreLineRule lines;
  lines.min_width_mm = rule.min_gap_mm;
  lines.max_width_mm = max_width_mm;
  lines.min_length_mm = kShortestLine * context.line_width_mm;
  return lines;
}

/// Lines where the region is too narrow for the first loop; their beads may touch its boundary.
void lay_slivers(const Polygons& polygons, const Polygons& first, const RingRule& rule,
                 const PlanContext& context, Rings& rings) {
  const Polygons bare = subtract(polygons, offset(first, context.line_width_mm / 2, Join::kRound));
  CentreLineRule lines = rule_for(context.line_width_mm + context.spacing_mm, rule, context);
  lines.width = CentreLineWidth::kInscribed;
  append(centre_lines(bare, lines, context), rings.centre_lines);
}

/// Dense: insets half a spacing apart are in turn loops and what their beads leave.
Rings dense_rings(const Polygons& polygons, const RingRule& rule, const PlanContext& context) {
  const double half_mm = context.spacing_mm / 2;
  std::vector<Polygons> all =
      insets(polygons, context.line_width_mm / 2, half_mm, rule.method, context);
  Rings rings;
  for (std::size_t i = 0; i < all.size(); i += 2) {
    const Polygons inside = i + 1 < all.size() ? all[i + 1] : Polygons{};
    // Parts that have nothing half a spacing inside get no loop.
    const Polygons loops = inside.empty() ? Polygons{} : intersect(offset(inside, half_mm), all[i]);
    if (i == 0) {
      lay_slivers(polygons, loops, rule, context, rings);
    } else {
      const Polygons bare = subtract(all[i - 1], offset(inside, context.spacing_mm, Join::kRound));
      append(centre_lines(bare, rule_for(2 * context.spacing_mm, rule, context), context),
             rings.centre_lines);
    }
    if (!loops.empty()) rings.insets.push_back(loops);
  }
  return rings;
}

/// Sparse: loops, and lines where their sides would lie on each other.
Rings sparse_rings(const Polygons& polygons, const RingRule& rule, const PlanContext& context) {
  std::vector<Polygons> all =
      insets(polygons, context.line_width_mm / 2, context.line_distance_mm(), rule.method, context);
  Rings rings;
  if (all.empty()) lay_slivers(polygons, {}, rule, context, rings);
  for (std::size_t i = 0; i < all.size(); ++i) {
    Polygons loops = wide_part(all[i], context);
    if (i == 0) {
      lay_slivers(polygons, loops, rule, context, rings);
    } else {
      const Polygons bare = subtract(offset(all[i], context.line_width_mm / 2),
                                     offset(loops, context.line_width_mm / 2, Join::kRound));
      append(centre_lines(bare, rule_for(context.line_width_mm, rule, context), context),
             rings.centre_lines);
    }
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
