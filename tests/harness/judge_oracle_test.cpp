/// Fast measures against slow and obvious ones.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <span>
#include <vector>

#include "judge/beside.hpp"
#include "judge/cell_field.hpp"
#include "judge/coverage.hpp"
#include "judge/layer_samples.hpp"
#include "judge/outline.hpp"
#include "judge/reach.hpp"
#include "judge/run.hpp"
#include "judge/strays.hpp"
#include "random_polygons.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/harness/judge.hpp"
#include "routes.hpp"

namespace routebench {
namespace {

using std::numbers::pi;

Layer layer_of(Polygons polygons) {
  Layer layer;
  layer.polygons = std::move(polygons);
  return layer;
}

Task dense_task() {
  Task task;
  task.perimeters = 0;
  task.density = 1;
  return task;
}

/// Strokes of a few points each between corners of polygons, hence within their convex hull.
Route random_route(std::uint64_t seed, int strokes, const Polygons& polygons) {
  std::vector<Point2> corners;
  for (const Polygon& polygon : polygons)
    corners.insert(corners.end(), polygon.outer.begin(), polygon.outer.end());
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> share(0, 1);
  std::uniform_real_distribution<double> width(0.3, 0.9);
  const auto corner = [&] { return corners[random() % corners.size()]; };
  Route route;
  for (int i = 0; i < strokes; ++i) {
    Stroke stroke{{}, width(random)};
    for (int k = 0; k < 4; ++k)
      stroke.points.push_back(snap(lerp(corner(), corner(), share(random))));
    route.strokes.push_back(std::move(stroke));
  }
  return route;
}

/// Beads as polygons with many-cornered ends, united.
Polygons beads_by_clipping(const Route& route) {
  std::vector<Ring> rings;
  for (const Stroke& stroke : route.strokes)
    for (std::size_t i = 1; i < stroke.points.size(); ++i) {
      const Point2 a = stroke.points[i - 1];
      const Point2 b = stroke.points[i];
      const double angle = std::atan2(b.y - a.y, b.x - a.x);
      constexpr int kCorners = 64;
      Ring ring;
      for (const Point2 centre : {a, b})
        for (int k = 0; k <= kCorners; ++k) {
          const double turn = angle + (centre == a ? 0.5 : 1.5) * pi + pi * k / kCorners;
          ring.push_back(
              snap(centre + stroke.width_mm / 2 * Point2{std::cos(turn), std::sin(turn)}));
        }
      rings.push_back(std::move(ring));
    }
  return polygons_from_rings(std::move(rings), FillRule::kNonZero);
}

TEST(JudgeOracle, CoverageAgreesWithClipping) {
  const Task task = dense_task();
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    const Layer layer = layer_of(test::random_polygons(seed, 6, 20));
    const Route route = random_route(seed, 25, layer.polygons);
    const Scores scores =
        Judge(task, {}).score(layer, demand_of(layer, task), route, std::nullopt).scores;
    const Polygons beads = beads_by_clipping(route);
    const double area = area_mm2(layer.polygons);
    EXPECT_NEAR(*scores[metric_index("covered")], area_mm2(intersect(beads, layer.polygons)) / area,
                1e-3);
    const Polygons grown = offset(layer.polygons, task.line_width_mm / 2, Join::kRound);
    EXPECT_NEAR(*scores[metric_index("spilled")], area_mm2(subtract(beads, grown)) / area, 2e-3);
  }
}

TEST(JudgeOracle, LinesAlongTheAxesDoNotBeatWithTheSamples) {
  // Lines along the walls of a box, any distance apart, any phase: the case in which samples along
  // the axes are wrong by percents.
  const Task task = dense_task();
  const Layer layer = layer_of({{test::rectangle(0, 0, 20, 20), {}}});
  const Demand demand = demand_of(layer, task);
  for (const double distance : {0.45, 0.5, 0.55, 0.6}) {
    Route route;
    for (double y = 0.4; y < 19.6; y += distance)
      route.strokes.push_back({{{-1, y}, {21, y}}, 0.45});
    const double exact =
        20 * 0.45 * static_cast<double>(route.strokes.size()) / area_mm2(layer.polygons);
    const Scores scores = Judge(task, {}).score(layer, demand, route, std::nullopt).scores;
    EXPECT_NEAR(*scores[metric_index("covered")], exact, 3e-4) << distance;
  }
}

/// Number of stretches of a run that stay within `radius` of a point, by its definition.
int passes_at(const judging::Run& run, Point2 p, double radius) {
  int passes = 0;
  bool inside = false;
  bool inside_at_begin = false;
  bool first = true;
  for (std::size_t i = 0; i + 1 < run.points.size(); ++i) {
    constexpr int kPieces = 60;
    for (int k = 0; k <= kPieces; ++k) {
      const Point2 at = lerp(run.points[i], run.points[i + 1], static_cast<double>(k) / kPieces);
      const bool now = distance(at, p) < radius;
      if (now && !inside) ++passes;
      if (first) inside_at_begin = now;
      first = false;
      inside = now;
    }
  }
  if (run.loop && inside && inside_at_begin && passes > 1) --passes;
  return passes;
}

TEST(JudgeOracle, DoubledAgreesWithCountingPassesAtPoints) {
  const Task task = dense_task();
  const Layer layer = layer_of({{test::rectangle(0, 0, 6, 6), {}}});
  const Demand demand = demand_of(layer, task);
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    Route route = random_route(seed, 3, layer.polygons);
    for (Stroke& stroke : route.strokes) stroke.width_mm = 0.8;
    route.strokes[0].points.push_back(route.strokes[0].points.front());  // a loop
    const std::vector<judging::Run> runs = judging::runs_of(route, task.join_mm);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> place(-1, 7);
    const int draws = 2000;
    int doubled = 0;
    for (int i = 0; i < draws; ++i) {
      const Point2 p{place(random), place(random)};
      int passes = 0;
      for (const judging::Run& run : runs) passes += passes_at(run, p, task.mean_width_mm(0.8) / 2);
      if (passes >= 2) ++doubled;
    }
    const double exact = 64.0 * doubled / draws / 36;
    const double error = 64.0 / 36 * std::sqrt(doubled) / draws;  // of drawing by lot
    const double measured =
        *Judge(task, {}).score(layer, demand, route, std::nullopt).scores[metric_index("doubled")];
    EXPECT_NEAR(measured, exact, 4 * error + 0.002);
  }
}

TEST(JudgeOracle, CrossingsAgreeWithEveryEdge) {
  const Task task = dense_task();
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    const Layer layer = layer_of(test::random_polygons(seed));
    const Route route = random_route(seed, 40, layer.polygons);
    // Outside length of each travel: cut at every edge, ask the middle of each piece by the parity
    // of edges to its right.
    std::vector<std::pair<Point2, Point2>> edges;
    for (const Polygon& polygon : layer.polygons) {
      std::vector<Ring> rings = polygon.holes;
      rings.push_back(polygon.outer);
      for (const Ring& ring : rings)
        for (std::size_t i = 0; i < ring.size(); ++i)
          edges.emplace_back(ring[i], ring[(i + 1) % ring.size()]);
    }
    double outside = 0;
    int crossings = 0;
    for (std::size_t s = 1; s < route.strokes.size(); ++s) {
      const Point2 a = route.strokes[s - 1].points.back();
      const Point2 b = route.strokes[s].points.front();
      std::vector<double> cuts{0, 1};
      for (const auto& [c, d] : edges) {
        const double along = cross(b - a, d - c);
        const double t = cross(c - a, d - c) / along;
        const double u = cross(c - a, b - a) / along;
        if (t > 0 && t < 1 && u >= 0 && u <= 1) cuts.push_back(t);
      }
      std::ranges::sort(cuts);
      double here = 0;
      for (std::size_t i = 1; i < cuts.size(); ++i) {
        const Point2 p = lerp(a, b, (cuts[i - 1] + cuts[i]) / 2);
        bool inside = false;
        for (const auto& [c, d] : edges)
          if ((c.y > p.y) != (d.y > p.y) && p.x < c.x + (p.y - c.y) / (d.y - c.y) * (d.x - c.x))
            inside = !inside;
        if (!inside) here += (cuts[i] - cuts[i - 1]) * distance(a, b);
      }
      outside += here;
      crossings += here > 1e-5 ? 1 : 0;
    }
    const Scores scores =
        Judge(task, {}).score(layer, demand_of(layer, task), route, std::nullopt).scores;
    EXPECT_NEAR(*scores[metric_index("travel_outside_mm")], outside, 1e-3);
    EXPECT_EQ(*scores[metric_index("crossings")], crossings);
    EXPECT_GT(crossings, 10);
  }
}

TEST(JudgeOracle, OutlineCoveredAgreesWithEveryStroke) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Polygons polygons = test::random_polygons(seed, 5, 15);
    const std::vector<judging::Run> runs = judging::runs_of(random_route(seed, 10, polygons), 0.01);
    double reached = 0;
    double all = 0;
    for (const Polygon& polygon : polygons) {
      std::vector<Ring> rings = polygon.holes;
      rings.push_back(polygon.outer);
      for (const Ring& ring : rings)
        for (std::size_t i = 0; i < ring.size(); ++i) {
          const Point2 a = ring[i];
          const Point2 b = ring[(i + 1) % ring.size()];
          const int pieces = 1 + static_cast<int>(distance(a, b) / 0.02);
          for (int k = 0; k < pieces; ++k) {
            const Point2 p = lerp(a, b, (k + 0.5) / pieces);
            double nearest = std::numeric_limits<double>::infinity();
            judging::visit_beads(runs, [&](Point2 c, Point2 d, double) {
              nearest = std::min(nearest, distance(p, nearest_on_segment(p, c, d)));
            });
            all += distance(a, b) / pieces;
            if (nearest <= 0.45) reached += distance(a, b) / pieces;
          }
        }
    }
    EXPECT_NEAR(*judging::outline_covered(polygons, runs, 0.45), reached / all, 0.003);
  }
}

TEST(JudgeOracle, OnlyOutlinesInReachAreSurelyReached) {
  // Walls, as they should be and with the end of one cut off: what is said to be in reach must be
  // so at every point; what is cut off is seldom made up for.
  std::mt19937_64 random(11);
  int sure = 0;
  int left = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const Polygons polygons = test::random_polygons(seed, 5, 15);
    const Route walls = test::loops(offset(polygons, -0.03), 0.45);
    for (const bool whole : {true, false}) {
      Route route = walls;
      if (!whole) {
        Stroke& stroke = route.strokes[random() % route.strokes.size()];
        stroke.points.resize(1 + random() % stroke.points.size());
      }
      const std::vector<judging::Run> runs = judging::runs_of(route, 0.01);
      if (!judging::is_surely_reached(polygons, runs, 0.45)) {
        ++left;
        continue;
      }
      ++sure;
      const auto check_ring = [&](const Ring& ring) {
        for (std::size_t i = 0; i < ring.size(); ++i)
          for (double share = 0; share < 1; share += 1.0 / 64) {
            const Point2 p = lerp(ring[i], ring[(i + 1) % ring.size()], share);
            double nearest = std::numeric_limits<double>::infinity();
            judging::visit_beads(runs, [&](Point2 a, Point2 b, double) {
              nearest = std::min(nearest, distance(p, nearest_on_segment(p, a, b)));
            });
            EXPECT_LE(nearest, 0.45) << seed;
          }
      };
      for (const Polygon& polygon : polygons) {
        check_ring(polygon.outer);
        for (const Ring& hole : polygon.holes) check_ring(hole);
      }
    }
  }
  EXPECT_GT(sure, 10);
  EXPECT_GT(left, 10);
}

TEST(JudgeOracle, AveragesAgreeWithTheirDefinition) {
  std::mt19937_64 random(11);
  for (const std::size_t reach : {1U, 2U, 3U, 5U, 40U}) {
    const std::size_t columns = 17;
    const std::size_t rows = 9;
    judging::CellField field(columns, rows);
    std::vector<std::vector<double>> plain(rows, std::vector<double>(columns));
    for (std::size_t r = 0; r < rows; ++r)
      for (std::size_t c = 0; c < columns; ++c) {
        plain[r][c] = static_cast<double>(random() % 100);
        field.at(c, r) = static_cast<float>(plain[r][c]);
      }
    // All cells of a row, some or none.
    std::vector<judging::Columns> wanted;
    for (std::size_t r = 0; r < rows; ++r) {
      const auto [first, end] = std::minmax({static_cast<std::size_t>(random() % columns),
                                             static_cast<std::size_t>(random() % columns)});
      wanted.push_back(r % 3 == 0 ? judging::Columns{0, columns} : judging::Columns{first, end});
    }
    judging::NeighbourhoodMeans means(field, reach, wanted);
    const auto weight = [reach](std::size_t i, std::size_t k) {
      const double d = std::abs(static_cast<double>(i) - static_cast<double>(k));
      return std::max(0.0, static_cast<double>(reach) - d) / static_cast<double>(reach * reach);
    };
    for (std::size_t r = 0; r < rows; ++r) {
      const std::span<const float> row = means.row(r);
      ASSERT_EQ(row.size(), wanted[r].end - wanted[r].first);
      for (std::size_t c = wanted[r].first; c < wanted[r].end; ++c) {
        double mean = 0;
        for (std::size_t i = 0; i < rows; ++i)
          for (std::size_t k = 0; k < columns; ++k)
            mean += weight(r, i) * weight(c, k) * plain[i][k];
        EXPECT_NEAR(static_cast<double>(row[c - wanted[r].first]), mean, 1e-4);
      }
    }
  }
}

TEST(JudgeOracle, StraysAloneAreHollowOrSpilled) {
  Task task;
  task.density = 1;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    const Layer layer = layer_of(test::random_polygons(seed, 5, 20));
    const Demand demand = demand_of(layer, task);
    // Walls, one of them too wide, and strokes from corner to corner.
    Route route = random_route(seed, 10, layer.polygons);
    test::append(route, test::walls(layer.polygons, task));
    route.strokes.back().width_mm *= 1.5;
    const std::vector<judging::Run> runs = judging::runs_of(route, task.join_mm);
    const EdgeGrid outline(layer.polygons);
    const judging::Strays strays = judging::strays_of(runs, outline, task.line_width_mm);
    double hollow = 0;
    std::vector<judging::Bead> all;
    judging::visit_beads(runs, [&](Point2 a, Point2 b, double width_mm) {
      hollow += outline.outside_length_mm(a, b);
      all.push_back({a, b, width_mm});
    });
    EXPECT_EQ(strays.hollow_mm, hollow);
    EXPECT_GT(hollow, 0);
    EXPECT_LT(strays.beads.size(), all.size());
    const judging::LayerSamples samples(demand, task);
    const auto measure = [&](const std::vector<judging::Bead>& beads) {
      return judging::measure_coverage(samples, samples.outline.count(), demand, runs, beads, task);
    };
    EXPECT_EQ(measure(strays.beads).spilled, measure(all).spilled);
  }
}

TEST(JudgeOracle, SparseReachAgreesWithPoints) {
  const Task task;
  const double reach = task.spacing_mm() / task.density;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    const Layer layer = layer_of(test::random_polygons(seed, 4, 40));
    const Demand demand = demand_of(layer, task);
    // So much that all is in reach, or so few lines that it is not.
    const bool plenty = seed % 2 == 0;
    Route route = test::lines(demand.sparse, {(plenty ? 0.5 : 3) * reach, 0.3}, task.line_width_mm);
    if (plenty) test::append(route, test::loops(demand.sparse, task.line_width_mm));
    const std::vector<judging::Run> runs = judging::runs_of(route, task.join_mm);
    const judging::LayerSamples samples(demand, task);
    ASSERT_GT(samples.sparse.count(), 0U);
    const double share =
        judging::sparse_share_reached(samples, samples.sparse.count(), demand.sparse, runs, task);
    const EdgeGrid part(demand.sparse);
    const Box2 box = bounding_box(demand.sparse);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> x(box.lower.x, box.upper.x);
    std::uniform_real_distribution<double> y(box.lower.y, box.upper.y);
    int points = 0;
    int reached = 0;
    for (int i = 0; i < 20000; ++i) {
      const Point2 p{x(random), y(random)};
      if (!part.contains(p)) continue;
      double nearest = std::numeric_limits<double>::infinity();
      judging::visit_beads(runs, [&](Point2 a, Point2 b, double) {
        nearest = std::min(nearest, distance(p, nearest_on_segment(p, a, b)));
      });
      ++points;
      reached += nearest <= reach ? 1 : 0;
      // What is all in reach to the samples is so to the point, but for what they slip through.
      if (share == 1) {
        EXPECT_LE(nearest, reach + reach / 16);
      }
    }
    EXPECT_EQ(share == 1, plenty);
    const double exact = static_cast<double>(reached) / points;
    const double error = std::sqrt(exact * (1 - exact) / points);  // of drawing by lot
    EXPECT_NEAR(share, exact, 4 * error + 1e-3);
  }
}

}  // namespace
}  // namespace routebench
