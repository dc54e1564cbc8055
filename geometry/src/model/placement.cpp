#include "model/placement.hpp"

#include <array>
#include <cmath>

#include "model/blocks.hpp"

namespace routebench::models {
namespace {

constexpr double kLargestSideMm = 10'000;
constexpr double kFarMm = 1'000;
constexpr double kCoarsestStepMm = 0.1;
/// Below this somebody will have meant metres or inches.
constexpr double kTinyMm = 1;

/// The step between neighbouring coordinates as large as `magnitude`.
double resolution(double magnitude, bool single_precision) {
  const int bits = single_precision ? 24 : 53;
  return std::ldexp(1.0, std::ilogb(magnitude) + 1 - bits);
}

double farthest(const Bounds& b) {
  return std::max({std::abs(b.lower.x), std::abs(b.upper.x), std::abs(b.lower.y),
                   std::abs(b.upper.y), std::abs(b.lower.z), std::abs(b.upper.z)});
}

std::string box_text(const Point3& size, double scale) {
  return rounded(size.x * scale) + " x " + rounded(size.y * scale) + " x " +
         rounded(size.z * scale) + " mm";
}

void refuse_unprintable(const Bounds& bounds, double scale, const std::string& name) {
  const Point3 size = bounds.size();
  const std::array<double, 3> sides{size.x, size.y, size.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (sides[axis] > 0) continue;
    refuse_model(name, std::string("nothing to print: the model has no extent along ") +
                           "xyz"[axis] + " (" + box_text(size, 1) + ")");
  }
  if (bounds.largest_side() * scale > kLargestSideMm * (1 + 1e-9)) {
    refuse_model(name, "too large: " + box_text(size, scale) +
                           ", at most 10 m fit; ?size=200 scales the largest side to 200 mm");
  }
}

}  // namespace

Placement place(RawMesh& raw, std::optional<double> size_mm, const std::string& name,
                const ParallelFor& parallel_for) {
  const Bounds bounds = bounds_of(raw.mesh, parallel_for);
  const double scale = size_mm ? *size_mm / bounds.largest_side() : 1.0;
  refuse_unprintable(bounds, scale, name);

  const double step = resolution(farthest(bounds), raw.single_precision) * scale;
  const std::string far_away = "up to " + rounded(farthest(bounds) * scale) +
                               " mm from the origin, where coordinates are good to " +
                               rounded(step) + " mm";
  if (step > kCoarsestStepMm) {
    refuse_model(name, "too far away: " + far_away +
                           "; move the model to the origin and save it "
                           "again");
  }
  const double reach_xy = scale * std::max({std::abs(bounds.lower.x), std::abs(bounds.upper.x),
                                            std::abs(bounds.lower.y), std::abs(bounds.upper.y)});
  Point3 origin{0, 0, bounds.lower.z};
  if (reach_xy > kFarMm && (bounds.lower.x != 0 || bounds.lower.y != 0)) {
    origin = bounds.lower;
    raw.warnings.push_back("moved to begin at x = y = 0: it lies " + far_away);
  }
  const auto placed = [&](const Point3& p) {
    return Point3{(p.x - origin.x) * scale, (p.y - origin.y) * scale, (p.z - origin.z) * scale};
  };
  const auto move = [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) raw.mesh.vertices[v] = placed(raw.mesh.vertices[v]);
  };
  if (origin != Point3{} || scale != 1)
    for_each_block(raw.mesh.vertices.size(), parallel_for, move);
  if (bounds.largest_side() * scale < kTinyMm) {
    raw.warnings.push_back("tiny: " + box_text(bounds.size(), scale) +
                           "; if the file is in metres or inches, scale it with ?size=...");
  }
  // Rounding keeps the order, so these are the bounds of what was moved.
  return {scale, {placed(bounds.lower), placed(bounds.upper)}};
}

}  // namespace routebench::models
