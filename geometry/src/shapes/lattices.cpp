/// Lattices: thin walls and struts that fill a box.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "shapes/isosurface.hpp"
#include "shapes/random.hpp"
#include "shapes/shapes.hpp"

namespace routebench::shapes {
namespace {

Point3 box_of(ShapeQuery& query, double by_default) {
  const double x = query.mm("x", by_default);
  const double y = query.mm("y", by_default);
  return {x, y, query.mm("z", by_default)};
}

/// Details must not be so much smaller than the box that nobody could hold the mesh.
void refuse_too_fine(const ShapeQuery& query, const Point3& box, double detail_mm) {
  constexpr double kMostDetails = 1e7;
  if (box.x * box.y * box.z / (detail_mm * detail_mm * detail_mm) > kMostDetails) {
    query.refuse("walls or struts too thin for such a large box");
  }
}

double squared_distance(const Point3& a, const Point3& b) {
  return (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y) + (a.z - b.z) * (a.z - b.z);
}

/// Random sites, one in each cell of a grid that reaches over the box, and quick answers to how far
/// the three nearest are.
class Sites {
 public:
  Sites(const Point3& box, double cell, std::uint64_t seed) : cell_(cell) {
    constexpr double kMargin = 2;  // cells beyond the box on every side
    const auto along = [&](double length) {
      return static_cast<std::size_t>(std::ceil(length / cell) + 2 * kMargin);
    };
    counts_ = {along(box.x), along(box.y), along(box.z)};
    Random random(seed);
    for (std::size_t k = 0; k < counts_[2]; ++k) {
      for (std::size_t j = 0; j < counts_[1]; ++j) {
        for (std::size_t i = 0; i < counts_[0]; ++i) {
          const auto at = [&](std::size_t n) {
            return (static_cast<double>(n) - kMargin + random.between(0.1, 0.9)) * cell;
          };
          const double x = at(i);
          const double y = at(j);
          sites_.push_back({x, y, at(k)});
        }
      }
    }
    offset_ = kMargin;
    find_candidates();
  }

  /// Distances of the three nearest sites, nearest first.
  [[nodiscard]] std::array<double, 3> nearest(const Point3& p) const {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    std::array<double, 3> best{kFar, kFar, kFar};
    for (const std::uint32_t site : candidates_[cell_of(p)]) {
      const double d = squared_distance(p, sites_[site]);
      if (d >= best[2]) continue;
      best[2] = d;
      if (best[2] < best[1]) std::swap(best[1], best[2]);
      if (best[1] < best[0]) std::swap(best[0], best[1]);
    }
    return {std::sqrt(best[0]), std::sqrt(best[1]), std::sqrt(best[2])};
  }

 private:
  [[nodiscard]] std::size_t index(std::size_t i, std::size_t j, std::size_t k) const {
    return (k * counts_[1] + j) * counts_[0] + i;
  }
  [[nodiscard]] std::size_t cell_of(const Point3& p) const {
    const auto along = [&](double at, std::size_t count) {
      const double cell = std::floor(at / cell_ + offset_);
      return std::min(static_cast<std::size_t>(std::max(cell, 0.0)), count - 1);
    };
    return index(along(p.x, counts_[0]), along(p.y, counts_[1]), along(p.z, counts_[2]));
  }

  /// For every cell the sites that can be among the three nearest of some point in it: those whose
  /// least distance from the cell is below the third smallest of the greatest distances.
  void find_candidates() {
    candidates_.resize(sites_.size());
    for (std::size_t k = 0; k < counts_[2]; ++k) {
      for (std::size_t j = 0; j < counts_[1]; ++j) {
        for (std::size_t i = 0; i < counts_[0]; ++i) candidates_[index(i, j, k)] = around(i, j, k);
      }
    }
  }

  [[nodiscard]] std::vector<std::uint32_t> around(std::size_t i, std::size_t j,
                                                  std::size_t k) const {
    struct Reach {
      std::uint32_t site;
      double least;
      double most;
    };
    std::vector<Reach> reaches;
    const auto from = [](std::size_t n) { return n < 2 ? 0 : n - 2; };
    for (std::size_t c = from(k); c <= std::min(k + 2, counts_[2] - 1); ++c) {
      for (std::size_t b = from(j); b <= std::min(j + 2, counts_[1] - 1); ++b) {
        for (std::size_t a = from(i); a <= std::min(i + 2, counts_[0] - 1); ++a) {
          const std::size_t site = index(a, b, c);
          Reach reach{static_cast<std::uint32_t>(site), 0, 0};
          const std::array<std::pair<double, std::size_t>, 3> axes{
              {{sites_[site].x, i}, {sites_[site].y, j}, {sites_[site].z, k}}};
          for (const auto& [at, n] : axes) {
            const double low = (static_cast<double>(n) - offset_) * cell_;
            const double high = low + cell_;
            const double gap = std::max({0.0, low - at, at - high});
            const double span = std::max(std::abs(at - low), std::abs(at - high));
            reach.least += gap * gap;
            reach.most += span * span;
          }
          reaches.push_back(reach);
        }
      }
    }
    std::vector<double> most;
    for (const Reach& reach : reaches) most.push_back(reach.most);
    std::nth_element(most.begin(), most.begin() + 2, most.end());
    std::vector<std::uint32_t> sites;
    for (const Reach& reach : reaches) {
      if (reach.least <= most[2]) sites.push_back(reach.site);
    }
    return sites;
  }

  double cell_;
  double offset_ = 0;
  std::array<std::size_t, 3> counts_{};
  std::vector<Point3> sites_;
  std::vector<std::vector<std::uint32_t>> candidates_;
};

}  // namespace

/// A block of the gyroid, a minimal surface, with walls of a given thickness.
Mesh make_gyroid(ShapeQuery& query) {
  const Point3 box = box_of(query, 30);
  const double cell = query.mm("cell", 15, 0.5, 10'000);
  const double wall = query.mm("wall", 1.6);
  const std::size_t triangles = query.triangles(100'000);
  query.finish();
  refuse_too_fine(query, box, wall);
  if (wall > cell / 4) query.refuse("the walls must be thinner than a quarter of the cell");
  const double turns = 2 * std::numbers::pi / cell;
  // Near the surface the function below changes by about 1.5 a radian.
  const double per_mm = 1.5 * turns;
  return isosurface_of(
      triangles,
      [&](const Point3& p) {
        const double x = p.x * turns;
        const double y = p.y * turns;
        const double z = p.z * turns;
        const double gyroid =
            std::sin(x) * std::cos(y) + std::sin(y) * std::cos(z) + std::sin(z) * std::cos(x);
        return wall / 2 - std::abs(gyroid) / per_mm;
      },
      box, wall * 0.75);
}

/// Struts along the edges of random Voronoi cells, with ribs where the cells meet the box.
Mesh make_voronoi(ShapeQuery& query) {
  const Point3 box = box_of(query, 40);
  const double cell = query.mm("cell", 12, 0.5, 10'000);
  const double strut = query.mm("strut", 1.6);
  const std::uint64_t seed = query.seed();
  const std::size_t triangles = query.triangles(100'000);
  query.finish();
  refuse_too_fine(query, box, strut);
  if (strut > cell / 3) query.refuse("the struts must be thinner than a third of the cell");
  constexpr double kMostCells = 2e6;
  if ((box.x / cell + 4) * (box.y / cell + 4) * (box.z / cell + 4) > kMostCells) {
    query.refuse("too many cells: make them larger");
  }
  const Sites sites(box, cell, seed);
  return isosurface_of(
      triangles,
      [&](const Point3& p) {
        const auto [first, second, third] = sites.nearest(p);
        // On an edge of the cells three sites are equally far, on a face of them two.
        const double along_edge = (strut - (third - first)) / 2;
        const double room = std::min({p.x, box.x - p.x, p.y, box.y - p.y, p.z, box.z - p.z});
        const double rib = std::min(strut - room, (strut - (second - first)) / 2);
        return std::max(along_edge, rib);
      },
      box, strut * 0.6);
}

}  // namespace routebench::shapes
