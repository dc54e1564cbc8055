/// Parts as machines have them: prismatic, with bores and bosses.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "shapes/shapes.hpp"
#include "shapes/stacked.hpp"

namespace routebench::shapes {
namespace {

constexpr double kArcMm = 0.8;
/// The least material between two walls.
constexpr double kLeastWallMm = 0.2;

/// How far the involute of a circle has turned where it has reached a radius.
double involute_angle(double base_radius, double radius) {
  const double stretch =
      std::sqrt(std::max(0.0, radius * radius / (base_radius * base_radius) - 1));
  return stretch - std::atan(stretch);
}

/// The outline of a spur gear with a pressure angle of 20 degrees, about the origin.
Ring gear_outline(int teeth, double module_mm, double arc_mm) {
  const double pitch = module_mm * teeth / 2;
  const double base = pitch * std::cos(20 * std::numbers::pi / 180);
  const double tip = pitch + module_mm;
  const double root = pitch - 1.25 * module_mm;
  const double start = std::max(base, root);
  const double half_tooth = std::numbers::pi / (2 * teeth) + involute_angle(base, pitch);
  const auto steps = static_cast<int>(std::clamp(std::ceil((tip - start) / arc_mm), 3.0, 1000.0));

  std::vector<Point2> flank;  // radius and angle off the tooth's middle, from root to tip
  if (root < base) flank.push_back({root, half_tooth - involute_angle(base, start)});
  for (int i = 0; i <= steps; ++i) {
    const double radius = start + (tip - start) * i / steps;
    flank.push_back({radius, half_tooth - involute_angle(base, radius)});
  }
  Ring ring;
  for (int tooth = 0; tooth < teeth; ++tooth) {
    const double middle = 2 * std::numbers::pi * tooth / teeth;
    const auto add = [&](double radius, double angle) {
      ring.push_back({radius * std::cos(middle + angle), radius * std::sin(middle + angle)});
    };
    for (const Point2 p : flank) add(p.x, -p.y);
    for (auto p = flank.rbegin(); p != flank.rend(); ++p) add(p->x, p->y);
  }
  return ring;
}

}  // namespace

/// The heater block of a hot end: through holes for nozzle (counterbored), cartridge, sensor and
/// screw.
Mesh make_hotend(ShapeQuery& query) {
  const double x = query.mm("x", 23);
  const double y = query.mm("y", 16);
  const double z = query.mm("z", 12);
  const double nozzle = query.mm("nozzle", 6) / 2;
  const double cartridge = query.mm("cartridge", 6) / 2;
  const double sensor = query.mm("sensor", 3) / 2;
  const std::size_t triangles = query.triangles(1000);
  query.finish();
  const double counterbore = nozzle * 1.5;
  const double depth = z / 5;
  const Point2 nozzle_at{x * 0.3, y / 2};
  const Point2 cartridge_at{x * 0.72, y * 0.7};
  const Point2 sensor_at{x * 0.66, y * 0.2};
  const Point2 screw_at{x * 0.88, y * 0.2};
  const bool fits = std::min({nozzle_at.x, nozzle_at.y}) > counterbore + kLeastWallMm &&
                    cartridge_at.x - nozzle_at.x > counterbore + cartridge + kLeastWallMm &&
                    std::min(x - cartridge_at.x, y - cartridge_at.y) > cartridge + kLeastWallMm &&
                    std::min(sensor_at.y, x - screw_at.x) > sensor + kLeastWallMm &&
                    screw_at.x - sensor_at.x > 2 * sensor + kLeastWallMm &&
                    sensor_at.x - nozzle_at.x > counterbore + sensor + kLeastWallMm &&
                    cartridge_at.y - sensor_at.y > cartridge + sensor + kLeastWallMm;
  if (!fits) query.refuse("the holes do not fit into the block: make it larger or them smaller");
  return refined(triangles, kArcMm, [&](double arc) {
    return stack({{rectangle({0, 0}, {x, y}), 0, z},
                  {reversed(circle(nozzle_at, nozzle, arc)), 0, z - depth},
                  {reversed(circle(nozzle_at, counterbore, arc)), z - depth, z},
                  {reversed(circle(cartridge_at, cartridge, arc)), 0, z},
                  {reversed(circle(sensor_at, sensor, arc)), 0, z},
                  {reversed(circle(screw_at, sensor, arc)), 0, z}});
  });
}

/// A spur gear, or with a twist a helical one.
Mesh make_gear(ShapeQuery& query) {
  const int teeth = query.count("teeth", 24, 6, 1000);
  const double module_mm = query.mm("module", 1.5, 0.1, 100);
  const double height = query.mm("height", 8);
  const double bore = query.mm("bore", 8) / 2;
  const double twist_deg = query.number("twist_deg", 0, -90, 90);
  const std::size_t triangles = query.triangles(4000);
  query.finish();
  const double root = module_mm * teeth / 2 - 1.25 * module_mm;
  if (!(root > bore + kLeastWallMm)) query.refuse("the bore must be smaller than the gear's root");
  Mesh mesh = refined(triangles, kArcMm, [&](double arc) {
    return stack({{gear_outline(teeth, module_mm, arc), 0, height},
                  {reversed(circle({0, 0}, bore, arc)), 0, height}});
  });
  const double tip = module_mm * teeth / 2 + module_mm;
  for (Point3& p : mesh.vertices) {
    const double angle = twist_deg * std::numbers::pi / 180 * p.z / height;
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    p = {tip + p.x * c - p.y * s, tip + p.x * s + p.y * c, p.z};
  }
  return mesh;
}

/// A back with teeth as wide as the gaps between them.
Mesh make_comb(ShapeQuery& query) {
  const double x = query.mm("x", 60);
  const double y = query.mm("y", 30);
  const double z = query.mm("z", 5);
  const double back = query.mm("back", 6);
  const int teeth = query.count("teeth", 16, 1, 10'000);
  const std::size_t triangles = query.triangles(12);
  query.finish();
  if (!(back + kLeastWallMm <= y)) query.refuse("the back must be narrower than the comb (y)");
  const double step = x / (2 * teeth - 1);
  Ring ring{{0, 0}, {x, 0}};
  for (int tooth = teeth - 1; tooth >= 0; --tooth) {
    const double left = 2 * tooth * step;
    const double right = tooth == teeth - 1 ? x : left + step;
    if (tooth != teeth - 1) ring.push_back({right, back});
    ring.push_back({right, y});
    ring.push_back({left, y});
    if (tooth != 0) ring.push_back({left, back});
  }
  return refined(triangles, kArcMm, [&](double) { return stack({{ring, 0, z}}); });
}

/// A square plate full of round holes, `holes` in a row, like the grate of a filter.
Mesh make_grate(ShapeQuery& query) {
  const int holes = query.count("holes", 8, 1, 500);
  const double pitch = query.mm("pitch", 6);
  const double diameter = query.mm("diameter", 4);
  const double z = query.mm("z", 3);
  const std::size_t triangles =
      query.triangles(static_cast<std::size_t>(64) * static_cast<std::size_t>(holes * holes));
  query.finish();
  if (!(diameter + kLeastWallMm <= pitch)) query.refuse("the holes must be smaller than the pitch");
  const double side = pitch * holes;
  return refined(triangles, kArcMm, [&](double arc) {
    std::vector<Wall> walls{{rectangle({0, 0}, {side, side}), 0, z}};
    for (int row = 0; row < holes; ++row)
      for (int column = 0; column < holes; ++column)
        walls.push_back(
            {reversed(circle({(column + 0.5) * pitch, (row + 0.5) * pitch}, diameter / 2, arc)), 0,
             z});
    return stack(walls);
  });
}

/// A rounded base plate with four screw holes, two cheeks and a bored boss between them.
Mesh make_bracket(ShapeQuery& query) {
  const double x = query.mm("x", 60);
  const double y = query.mm("y", 40);
  const double z = query.mm("z", 30);
  const double plate = query.mm("plate", 4);
  const double hole = query.mm("hole", 4) / 2;
  const std::size_t triangles = query.triangles(1500);
  query.finish();
  const double inset = 2.5 * hole;
  const double cheek = std::min(x, y) / 10;
  const double cheek_from = x * 0.25;
  const double boss = x * 0.12;
  const double bore = boss / 2;
  const bool fits = plate + kLeastWallMm < z && inset + hole + kLeastWallMm < cheek_from &&
                    2 * (inset + hole) + kLeastWallMm < y && cheek > kLeastWallMm &&
                    cheek_from + cheek + kLeastWallMm < x / 2 - boss && bore > kLeastWallMm &&
                    boss + kLeastWallMm < y / 2;
  if (!fits)
    query.refuse("the parts of the bracket do not fit: make it larger or its holes smaller");
  const double boss_top = plate + (z - plate) / 3;
  return refined(triangles, kArcMm, [&](double arc) {
    std::vector<Wall> walls{
        {rounded_rectangle({0, 0}, {x, y}, inset, arc), 0, plate},
        {circle({x / 2, y / 2}, boss, arc), plate, boss_top},
        {reversed(circle({x / 2, y / 2}, bore, arc)), 0, boss_top},
        {rectangle({cheek_from, y * 0.1}, {cheek_from + cheek, y * 0.9}), plate, z},
        {rectangle({x - cheek_from - cheek, y * 0.1}, {x - cheek_from, y * 0.9}), plate, z}};
    for (const double hole_x : {inset, x - inset}) {
      for (const double hole_y : {inset, y - inset}) {
        walls.push_back({reversed(circle({hole_x, hole_y}, hole, arc)), 0, plate});
      }
    }
    return stack(walls);
  });
}

}  // namespace routebench::shapes
