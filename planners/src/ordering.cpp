#include "routebench/planning/ordering.hpp"

#include <algorithm>
#include <utility>

#include "routebench/planning/nearest_grid.hpp"

namespace routebench {

std::vector<Stroke> nearest_first(std::vector<Stroke> strokes, Point2 start,
                                  const PlanContext& context) {
  // Ends 2 i and 2 i + 1 belong to stroke i.
  std::vector<Point2> ends;
  ends.reserve(2 * strokes.size());
  for (const Stroke& stroke : strokes) {
    ends.push_back(stroke.points.front());
    ends.push_back(stroke.points.back());
  }
  NearestGrid grid(std::move(ends));
  std::vector<Stroke> ordered;
  ordered.reserve(strokes.size());
  Point2 nozzle = start;
  while (const auto end = grid.nearest(nozzle)) {
    stop_if_asked(context);
    Stroke& stroke = strokes[*end / 2];
    if (*end % 2 == 1) std::reverse(stroke.points.begin(), stroke.points.end());
    nozzle = stroke.points.back();
    grid.remove(*end);
    grid.remove(*end ^ 1U);
    ordered.push_back(std::move(stroke));
  }
  return ordered;
}

}  // namespace routebench
