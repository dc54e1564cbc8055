#include "judge/strays.hpp"

#include "routebench/geometry/vec.hpp"

namespace routebench::judging {
namespace {

/// Beads that are thinner than this share of a line lay nothing to speak of: they are travels that
/// call themselves strokes. Planners and slicers lay no gap thinner than a fifth of a line.
constexpr double kThinnest = 0.1;

}  // namespace

Strays strays_of(const std::vector<Run>& runs, const EdgeGrid& outline, double line_width_mm) {
  Strays strays;
  for (const Run& run : runs) {
    bool is_inside = false;  // known of the place where the bead before ended
    for (std::size_t i = 0; i < run.widths_mm.size(); ++i) {
      const Point2 a = run.points[i];
      const Point2 b = run.points[i + 1];
      const double width_mm = run.widths_mm[i];
      if (outline.meets(a, b))
        is_inside = false;
      else if (!is_inside)
        is_inside = outline.contains(lerp(a, b, 0.5));
      if (width_mm <= 0) continue;
      if (width_mm < kThinnest * line_width_mm)
        strays.hollow_mm += distance(a, b);
      else if (!is_inside)
        strays.hollow_mm += outline.outside_length_mm(a, b);
      if (!is_inside || width_mm > line_width_mm) strays.beads.push_back({a, b, width_mm});
    }
  }
  return strays;
}

}  // namespace routebench::judging
