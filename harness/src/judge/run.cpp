#include "judge/run.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>

#include "routebench/geometry/error.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench::judging {
namespace {

constexpr double kFurthestMm = 1e9;  // squares of distances stay exact to far below a grid unit

void check(const Stroke& stroke, std::size_t place) {
  const auto refuse = [place](const std::string& what) {
    throw Error(ErrorKind::kBadInput, "route: stroke " + std::to_string(place) + " " + what);
  };
  if (stroke.points.empty()) refuse("has no points");
  for (const Point2 p : stroke.points)
    if (!(std::abs(p.x) <= kFurthestMm && std::abs(p.y) <= kFurthestMm))
      refuse("has a coordinate that is not a number up to 1e9 mm");
  if (!(stroke.width_mm > 0 && stroke.width_mm <= kFurthestMm))
    refuse("has a width that is not a positive number of mm");
}

/// Whether strokes that meet are longer than `least_mm` together.
bool are_longer(std::span<const Stroke> strokes, double least_mm) {
  double length_mm = 0;
  for (const Stroke& stroke : strokes)
    for (std::size_t i = 1; i < stroke.points.size(); ++i) {
      length_mm += distance(stroke.points[i - 1], stroke.points[i]);
      if (length_mm > least_mm) return true;
    }
  return false;
}

/// Where the strokes end that meet each other from the first one on.
std::size_t end_of_meeting(const std::vector<Stroke>& strokes, std::size_t first) {
  std::size_t end = first + 1;
  while (end < strokes.size() && strokes[end].points.front() == strokes[end - 1].points.back())
    ++end;
  return end;
}

}  // namespace

std::vector<Run> runs_of(const Route& route, double join_mm) {
  for (std::size_t place = 0; place < route.strokes.size(); ++place)
    check(route.strokes[place], place);
  std::vector<Run> runs;
  const auto go_to = [&runs](Point2 p, double width_mm) {
    Run& run = runs.back();
    if (run.points.back() == p) return;
    run.points.push_back(p);
    run.widths_mm.push_back(width_mm);
  };
  const auto add = [&](const Stroke& stroke) {
    const Point2 start = stroke.points.front();
    if (runs.empty() || distance(runs.back().points.back(), start) > join_mm) {
      Run& run = runs.emplace_back();
      run.points.reserve(stroke.points.size());  // mostly it is all of the run
      run.widths_mm.reserve(stroke.points.size());
      run.points.push_back(start);
    } else {
      go_to(start, 0);
    }
    for (const Point2 p : stroke.points) go_to(p, stroke.width_mm);
  };
  for (std::size_t first = 0; first < route.strokes.size();) {
    const std::size_t end = end_of_meeting(route.strokes, first);
    const auto meeting = std::span(route.strokes).subspan(first, end - first);
    if (are_longer(meeting, join_mm)) std::for_each(meeting.begin(), meeting.end(), add);
    first = end;
  }
  for (Run& run : runs)
    run.loop = run.points.size() > 2 && distance(run.points.front(), run.points.back()) <= join_mm;
  return runs;
}

std::size_t sharp_turns(const std::vector<Run>& runs) {
  std::size_t turns = 0;
  for (const Run& run : runs) {
    Point2 before{};  // direction of the bead before; none yet
    for (std::size_t i = 0; i < run.widths_mm.size(); ++i) {
      if (run.widths_mm[i] <= 0) continue;
      const Point2 after = run.points[i + 1] - run.points[i];
      if (dot(before, after) < 0) ++turns;
      before = after;
    }
  }
  return turns;
}

}  // namespace routebench::judging
