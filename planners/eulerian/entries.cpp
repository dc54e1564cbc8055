#include "eulerian/entries.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "routebench/planning/nearest_grid.hpp"

namespace routebench::eulerian {

std::vector<Stroke> nearest_entry_first(std::vector<Stroke> strokes, Point2 start,
                                        const PlanContext& context) {
  struct Entry {
    std::uint32_t stroke;
    std::uint32_t point;
  };
  std::vector<Entry> entries;
  std::vector<Point2> places;
  std::vector<std::uint32_t> first_entry;
  for (std::uint32_t s = 0; s < strokes.size(); ++s) {
    const std::vector<Point2>& points = strokes[s].points;
    const auto last = static_cast<std::uint32_t>(points.size() - 1);
    const bool is_loop = points.front() == points.back();
    first_entry.push_back(static_cast<std::uint32_t>(entries.size()));
    for (std::uint32_t i = 0; i <= last; i += is_loop ? 1 : last) {
      if (is_loop && i == last) break;
      entries.push_back({s, i});
      places.push_back(points[i]);
    }
  }
  first_entry.push_back(static_cast<std::uint32_t>(entries.size()));

  NearestGrid grid(std::move(places));
  std::vector<Stroke> ordered;
  ordered.reserve(strokes.size());
  Point2 nozzle = start;
  while (const auto found = grid.nearest(nozzle)) {
    stop_if_asked(context);
    const Entry entry = entries[*found];
    std::vector<Point2>& points = strokes[entry.stroke].points;
    if (points.front() == points.back()) {
      points.pop_back();
      std::rotate(points.begin(), points.begin() + entry.point, points.end());
      points.push_back(points.front());
    } else if (entry.point > 0) {
      std::reverse(points.begin(), points.end());
    }
    nozzle = points.back();
    for (std::uint32_t e = first_entry[entry.stroke]; e < first_entry[entry.stroke + 1]; ++e)
      grid.remove(e);
    ordered.push_back(std::move(strokes[entry.stroke]));
  }
  return ordered;
}

}  // namespace routebench::eulerian
