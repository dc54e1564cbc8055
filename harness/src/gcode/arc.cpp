#include "gcode/arc.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "routebench/geometry/vec.hpp"

namespace routebench::gcode {
namespace {

constexpr double kFullTurn = 2 * std::numbers::pi;

/// The centre of an arc that is given by its radius.
Point2 centre_by_radius(const Arc& arc, const Place& place) {
  const Point2 chord = arc.to - arc.from;
  const double length = std::sqrt(dot(chord, chord));
  const double radius = std::abs(*arc.radius_mm);
  if (length <= 0) place.refuse("an arc by radius ends where it begins; a circle needs I and J");
  constexpr double kSlack = 1 + 1e-3;  // ends and radius are rounded
  if (radius * kSlack < length / 2) place.refuse("the radius R of the arc does not reach its end");
  const double height =
      std::sqrt(std::max(0.0, (radius - length / 2) * (radius + length / 2))) / length;
  // The centre of a short counter-clockwise arc lies to the left of its chord.
  const bool left = arc.clockwise == (*arc.radius_mm < 0);
  const Point2 across = Point2{-chord.y, chord.x};
  return lerp(arc.from, arc.to, 0.5) + (left ? height : -height) * across;
}

Point2 centre_of(const Arc& arc, const Place& place) {
  if (arc.centre && arc.radius_mm) place.refuse("an arc has either I and J or R, not both");
  if (arc.centre) return arc.from + *arc.centre;
  if (!arc.radius_mm) place.refuse("an arc needs its centre (I, J) or its radius (R)");
  return centre_by_radius(arc, place);
}

}  // namespace

void flatten(const Arc& arc, double tolerance_mm, const Place& place, std::vector<Point2>& points) {
  const Point2 centre = centre_of(arc, place);
  const Point2 first = arc.from - centre;
  const Point2 last = arc.to - centre;
  const double radius = std::sqrt(dot(first, first));
  const double last_radius = std::sqrt(dot(last, last));
  if (radius <= 0) place.refuse("the centre of the arc is where it begins");
  constexpr double kLargestMm = 1e6;
  if (!(radius <= kLargestMm)) place.refuse("the radius of the arc is more than 1 km");
  constexpr double kOffMm = 0.05;
  constexpr double kOffShare = 0.01;
  if (std::abs(last_radius - radius) > std::max(kOffMm, kOffShare * radius))
    place.refuse("the end of the arc is not on its circle");

  double turn = std::atan2(cross(first, last), dot(first, last));
  if (arc.from == arc.to) turn = 0;
  if (arc.clockwise) turn = -turn;
  if (turn <= 0) turn += kFullTurn;

  constexpr double kLongestChord = 0.1;  // of the radius: short arcs keep their length, too
  constexpr double kFinest = 1e-6;       // of the radius: one line may not become a million chords
  tolerance_mm = std::max(tolerance_mm, kFinest * radius);
  const double by_tolerance =
      tolerance_mm < radius ? 2 * std::acos(1 - tolerance_mm / radius) : kLongestChord;
  const double step = std::min(kLongestChord, by_tolerance);
  const double chords = std::ceil(turn / step);
  points.clear();
  for (double k = 1; k < chords; ++k) {
    const double share = k / chords;
    const double angle = arc.clockwise ? -share * turn : share * turn;
    // What rounding has put the end off the circle is spread over the arc.
    const double scale = 1 + share * (last_radius / radius - 1);
    const Point2 turned{first.x * std::cos(angle) - first.y * std::sin(angle),
                        first.x * std::sin(angle) + first.y * std::cos(angle)};
    points.push_back(centre + scale * turned);
  }
  points.push_back(arc.to);
}

}  // namespace routebench::gcode
