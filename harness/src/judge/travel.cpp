#include "judge/travel.hpp"

#include <cmath>

#include "routebench/geometry/vec.hpp"
#include "routebench/harness/judge.hpp"

namespace routebench {
namespace {

// Some grid units: a travel that only touches the boundary does not leave the polygons.
constexpr double kCrossingMm = 1e-5;

}  // namespace

bool retracts(const Printer& printer, Point2 from, Point2 to, double outside_mm) {
  switch (printer.retract_policy) {
    case RetractPolicy::kLength:
      return distance(from, to) >= printer.retract_over_mm;
    case RetractPolicy::kLengthAndCrossing:
      return distance(from, to) >= printer.retract_over_mm && outside_mm > kCrossingMm;
    case RetractPolicy::kManhattan:
      return std::abs(to.x - from.x) + std::abs(to.y - from.y) >= printer.retract_over_mm;
  }
  return false;
}

namespace judging {

Travel travel_to(Point2 from, Point2 to, const EdgeGrid& outline, const Printer& printer) {
  const double outside = outline.outside_length_mm(from, to);
  return {.from = from,
          .to = to,
          .length_mm = distance(from, to),
          .outside_mm = outside,
          .crosses = outside > kCrossingMm,
          .retracted = retracts(printer, from, to, outside)};
}

std::vector<Travel> travels_between(const std::vector<Run>& runs, const EdgeGrid& outline,
                                    const Printer& printer) {
  std::vector<Travel> travels;
  for (std::size_t i = 1; i < runs.size(); ++i)
    travels.push_back(
        travel_to(runs[i - 1].points.back(), runs[i].points.front(), outline, printer));
  return travels;
}

}  // namespace judging
}  // namespace routebench
