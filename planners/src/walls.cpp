#include "routebench/planning/walls.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "narrow_places.hpp"
#include "near_sides.hpp"
#include "routebench/geometry/edge_grid.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/planning/centre_lines.hpp"

namespace routebench {
namespace {

/// A line is laid in a strip if it gives at least so much of the material that is needed. In
/// shorter strips it lacks its ends, and it costs a travel.
constexpr double kEnough = 0.85;
/// A wall may be farther from the one before than it should by so much of the least width of a line
/// between them: no line fits there, as at the bottom of a stub that is hardly deeper.
constexpr double kStubShare = 0.6;
/// What sides that would coincide are kept apart by: more than offsets are cleaned of.
constexpr double kSideMm = 0.015;
/// The sides of a strip are so much of its length apart along the boundary, where that is at its
/// middle; there they are nearer to each other than it is wide anywhere. Of one with a single end
/// they are twice as far apart where it begins.
constexpr double kStripShare = 0.75;
/// Scraps that are less of a wall's length do no harm that is worth a look.
constexpr double kScrapShare = 0.2;
/// What is narrow is looked at so many spacings round about.
constexpr double kMarginSpacings = 3;

}  // namespace

std::vector<Polygons> wall_regions(const Polygon& island, const PlanContext& context) {
  std::vector<Polygons> regions;
  double step_mm = context.line_width_mm / 2;
  for (int wall = 0; wall < context.perimeters; ++wall) {
    stop_if_asked(context);
    // One wall at a time: an offset by many widths at once is far slower, and in narrow places
    // another region.
    Polygons inner =
        regions.empty() ? offset({island}, -step_mm) : offset(regions.back(), -step_mm);
    if (inner.empty()) break;
    regions.push_back(std::move(inner));
    step_mm = context.spacing_mm;
  }
  return regions;
}

double grown_area_mm2(const Polygons& polygons, double distance_mm) {
  constexpr double kSharpest = 1.75;  // of half a corner's turn, as a tangent: offsets cut it off
  double area = 0, length = 0, corners = 0;
  for (const Ring& ring : rings_of(polygons)) {
    area += signed_area_mm2(ring);
    length += perimeter_mm(ring);
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 in = ring[i] - ring[i == 0 ? ring.size() - 1 : i - 1];
      const Point2 out = ring[i + 1 == ring.size() ? 0 : i + 1] - ring[i];
      // tan(t / 2) = sin t / (1 + cos t) of the turn t
      const double scale = std::sqrt(dot(in, in) * dot(out, out));
      const double tangent = cross(in, out) / (scale + dot(in, out));
      corners += std::isfinite(tangent) ? std::clamp(tangent, -kSharpest, kSharpest) : 0;
    }
  }
  return area + distance_mm * (length + distance_mm * corners);
}

namespace {

/// The least stroke: half as long as a line is wide, and a third as wide.
double least_stroke_mm2(const PlanContext& context) {
  return context.line_width_mm * context.line_width_mm / 6;
}

/// Mean width of a polygon that is a strip: of its sides' length, its ends are none.
double strip_width_mm(const Polygon& strip) {
  const double area = area_mm2(strip), half_mm = perimeter_mm(strip) / 2;
  if (!strip.holes.empty()) return area / half_mm;
  // length x width = area, length + width = half the perimeter
  return 2 * area / (half_mm + std::sqrt(std::max(half_mm * half_mm - 4 * area, 0.0)));
}

Box2 grown(const Box2& box, double mm) {
  const Point2 by = snap(Point2{mm, mm});
  return {box.lower - by, box.upper + by};
}

template <typename T>
void append(std::vector<T> more, std::vector<T>& to) {
  std::move(more.begin(), more.end(), std::back_inserter(to));
}

/// The sides of what lies between a wall's centre line and what comes before it.
TakenSides sides_between(const Polygons& before, double before_mm, const Polygons& region,
                         double wall_mm) {
  TakenSides sides;
  sides.rings = rings_of(before);
  sides.taken_mm.resize(sides.rings.size(), before_mm);
  for (Ring& ring : rings_of(region)) {
    std::reverse(ring.begin(), ring.end());
    sides.rings.push_back(std::move(ring));
  }
  sides.taken_mm.resize(sides.rings.size(), wall_mm);
  return sides;
}

/// What beads of neighbouring lines overlap with their round sides.
double overlap_mm(const PlanContext& context) { return context.line_width_mm - context.spacing_mm; }

/// The narrowest gap that a line is laid in: that fills it or, between walls, overlaps with them as
/// much as they do with each other.
double narrowest_gap_mm(bool is_first, const PlanContext& context) {
  const double line_mm = narrowest_line_mm(context);
  return is_first ? line_mm : std::max(line_mm - overlap_mm(context), line_mm / 4);
}

}  // namespace

std::vector<std::vector<TakenSides>> wall_gaps(const Polygons& polygons,
                                               const std::vector<Polygons>& regions, int count,
                                               const PlanContext& context) {
  const double margin_mm = kMarginSpacings * context.spacing_mm, half_mm = context.spacing_mm / 2;
  const Polygons none;
  std::vector<std::vector<TakenSides>> gaps;
  for (std::size_t wall = 0; wall <= regions.size() && std::cmp_less(wall, count); ++wall) {
    stop_if_asked(context);
    const bool is_first = wall == 0;
    const Polygons& before = is_first ? polygons : regions[wall - 1];
    const Polygons& region = wall < regions.size() ? regions[wall] : none;
    const double before_mm = is_first ? 0 : half_mm;
    const double wall_mm = is_first ? context.line_width_mm / 2 : half_mm;
    const double stub_mm = kStubShare * narrowest_gap_mm(is_first, context);
    gaps.emplace_back();
    // Where nothing is narrow, the wall's place grows back to where it came from.
    for (const Box2& box :
         doubtful_places(region, before, before_mm + wall_mm, stub_mm, margin_mm)) {
      // All that reaches into it: between walls nothing is open between the one before and the box.
      const Polygons laid = clipped(region, is_first ? grown(box, margin_mm) : box);
      gaps.back().push_back(sides_between(clipped(before, box), before_mm, laid, wall_mm));
    }
  }
  return gaps;
}

std::vector<Stroke> gap_lines(const Polygons& polygons, const std::vector<Polygons>& regions,
                              int count, double widest_mm, const PlanContext& context) {
  const CentreLineRule outside{.min_width_mm = narrowest_gap_mm(true, context),
                               .max_width_mm = widest_mm,
                               .min_length_mm = context.line_width_mm / 2,
                               .width = CentreLineWidth::kInscribed};
  CentreLineRule between = outside;
  between.min_width_mm = narrowest_gap_mm(false, context);
  between.max_width_mm -= overlap_mm(context);
  std::vector<std::vector<TakenSides>> gaps = wall_gaps(polygons, regions, count, context);
  std::vector<Stroke> strokes;
  for (std::size_t wall = 0; wall < gaps.size(); ++wall) {
    const bool is_first = wall == 0;
    for (TakenSides& sides : gaps[wall])
      for (Stroke& stroke : centre_lines(std::move(sides), is_first ? outside : between, context)) {
        if (!is_first) stroke.width_mm += overlap_mm(context);
        strokes.push_back(std::move(stroke));
      }
  }
  return strokes;
}

double narrowest_line_mm(const PlanContext& context) {
  return context.line_width_mm / 3;  // less is left to what beads spread
}

namespace {

/// How many ends of a strip are its own: not those at which it goes on to what is laid, from which
/// it was cut off at so much.
int free_ends(const Polygon& part, const EdgeGrid& laid, double cut_mm) {
  constexpr double kCutMm = 0.01;  // more than offsets are cleaned of
  const auto is_cut = [&](Point2 p) {
    return laid.distance_to_edge_mm(p, cut_mm + kCutMm).has_value();
  };
  int free = 2;
  bool was_cut = is_cut(part.outer.back());
  for (const Point2 p : part.outer) {
    const bool cut = is_cut(p);
    if (cut && !was_cut && free > 0) --free;
    was_cut = cut;
  }
  return free;
}

/// Whether one line serves a narrow part of a wall's region better than a wall there and back.
bool is_strip(const Polygon& part, int ends, double reach_mm, const PlanContext& context) {
  const double area = area_mm2(part), width_mm = strip_width_mm(part);
  if (area < least_stroke_mm2(context) * 1e-3) return false;  // what rounding leaves
  const double length_mm = area / width_mm;
  const double needed =
      area + 2 * length_mm * reach_mm + ends * std::numbers::pi / 2 * reach_mm * reach_mm;
  const double twice = perimeter_mm(part) * context.spacing_mm;
  const double once =
      (width_mm + context.spacing_mm) * std::max(length_mm - ends * width_mm / 2, 0.0);
  return once >= kEnough * needed && std::abs(once - needed) < std::abs(twice - needed);
}

/// No strip with two ends is shorter, and none with one is half as long: is_strip's bound on what
/// one line gives, solved for the length and at its least over widths up to `near_mm`.
double shortest_strip_mm(double reach_mm, double near_mm, const PlanContext& context) {
  const double spacing_mm = context.spacing_mm;
  const double ends_mm2 = kEnough * std::numbers::pi * reach_mm * reach_mm;
  // (ends + width (spacing + width)) / (beside + share width)
  const double beside_mm = spacing_mm - 2 * kEnough * reach_mm, share = 1 - kEnough;
  const double root = beside_mm * beside_mm - share * (spacing_mm * beside_mm - share * ends_mm2);
  const double width_mm =
      std::clamp((std::sqrt(std::max(root, 0.0)) - beside_mm) / share, 0.0, near_mm);
  const double gain_mm = beside_mm + share * width_mm;
  return gain_mm > 0 ? (ends_mm2 + width_mm * (spacing_mm + width_mm)) / gain_mm
                     : std::numeric_limits<double>::infinity();
}

/// Whether one line as wide as a narrow place gives enough of what the place needs: if it is long.
bool line_suffices(const Polygon& place, double reach_mm, const PlanContext& context) {
  const double area = area_mm2(place), width_mm = strip_width_mm(place);
  const double length_mm = area / width_mm - (place.holes.empty() ? width_mm : 0);
  return (width_mm - 2 * reach_mm + context.spacing_mm) * length_mm >= kEnough * area;
}

/// What of an area is farther than `reach_mm` from what is laid; all of it, as it is, if nothing
/// is. Most sides of the area are as far as that, and would cross those of what is laid, grown, at
/// every corner.
Polygons left_open(const Polygons& area, const Polygons& laid, double reach_mm) {
  return subtract(area, offset(laid, reach_mm + kSideMm));
}

}  // namespace

double left_inside_mm(const Polygon& region, const PlanContext& context) {
  constexpr double kLeastMm = 0.01;
  const double line_mm = narrowest_line_mm(context) - overlap_mm(context);
  const double left_mm = strip_width_mm(region) - context.spacing_mm;
  if (left_mm < kLeastMm || left_mm >= line_mm) return 0;
  // No wider anywhere.
  return offset({region}, -(context.spacing_mm + line_mm) / 2).empty() ? left_mm : 0;
}

Polygons without_strips(Polygons region, double reach_mm, double near_mm,
                        const PlanContext& context) {
  const double width_mm = near_mm + 2 * kSideMm;
  const double length_mm = kStripShare * shortest_strip_mm(reach_mm, near_mm, context);
  const double slack_mm = context.spacing_mm, margin_mm = kMarginSpacings * context.spacing_mm;
  const auto first_narrow = std::stable_partition(
      region.begin(), region.end(),
      [&](const Polygon& part) { return !has_near_sides(part, width_mm, length_mm); });
  if (first_narrow == region.end()) return region;
  const Polygons narrow(first_narrow, region.end());
  Polygons strips;
  const Polygons cores = offset(narrow, -near_mm / 2);
  for (const Box2& box : doubtful_places(cores, narrow, near_mm / 2, slack_mm, margin_mm)) {
    const Polygons laid = clipped(cores, grown(box, margin_mm));
    Polygons open = clipped(narrow, box);
    // Clipped rings may hold several parts.
    open = laid.empty() ? polygons_from_rings(rings_of(open), FillRule::kPositive)
                        : left_open(open, laid, near_mm / 2);
    std::optional<EdgeGrid> edges;
    const auto serves = [&](const Polygon& part) {
      if (!part.holes.empty()) return is_strip(part, 0, reach_mm, context);
      if (is_strip(part, 2, reach_mm, context)) return true;
      if (laid.empty() || !is_strip(part, 0, reach_mm, context)) return false;
      if (!edges) edges.emplace(laid);
      const int ends = free_ends(part, *edges, near_mm / 2 + kSideMm);
      return ends < 2 && is_strip(part, ends, reach_mm, context);
    };
    for (Polygon& part : open)
      if (serves(part)) strips.push_back(std::move(part));
  }
  if (strips.empty()) return region;
  region.erase(first_narrow, region.end());
  append(subtract(narrow, offset(strips, kSideMm)), region);
  return region;
}

Polygons without_scraps(Polygons region, const Polygons& before, double reach_mm, double near_mm,
                        const PlanContext& context) {
  if (region.size() < 2) return region;
  const double least_mm = kScrapShare * perimeter_mm(region);
  std::vector<std::size_t> narrow;
  double narrow_mm = 0;
  for (std::size_t i = 0; i < region.size(); ++i) {
    if (strip_width_mm(region[i]) >= near_mm) continue;
    narrow.push_back(i);
    narrow_mm += perimeter_mm(region[i]);
  }
  // What is wide somewhere is no scrap. To look at that is dear, so not where it cannot matter.
  std::vector<bool> is_scrap(region.size());
  for (auto i = narrow.begin(); i != narrow.end() && narrow_mm > least_mm; ++i) {
    is_scrap[*i] = offset({region[*i]}, -near_mm / 2).empty();
    if (!is_scrap[*i]) narrow_mm -= perimeter_mm(region[*i]);
  }
  if (narrow_mm <= least_mm) return region;
  Polygons laid, scraps;
  for (std::size_t i = 0; i < region.size(); ++i)
    (is_scrap[i] ? scraps : laid).push_back(region[i]);
  Polygons places = laid.empty() ? before : left_open(before, laid, near_mm / 2 + reach_mm);
  std::erase_if(places,
                [&](const Polygon& place) { return !line_suffices(place, reach_mm, context); });
  if (places.empty()) return region;
  const EdgeGrid in_places(places);
  std::erase_if(scraps, [&](const Polygon& scrap) {
    return std::ranges::any_of(scrap.outer, [&](Point2 p) { return in_places.contains(p); });
  });
  append(std::move(scraps), laid);
  return laid;
}

std::vector<Ring> rings_of(const Polygons& polygons) {
  std::vector<Ring> rings;
  for (const Polygon& polygon : polygons) {
    rings.push_back(polygon.outer);
    rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
  }
  return rings;
}

}  // namespace routebench
