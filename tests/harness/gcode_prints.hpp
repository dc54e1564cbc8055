#pragma once
/// Prints for tests of G-code, and their files.

#include <cmath>
#include <cstdint>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "random_polygons.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/harness/gcode_writer.hpp"

namespace routebench::test {

struct Print {
  std::vector<Layer> layers;
  std::vector<PlannedLayer> planned;
};

/// Strokes of 2 to 40 points, from 0.001 mm to several mm a step, on some layers of one plate.
inline Print random_print(std::uint64_t seed, int layers = 3) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> place(-40, 40), log_step(-3, 1), angle(0, 6.283);
  std::uniform_int_distribution<int> count(2, 40), kind(0, 2);
  Print print;
  for (int index = 0; index < layers; ++index) {
    print.layers.push_back({.index = index,
                            .z_mm = 0.2 * index + 0.1,
                            .height_mm = 0.2,
                            .polygons = {{rectangle(-50, -50, 50, 50), {}}},
                            .solid = {}});
    PlannedLayer planned;
    for (int s = 0; s < 30; ++s) {
      Stroke stroke{{snap(Point2{place(random), place(random)})}, s % 2 == 0 ? 0.45 : 0.6};
      for (int k = count(random); k > 1; --k) {
        const double step = std::pow(10, log_step(random)), a = angle(random);
        const Point2 from = stroke.points.back();
        stroke.points.push_back(
            snap(Point2{from.x + step * std::cos(a), from.y + step * std::sin(a)}));
      }
      planned.route.strokes.push_back(stroke);
      planned.kinds.push_back(static_cast<StrokeKind>(kind(random)));
    }
    print.planned.push_back(planned);
  }
  return print;
}

inline std::string gcode_of(const Print& print, const Task& task, const Printer& printer,
                            const ParallelFor& parallel_for = serial_for) {
  std::ostringstream out;
  GcodeWriter writer(out, task, printer, {});
  std::vector<RoutedLayer> layers;
  for (std::size_t i = 0; i < print.layers.size(); ++i)
    layers.push_back({&print.layers[i], &print.planned[i]});
  writer.write_layers(layers, parallel_for);
  writer.finish();
  return out.str();
}

}  // namespace routebench::test
