#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <random>
#include <span>
#include <sstream>

#include "fixed_point.hpp"
#include "gcode/near_boundary.hpp"
#include "gcode_prints.hpp"
#include "gcode_reader.hpp"
#include "random_polygons.hpp"
#include "routebench/geometry/edge_grid.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/harness/gcode_writer.hpp"
#include "routebench/harness/parallel.hpp"

namespace routebench {
namespace {

using test::gcode_of;
using test::GcodeRun;
using test::Print;
using test::random_print;
using test::read_gcode;

/// A rectangle with round ends, 0.2 mm high.
double section_mm2(double width_mm) { return (width_mm - 0.2) * 0.2 + std::numbers::pi * 0.01; }

/// What the routes themselves say.
struct Sums {
  double extrude_mm = 0, travel_mm = 0, volume_mm3 = 0;
  int long_travels = 0;
};
Sums sums_of(const Print& print, double long_mm) {
  Sums sums;
  std::optional<Point2> nozzle;
  for (const PlannedLayer& planned : print.planned) {
    for (const Stroke& stroke : planned.route.strokes) {
      if (nozzle) {
        const double gap = distance(*nozzle, stroke.points.front());
        sums.travel_mm += gap;
        sums.long_travels += gap >= long_mm ? 1 : 0;
      }
      for (std::size_t i = 1; i < stroke.points.size(); ++i) {
        const double length = distance(stroke.points[i - 1], stroke.points[i]);
        sums.extrude_mm += length;
        sums.volume_mm3 += length * section_mm2(stroke.width_mm);
      }
      nozzle = stroke.points.back();
    }
  }
  return sums;
}

TEST(Gcode, AnIndependentReaderFindsTheSameSums) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Print print = random_print(seed);
    const Printer printer;
    const GcodeRun run = read_gcode(gcode_of(print, {}, printer));
    const Sums sums = sums_of(print, printer.retract_over_mm);
    EXPECT_NEAR(run.extrude_mm, sums.extrude_mm, 1e-5 * sums.extrude_mm);
    EXPECT_NEAR(run.travel_mm, sums.travel_mm, 1e-5 * sums.travel_mm);
    EXPECT_EQ(run.retractions, sums.long_travels);
    EXPECT_NEAR(run.pulled_mm, 0, 1e-9);
    const double filament_section = std::numbers::pi * 1.75 * 1.75 / 4;
    EXPECT_NEAR(run.filament_mm * filament_section, sums.volume_mm3, 1e-3 * sums.volume_mm3);
  }
}

TEST(Gcode, PointsOnTheGridComeBackAsTheyWere) {
  const Print print = random_print(7);
  const GcodeRun run = read_gcode(gcode_of(print, {}, {}));
  std::size_t at = 0;
  for (std::size_t i = 0; i < print.layers.size(); ++i) {
    for (const Stroke& stroke : print.planned[i].route.strokes) {
      ASSERT_LT(at, run.strokes.size());
      std::vector<Point2> points = run.strokes[at];
      for (Point2& p : points) p = snap(p);
      EXPECT_EQ(points, stroke.points);
      // The nozzle is at the top of the slab that a cut stands for.
      EXPECT_NEAR(run.stroke_z_mm[at], print.layers[i].z_mm + 0.1, 1e-5);
      ++at;
    }
  }
  EXPECT_EQ(at, run.strokes.size());
}

Print two_strokes(Point2 end_of_first, Point2 start_of_second) {
  Print print;
  print.layers.push_back(
      {.index = 0,
       .z_mm = 0.1,
       .height_mm = 0.2,
       .polygons = {{test::rectangle(0, 0, 10, 10), {}}, {test::rectangle(20, 0, 30, 10), {}}},
       .solid = {}});
  PlannedLayer planned;
  planned.route.strokes = {{{{1, 1}, end_of_first}, 0.45},
                           {{start_of_second, {start_of_second.x + 1, 5}}, 0.45}};
  planned.kinds = {StrokeKind::kDense, StrokeKind::kDense};
  print.planned.push_back(planned);
  return print;
}

TEST(Gcode, RetractsByThePrintersPolicy) {
  Printer printer;
  const auto retractions = [&](Point2 from, Point2 to) {
    return read_gcode(gcode_of(two_strokes(from, to), {}, printer)).retractions;
  };
  EXPECT_EQ(retractions({5, 1}, {5, 3}), 1) << "a travel of exactly the limit";
  EXPECT_EQ(retractions({5, 1}, {5, 2.999}), 0);
  EXPECT_EQ(retractions({5, 1}, {6.2, 2.2}), 0);
  printer.retract_policy = RetractPolicy::kManhattan;
  EXPECT_EQ(retractions({5, 1}, {6.2, 2.2}), 1) << "1.2 + 1.2 is over 2";
  printer.retract_policy = RetractPolicy::kLengthAndCrossing;
  EXPECT_EQ(retractions({5, 1}, {5, 9}), 0) << "long, but inside";
  EXPECT_EQ(retractions({5, 1}, {25, 1}), 1) << "long and outside";
}

TEST(Gcode, GapsThatTheTaskJoinsAreNeverRetracted) {
  Printer printer;
  printer.retract_over_mm = 0;
  const Task task;
  const auto run = [&](Point2 to) {
    return read_gcode(gcode_of(two_strokes({5, 1}, to), task, printer));
  };
  EXPECT_EQ(run({5.009, 1}).retractions, 0);
  EXPECT_EQ(run({5.011, 1}).retractions, 1);
  EXPECT_EQ(run({5, 1}).strokes.size(), 1u) << "without a gap there is no move";
}

TEST(Gcode, LiftsOnRetractingTravelsOnly) {
  Printer printer;
  printer.lift_mm = 0.5;
  const GcodeRun lifted = read_gcode(gcode_of(two_strokes({5, 1}, {5, 9}), {}, printer));
  ASSERT_EQ(lifted.travel_heights_mm.size(), 1u);
  EXPECT_NEAR(lifted.travel_heights_mm[0], 0.7, 1e-9);
  EXPECT_NEAR(lifted.stroke_z_mm[1], 0.2, 1e-9) << "and comes down before the stroke";
  const GcodeRun flat = read_gcode(gcode_of(two_strokes({5, 1}, {5, 2}), {}, printer));
  EXPECT_NEAR(flat.travel_heights_mm[0], 0.2, 1e-9);
}

TEST(Gcode, TheWayFromOneLayerToTheNextIsATravel) {
  Print print = two_strokes({5, 1}, {5, 2});
  print.layers.push_back(print.layers[0]);
  print.layers.push_back(print.layers[0]);
  print.layers[1].index = 1;
  print.layers[2].index = 2;
  print.layers[2].z_mm = 0.5;
  print.planned.push_back({});  // an empty layer is passed over
  print.planned.push_back(print.planned[0]);
  const std::string gcode = gcode_of(print, {}, {});
  const GcodeRun run = read_gcode(gcode);
  EXPECT_NEAR(run.travel_mm, 1 + distance({6, 5}, {1, 1}) + 1, 1e-9);
  EXPECT_EQ(run.retractions, 1);
  ASSERT_EQ(run.travel_heights_mm.size(), 3u);
  EXPECT_NEAR(run.travel_heights_mm[1], 0.6, 1e-9);
  EXPECT_EQ(std::count(run.comments.begin(), run.comments.end(), ";LAYER_CHANGE"), 2);
  EXPECT_EQ(std::count(run.comments.begin(), run.comments.end(), ";Z:0.6"), 1);
  EXPECT_EQ(std::count(run.comments.begin(), run.comments.end(), ";HEIGHT:0.2"), 2);
}

TEST(Gcode, MarksWhatEachStrokeIs) {
  Print print = two_strokes({5, 1}, {5, 2});
  // Around the first island: the outermost wall, the one inside it, dense and sparse lines.
  const auto loop = [](double inset) {
    Ring ring = test::rectangle(inset, inset, 10 - inset, 10 - inset);
    ring.push_back(ring.front());
    return Stroke{ring, 0.45};
  };
  print.planned[0].route.strokes = {
      loop(0.225), loop(0.632), {{{2, 2}, {3, 2}}, 0.45}, {{{2, 3}, {3, 3}}, 0.6}};
  print.planned[0].kinds = {StrokeKind::kWall, StrokeKind::kWall, StrokeKind::kDense,
                            StrokeKind::kSparse};
  std::vector<std::string> marks;
  for (const std::string& comment : read_gcode(gcode_of(print, {}, {})).comments)
    if (comment.starts_with(";TYPE:") || comment.starts_with(";WIDTH:")) marks.push_back(comment);
  EXPECT_EQ(marks, (std::vector<std::string>{";TYPE:External perimeter", ";WIDTH:0.45",
                                             ";TYPE:Perimeter", ";TYPE:Solid infill",
                                             ";TYPE:Internal infill", ";WIDTH:0.6"}));
}

TEST(Gcode, MovesThatVanishAreDroppedAndVeryShortOnesStillPush) {
  Print print = two_strokes({5, 1}, {5, 2});
  Stroke& stroke = print.planned[0].route.strokes[0];
  stroke.points = {{1, 1}, {1, 1}, {1 + 1e-9, 1}, {2, 1}};
  for (int i = 1; i <= 5000; ++i) stroke.points.push_back({2, 1 + i * 0.0005});
  const std::string gcode = gcode_of(print, {}, {});
  const GcodeRun run = read_gcode(gcode);
  ASSERT_EQ(run.strokes.size(), 2u) << "a move without E would split the stroke";
  EXPECT_EQ(run.strokes[0].size(), 2u + 5000u);
  const double share = section_mm2(0.45) / (std::numbers::pi * 1.75 * 1.75 / 4);
  EXPECT_NEAR(run.filament_mm, share * run.extrude_mm, 1e-3 * share * run.extrude_mm);
  EXPECT_EQ(gcode.find("-0 "), gcode.npos);
  EXPECT_EQ(gcode.find("E0 "), gcode.npos);
}

TEST(Gcode, TheHeadTellsWhatItIs) {
  std::ostringstream out;
  const std::vector<std::string> comments = {"model = a\nG28\rb"};
  GcodeWriter(out, {}, {}, comments).finish();
  const std::string text = out.str();
  EXPECT_TRUE(text.starts_with("; generated by routebench "));
  EXPECT_NE(text.find("\n; model = a G28 b\n"), text.npos) << "a comment cannot become a command";
  EXPECT_NE(text.find("\n; task.line_width_mm = 0.45\n"), text.npos);
  EXPECT_NE(text.find("\n; printer.retract_over_mm = 2\n"), text.npos);
  EXPECT_NE(text.find("\nM83"), text.npos);
}

Printer printer_of(const std::string& flavour) {
  Printer printer;
  set_printer_value(printer, "flavour", flavour);
  return printer;
}

TEST(Gcode, EveryFlavourSaysTheSameInItsWay) {
  const Print print = random_print(4);
  const GcodeRun marlin = read_gcode(gcode_of(print, {}, {}));
  for (const std::string flavour : {"klipper", "reprap", "ultigcode"}) {
    const std::string text = gcode_of(print, {}, printer_of(flavour));
    const GcodeRun run = read_gcode(text);
    EXPECT_EQ(run.strokes, marlin.strokes) << flavour;
    EXPECT_EQ(run.stroke_z_mm, marlin.stroke_z_mm) << flavour;
    EXPECT_EQ(run.retractions, marlin.retractions) << flavour;
    EXPECT_EQ(run.travel_mm, marlin.travel_mm) << flavour;
    EXPECT_NEAR(run.pulled_mm, 0, 1e-9) << flavour;
    const bool volumes = flavour == "ultigcode";
    const double unit = volumes ? 1 / (std::numbers::pi * 1.75 * 1.75 / 4) : 1;
    EXPECT_NEAR(run.filament_mm * unit, marlin.filament_mm, 1e-6 * marlin.filament_mm) << flavour;
    EXPECT_EQ(text.starts_with(";FLAVOR:UltiGCode\n"), volumes) << flavour;
    EXPECT_EQ(text.find("\nM83") == text.npos, volumes) << "E's mode is said: " << flavour;
    EXPECT_EQ(text.find("\nM82") == text.npos, !volumes) << flavour;
  }
}

TEST(Gcode, TheFanRunsAboveTheFirstLayer) {
  const std::string text = gcode_of(random_print(2), {}, {});
  const GcodeRun run = read_gcode(text);
  EXPECT_EQ(run.fan_changes, (std::vector<std::string>{"M107", "M106 S", "M107"}));
  const std::size_t fan = text.find("M106 S255"), first = text.find(";LAYER_CHANGE");
  const std::size_t second = text.find(";LAYER_CHANGE", first + 1);
  EXPECT_GT(fan, second);
  EXPECT_LT(fan, text.find("\nG1", second));
  // A print of one layer is never cooled.
  EXPECT_EQ(gcode_of(two_strokes({5, 1}, {5, 2}), {}, {}).find("M106"), text.npos);
}

TEST(Gcode, PointsNearABoundaryAreThoseThatAGridOfEdgesFinds) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Polygons polygons = test::random_polygons(seed, 8, 30);
    const EdgeGrid edges(polygons);
    const Box2 box = bounding_box(polygons);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> x(box.lower.x - 1, box.upper.x + 1);
    std::uniform_real_distribution<double> y(box.lower.y - 1, box.upper.y + 1);
    std::uniform_real_distribution<double> limit(0.01, 1);
    std::vector<NearQuery> queries;
    for (int i = 0; i < 500; ++i) queries.push_back({{x(random), y(random)}, limit(random)});
    const std::vector<bool> near = near_boundary(polygons, queries);
    for (std::size_t i = 0; i < queries.size(); ++i)
      EXPECT_EQ(near[i],
                edges.distance_to_edge_mm(queries[i].point, queries[i].limit_mm) != std::nullopt);
    EXPECT_TRUE(std::ranges::find(near, true) != near.end());
    EXPECT_TRUE(std::ranges::find(near, false) != near.end());
  }
}

TEST(Gcode, BytesDependNeitherOnTheLoopNorOnTheCalls) {
  const ParallelFor backwards = [](std::size_t count, const auto& body) {
    for (std::size_t i = count; i-- > 0;) body(i);
  };
  for (const char* flavour : {"marlin", "ultigcode"}) {
    Print print = random_print(5, 150);
    print.planned[3] = {};  // a layer without strokes
    std::vector<RoutedLayer> layers;
    for (std::size_t i = 0; i < print.layers.size(); ++i)
      layers.push_back({&print.layers[i], &print.planned[i]});
    const auto text = [&](std::size_t layers_a_call, const ParallelFor& parallel_for) {
      std::ostringstream out;
      GcodeWriter writer(out, {}, printer_of(flavour), {});
      const std::span<const RoutedLayer> all = layers;
      for (std::size_t i = 0; i < all.size(); i += layers_a_call)
        writer.write_layers(all.subspan(i, std::min(layers_a_call, all.size() - i)), parallel_for);
      writer.finish();
      return std::move(out).str();
    };
    const std::string serial = text(layers.size(), serial_for);
    EXPECT_TRUE(serial == text(1, serial_for)) << flavour;
    EXPECT_TRUE(serial == text(layers.size(), backwards)) << flavour;
    EXPECT_TRUE(serial == text(100, parallel_loop(3))) << flavour;
  }
}

TEST(Gcode, TheEndLiftsTheNozzleAndStopsTheMotors) {
  const auto end_of_file = [](const std::string& flavour) {
    const std::string text = gcode_of(two_strokes({5, 1}, {5, 2}), {}, printer_of(flavour));
    return text.substr(text.find("; end of the print\n"));
  };
  const std::string lift = "; end of the print\nG1 Z5.2 F9000\n";
  EXPECT_EQ(end_of_file("marlin"), lift + "M107\nM84 ; motors off\n");
  EXPECT_EQ(end_of_file("reprap"), lift + "M106 S0\nM84 ; motors off\n");
  EXPECT_EQ(end_of_file("ultigcode"), lift + "M107\n");
}

TEST(Gcode, AFlavourThatIsNotWrittenIsRefused) {
  std::ostringstream out;
  Printer printer;
  printer.flavour = "abc";
  EXPECT_THROW(GcodeWriter(out, {}, printer, {}), Error);
  EXPECT_TRUE(out.str().empty());
}

TEST(FixedPoint, AgreesWithThePrinterOfTheLibrary) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> value(-2000, 2000);
  for (int i = 0; i < 20000; ++i) {
    const int decimals = i % 8;
    // Numbers that are exact decimals up to the last place: no tie can be broken either way.
    const std::int64_t units = std::llrint(value(random) * 1000);
    std::string text;
    append_units(text, units, decimals);
    char expected[64];
    std::snprintf(expected, sizeof expected, "%.*f", decimals,
                  static_cast<double>(units) / std::pow(10, decimals));
    EXPECT_DOUBLE_EQ(std::stod(text), std::stod(expected));
    if (decimals > 0 && text.find('.') != text.npos) {
      EXPECT_NE(text.back(), '0');
    }
  }
}

TEST(FixedPoint, HandlesTheEdges) {
  const auto text_of = [](double value, int decimals) {
    std::string text;
    append_fixed(text, value, decimals);
    return text;
  };
  EXPECT_EQ(text_of(-0.0000001, 5), "0");
  EXPECT_EQ(text_of(-0.0, 7), "0");
  EXPECT_EQ(text_of(0.00001, 5), "0.00001");
  EXPECT_EQ(text_of(-0.5, 1), "-0.5");
  EXPECT_EQ(text_of(100, 3), "100");
  EXPECT_EQ(text_of(-1200.25, 3), "-1200.25");
  std::string lowest;
  append_units(lowest, std::numeric_limits<std::int64_t>::min(), 3);
  EXPECT_EQ(lowest, "-9223372036854775.808");
}

}  // namespace
}  // namespace routebench
