#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <random>
#include <string>

#include "gcode_prints.hpp"
#include "gcode_reader.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/harness/parallel.hpp"

namespace routebench {
namespace {

using test::Print;

/// Layers in runs of equal polygons, each of parts that come again on others, now and then beside
/// some that do not. Some parts begin with a move that vanishes when it is written.
Print print_of_parts(std::uint64_t seed, int layers) {
  std::mt19937_64 random(seed);
  const Print pool = test::random_print(seed, 8);
  std::vector<std::shared_ptr<const Route>> routes;
  for (const PlannedLayer& planned : pool.planned) {
    auto route = std::make_shared<Route>(planned.route);
    route->strokes.resize(3 + random() % 5);
    if (routes.size() % 3 == 1) {
      std::vector<Point2>& points = route->strokes[0].points;
      points.insert(points.begin(), points.front());
    }
    routes.push_back(std::move(route));
  }
  Print print = test::random_print(seed, layers);
  double outline_mm = 50;
  for (int i = 0; i < layers; ++i) {
    if (random() % 7 == 0) outline_mm = 20 + static_cast<double>(random() % 30);
    print.layers[static_cast<std::size_t>(i)].polygons = {
        {test::rectangle(-outline_mm, -outline_mm, outline_mm, outline_mm), {}}};
    PlannedLayer& planned = print.planned[static_cast<std::size_t>(i)];
    planned.route = {};
    planned.kinds = {};
    for (std::size_t k = 0; k < routes.size(); ++k) {
      if (random() % 3 == 0) continue;
      const bool is_shared = k != 5;
      const std::vector<Stroke>& strokes = routes[k]->strokes;
      planned.route.strokes.insert(planned.route.strokes.end(), strokes.begin(), strokes.end());
      planned.kinds.insert(planned.kinds.end(), strokes.size(), static_cast<StrokeKind>(k % 3));
      planned.parts.push_back({strokes.size(), is_shared ? routes[k] : nullptr});
    }
  }
  return print;
}

Print without_sharing(Print print) {
  for (PlannedLayer& planned : print.planned)
    for (PlannedPart& part : planned.parts) part.shared = nullptr;
  return print;
}

TEST(GcodeRepeats, CopiedTextIsWhatWouldBeWritten) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Print print = print_of_parts(seed, 60);
    const Print plain = without_sharing(print);
    for (const char* flavour : {"marlin", "ultigcode"}) {
      for (const RetractPolicy policy :
           {RetractPolicy::kLength, RetractPolicy::kLengthAndCrossing}) {
        for (const double lift_mm : {0.0, 0.4}) {
          for (const double extrude_mm_s : {60.0, 150.0}) {  // the latter as fast as travels
            Printer printer;
            printer.flavour = flavour;
            printer.retract_policy = policy;
            printer.lift_mm = lift_mm;
            printer.extrude_mm_s = extrude_mm_s;
            const std::string expected = gcode_of(plain, {}, printer);
            EXPECT_TRUE(gcode_of(print, {}, printer) == expected)
                << "seed " << seed << ", " << flavour << ", lift " << lift_mm;
            EXPECT_TRUE(gcode_of(print, {}, printer, parallel_loop(3)) == expected)
                << "seed " << seed << ", " << flavour << ", lift " << lift_mm;
          }
        }
      }
    }
  }
}

TEST(GcodeRepeats, RoundingOfFilamentDoesNotAddUp) {
  const Print print = print_of_parts(9, 300);
  double volume_mm3 = 0;
  for (const PlannedLayer& planned : print.planned)
    for (const Stroke& stroke : planned.route.strokes)
      for (std::size_t i = 1; i < stroke.points.size(); ++i)
        volume_mm3 += distance(stroke.points[i - 1], stroke.points[i]) *
                      ((stroke.width_mm - 0.2) * 0.2 + std::numbers::pi * 0.01);
  const double filament_mm = volume_mm3 / (std::numbers::pi * 1.75 * 1.75 / 4);
  EXPECT_NEAR(test::read_gcode(gcode_of(print, {}, {})).filament_mm, filament_mm, 1.5e-5);
}

}  // namespace
}  // namespace routebench
