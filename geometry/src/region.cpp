#include "routebench/geometry/region.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory_resource>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "clipper_paths.hpp"
#include "overlay/offset_rings.hpp"
#include "overlay/overlay.hpp"
#include "overlay/scratch.hpp"
#include "overlay/to_grid.hpp"
#include "routebench/geometry/simplify.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench {
namespace {

namespace cl = ClipperLib;
using overlay::Inside;
using overlay::ToGrid;

// Offsets repeated without cleaning lose area: points a few units apart give mitres that are noise.
constexpr double kCleanMm = 0.005;
constexpr double kArcToleranceMm = 0.002;
constexpr double kMiterLimit = 2.0;

bool point_less(Point2 a, Point2 b) { return a.x != b.x ? a.x < b.x : a.y < b.y; }

bool ring_less(const Ring& a, const Ring& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), point_less);
}

/// A point that a ring visits twice may be its smallest: then what follows decides where the ring
/// begins.
void begin_at_smallest(Ring& ring) {
  const std::size_t n = ring.size();
  std::size_t best = 0;
  bool is_alone = true;
  for (std::size_t i = 1; i < n; ++i) {
    if (point_less(ring[best], ring[i])) continue;
    is_alone = ring[i] != ring[best];
    if (is_alone) best = i;
  }
  if (!is_alone) {
    const auto earlier = [&](std::size_t i, std::size_t j) {
      for (std::size_t k = 1; k < n; ++k) {
        const Point2 a = ring[(i + k) % n], b = ring[(j + k) % n];
        if (a != b) return point_less(a, b);
      }
      return false;
    };
    for (std::size_t i = best + 1; i < n; ++i)
      if (ring[i] == ring[best] && earlier(i, best)) best = i;
  }
  std::rotate(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(best), ring.end());
}

Ring ring_from_clipper(const cl::Path& path) {
  Ring ring;
  ring.reserve(path.size());
  for (const cl::IntPoint& p : path) ring.push_back(from_clipper(p));
  begin_at_smallest(ring);
  return ring;
}

void add_outer(const cl::PolyNode& node, Polygons& polygons) {
  Polygon polygon;
  polygon.outer = ring_from_clipper(node.Contour);
  for (const cl::PolyNode* hole : node.Childs) {
    polygon.holes.push_back(ring_from_clipper(hole->Contour));
    for (const cl::PolyNode* island : hole->Childs) add_outer(*island, polygons);
  }
  std::sort(polygon.holes.begin(), polygon.holes.end(), ring_less);
  polygons.push_back(std::move(polygon));
}

/// What overlay finds, if it can be used.
std::optional<Polygons> overlaid(const Polygons& a, const Polygons& b, Inside inside) {
  overlay::Scratch scratch;
  ToGrid grid(0, &scratch);
  if (!grid.add(a, {1, 0}) || !grid.add(b, {0, 1})) return std::nullopt;
  const auto faces = overlay::overlay(grid.take(), inside);
  if (!faces) return std::nullopt;
  return overlay::to_polygons(*faces);
}

// Clipper takes what the overlay cannot: parts of more than a metre from the origin.
Polygons clip(cl::ClipType operation, const Polygons& a, const Polygons& b) {
  const Inside inside = operation == cl::ctUnion          ? Inside::kEither
                        : operation == cl::ctIntersection ? Inside::kBoth
                                                          : Inside::kFirstOnly;
  if (auto polygons = overlaid(a, b, inside)) return *std::move(polygons);
  cl::Clipper clipper;
  clipper.AddPaths(to_clipper(a), cl::ptSubject, true);
  clipper.AddPaths(to_clipper(b), cl::ptClip, true);
  cl::PolyTree tree;
  clipper.Execute(operation, tree, cl::pftNonZero, cl::pftNonZero);
  return from_clipper(tree);
}

}  // namespace

namespace overlay {
namespace {

Ring from_grid_ring(const GridRing& points) {
  std::size_t first = 0;
  std::int64_t least = order_of(points[0]);
  bool is_alone = true;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const std::int64_t order = order_of(points[i]);
    if (order > least) continue;
    is_alone = order < least;
    least = order;
    first = i;
  }
  Ring ring(points.size());
  const auto in_mm = [](GridPoint p) { return Point2{from_grid(p.x), from_grid(p.y)}; };
  const auto smallest = points.begin() + static_cast<std::ptrdiff_t>(first);
  const auto rest = std::transform(smallest, points.end(), ring.begin(), in_mm);
  std::transform(points.begin(), smallest, rest, in_mm);
  if (!is_alone) begin_at_smallest(ring);
  return ring;
}

}  // namespace

Polygons to_polygons(const std::vector<GridPolygon>& faces) {
  Polygons polygons;
  polygons.reserve(faces.size());
  for (const GridPolygon& face : faces) {
    Polygon& polygon = polygons.emplace_back();
    polygon.outer = from_grid_ring(face.outer);
    for (const GridRing& hole : face.holes) polygon.holes.push_back(from_grid_ring(hole));
    std::sort(polygon.holes.begin(), polygon.holes.end(), ring_less);
  }
  std::sort(polygons.begin(), polygons.end(),
            [](const Polygon& a, const Polygon& b) { return ring_less(a.outer, b.outer); });
  return polygons;
}

}  // namespace overlay

cl::Path to_clipper(const Ring& ring) {
  cl::Path path;
  path.reserve(ring.size());
  for (const Point2 p : ring) path.push_back(to_clipper(p));
  return path;
}

cl::Paths to_clipper(const Polygons& polygons) {
  cl::Paths paths;
  for (const Polygon& polygon : polygons) {
    paths.push_back(to_clipper(polygon.outer));
    for (const Ring& hole : polygon.holes) paths.push_back(to_clipper(hole));
  }
  return paths;
}

Polygons from_clipper(const cl::PolyTree& tree) {
  Polygons polygons;
  for (const cl::PolyNode* node : tree.Childs) add_outer(*node, polygons);
  std::sort(polygons.begin(), polygons.end(),
            [](const Polygon& a, const Polygon& b) { return ring_less(a.outer, b.outer); });
  return polygons;
}

double signed_area_mm2(const Ring& ring) {
  if (ring.size() < 3) return 0;
  // Relative to a corner, so that a ring far from the origin loses no digits.
  double twice = 0;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i)
    twice += cross(ring[i] - ring[0], ring[i + 1] - ring[0]);
  return twice / 2;
}

double area_mm2(const Polygon& polygon) {
  double sum = signed_area_mm2(polygon.outer);
  for (const Ring& hole : polygon.holes) sum += signed_area_mm2(hole);
  return sum;
}

double area_mm2(const Polygons& polygons) {
  double sum = 0;
  for (const Polygon& polygon : polygons) sum += area_mm2(polygon);
  return sum;
}

double perimeter_mm(const Ring& ring) {
  if (ring.empty()) return 0;
  double sum = 0;
  for (std::size_t i = 1; i < ring.size(); ++i) sum += distance(ring[i - 1], ring[i]);
  return sum + distance(ring.back(), ring.front());
}

double perimeter_mm(const Polygon& polygon) {
  double sum = perimeter_mm(polygon.outer);
  for (const Ring& hole : polygon.holes) sum += perimeter_mm(hole);
  return sum;
}

double perimeter_mm(const Polygons& polygons) {
  double sum = 0;
  for (const Polygon& polygon : polygons) sum += perimeter_mm(polygon);
  return sum;
}

Box2 around(const Box2& a, const Box2& b) {
  return {{std::min(a.lower.x, b.lower.x), std::min(a.lower.y, b.lower.y)},
          {std::max(a.upper.x, b.upper.x), std::max(a.upper.y, b.upper.y)}};
}

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Box2 kNowhere{{kInfinity, kInfinity}, {-kInfinity, -kInfinity}};

}  // namespace

Box2 bounding_box(const Ring& ring) {
  Box2 box = kNowhere;
  for (const Point2 p : ring) box = around(box, {p, p});
  return box;
}

Box2 bounding_box(const Polygon& polygon) { return bounding_box(polygon.outer); }

Box2 bounding_box(const Polygons& polygons) {
  Box2 box = kNowhere;
  for (const Polygon& polygon : polygons) box = around(box, bounding_box(polygon));
  return box;
}

Polygons polygons_from_rings(std::vector<Ring> rings, FillRule rule) {
  std::erase_if(rings, [](const Ring& ring) { return ring.size() < 3; });
  for (Ring& ring : rings) begin_at_smallest(ring);
  std::sort(rings.begin(), rings.end(), ring_less);
  overlay::Scratch scratch;
  ToGrid grid(0, &scratch);
  if (std::all_of(rings.begin(), rings.end(), [&](const Ring& ring) {
        return grid.add(ring, {1, 0});
      })) {
    const Inside inside = rule == FillRule::kNonZero   ? Inside::kFirstNonZero
                          : rule == FillRule::kEvenOdd ? Inside::kFirstOdd
                                                       : Inside::kFirstPositive;
    if (const auto faces = overlay::overlay(grid.take(), inside))
      return overlay::to_polygons(*faces);
  }
  cl::Clipper clipper;
  for (const Ring& ring : rings) clipper.AddPath(to_clipper(ring), cl::ptSubject, true);
  const cl::PolyFillType fill = rule == FillRule::kNonZero   ? cl::pftNonZero
                                : rule == FillRule::kEvenOdd ? cl::pftEvenOdd
                                                             : cl::pftPositive;
  cl::PolyTree tree;
  clipper.Execute(cl::ctUnion, tree, fill, fill);
  return from_clipper(tree);
}

namespace {

/// A ring without the points that are noise. Clipper's own CleanPolygons looks at three points at a
/// time, so along a curve of many points its errors add up: a circle of thousands becomes a
/// pentagon.
cl::Path cleaned(const cl::Path& path) {
  Ring ring;
  for (const cl::IntPoint& p : path) ring.push_back(from_clipper(p));
  return to_clipper(simplified_ring(std::move(ring), kCleanMm));
}

}  // namespace

bool fits_between_lines(const Ring& ring, double apart_mm) {
  if (apart_mm <= 0) return false;
  const Point2 origin = ring.front();
  Point2 low{}, high{}, sum{};
  double twice_area = 0, xx = 0, xy = 0, yy = 0;
  Point2 before = ring.back() - origin;
  for (const Point2 point : ring) {
    const Point2 p = point - origin;
    twice_area += cross(before, p);
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    before = p;
  }
  const double least = std::min(high.x - low.x, high.y - low.y);
  if (least < apart_mm) return true;
  if (std::abs(twice_area) > 2 * apart_mm * distance(low, high)) return false;
  // Across the direction in which the points are spread most.
  for (const Point2 point : ring) {
    const Point2 p = point - origin;
    sum = sum + p;
    xx += p.x * p.x;
    xy += p.x * p.y;
    yy += p.y * p.y;
  }
  const auto n = static_cast<double>(ring.size());
  xx -= sum.x * sum.x / n;
  xy -= sum.x * sum.y / n;
  yy -= sum.y * sum.y / n;
  const double half = (xx - yy) / 2, root = std::sqrt(half * half + xy * xy);
  const Point2 along = half > 0 ? Point2{half + root, xy} : Point2{xy, root - half};
  double lowest = 0, highest = 0;
  for (const Point2 point : ring) {
    const double height = cross(along, point - origin);
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
  }
  return highest - lowest < apart_mm * std::sqrt(dot(along, along));
}

namespace {

cl::Paths offset_by_clipper(const cl::Paths& boundary, double distance_mm, Join join) {
  cl::ClipperOffset offsetter(kMiterLimit, kArcToleranceMm * kGridUnitsPerMm);
  offsetter.AddPaths(boundary, join == Join::kMiter ? cl::jtMiter : cl::jtRound,
                     cl::etClosedPolygon);
  cl::Paths paths;
  offsetter.Execute(paths, distance_mm * kGridUnitsPerMm);
  for (cl::Path& path : paths) path = cleaned(path);
  return paths;
}

/// Cleaning moves sides, so rings may overlap by as much: the union makes polygons of them again.
Polygons united(const cl::Paths& paths, cl::PolyFillType fill) {
  cl::Clipper clipper;
  clipper.AddPaths(paths, cl::ptSubject, true);
  cl::PolyTree tree;
  clipper.Execute(cl::ctUnion, tree, fill, fill);
  return from_clipper(tree);
}

std::optional<Polygons> offset_on_grid(const overlay::GridRings& rings,
                                       std::span<const double> distances) {
  const auto faces = overlay::offset_rings(rings, distances, kCleanMm * kGridUnitsPerMm);
  return faces ? std::optional(overlay::to_polygons(*faces)) : std::nullopt;
}

/// A mitre is at most twice as long as the distance.
double margin_mm(double distance_mm) { return 2 * std::abs(distance_mm); }

}  // namespace

// Clipper takes what the overlay cannot: parts of more than a metre from the origin, and round
// joins.
Polygons offset(const Polygons& polygons, double distance_mm, Join join) {
  if (distance_mm == 0 || polygons.empty()) return polygons;
  overlay::Scratch scratch;
  ToGrid grid(margin_mm(distance_mm), &scratch);
  const auto add = [&](const Polygon& polygon) {
    return fits_between_lines(polygon.outer, -2 * distance_mm) || grid.add(polygon, {1, 0});
  };
  if (join == Join::kMiter && std::all_of(polygons.begin(), polygons.end(), add)) {
    const std::pmr::vector<double> distances(grid.rings(), distance_mm * kGridUnitsPerMm, &scratch);
    if (auto moved = offset_on_grid(grid.take(), distances)) return *std::move(moved);
  }
  return united(offset_by_clipper(to_clipper(polygons), distance_mm, join), cl::pftNonZero);
}

Polygons offset_boundary(const std::vector<Ring>& rings, const std::vector<double>& distances_mm) {
  if (rings.empty()) return {};
  overlay::Scratch scratch;
  const auto [least, most] = std::minmax_element(distances_mm.begin(), distances_mm.end());
  ToGrid grid(std::max(margin_mm(*least), margin_mm(*most)), &scratch);
  std::pmr::vector<double> distances(&scratch);
  bool fits = true;
  for (std::size_t i = 0; i < rings.size() && fits; ++i) {
    fits = grid.add(rings[i], {1, 0});
    if (grid.rings() > distances.size()) distances.push_back(distances_mm[i] * kGridUnitsPerMm);
  }
  if (fits)
    if (auto moved = offset_on_grid(grid.take(), distances)) return *std::move(moved);
  cl::Paths paths;
  for (std::size_t i = 0; i < rings.size(); ++i) {
    cl::Path path = to_clipper(rings[i]);
    const bool is_hole = !cl::Orientation(path);
    if (is_hole) cl::ReversePath(path);
    cl::Paths moved =
        offset_by_clipper({path}, is_hole ? -distances_mm[i] : distances_mm[i], Join::kMiter);
    if (is_hole) cl::ReversePaths(moved);
    paths.insert(paths.end(), moved.begin(), moved.end());
  }
  return united(paths, cl::pftPositive);
}

Polygons without_thin_parts(const Polygons& polygons, double width_mm) {
  // A part of just this width must leave a core that cleaning does not take for noise.
  const double reach_mm = width_mm / 2 - 2 * kCleanMm;
  if (reach_mm <= 0) return polygons;
  const Polygons cores = offset(polygons, -reach_mm);
  // Grown a little farther, for sides that coincide would cross at every corner.
  return cores.empty() ? cores : intersect(offset(cores, reach_mm + 3 * kCleanMm), polygons);
}

Polygons unite(const Polygons& a, const Polygons& b) { return clip(cl::ctUnion, a, b); }

Polygons intersect(const Polygons& a, const Polygons& b) {
  if (a.empty() || b.empty()) return {};
  return clip(cl::ctIntersection, a, b);
}

Polygons subtract(const Polygons& a, const Polygons& b) {
  return a.empty() || b.empty() ? a : clip(cl::ctDifference, a, b);
}

}  // namespace routebench
