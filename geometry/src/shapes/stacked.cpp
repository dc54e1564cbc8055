#include "shapes/stacked.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "model/triangulate.hpp"
#include "shapes/subdivide.hpp"

namespace routebench::shapes {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

class Stack {
 public:
  explicit Stack(const std::vector<Wall>& walls) : walls_(walls) {}

  Mesh run() {
    std::set<double> heights;
    for (const Wall& wall : walls_) {
      heights.insert({wall.lower_mm, wall.upper_mm});
      add_wall(wall);
    }
    for (const double height : heights) close(height);
    return std::move(mesh_);
  }

 private:
  void add_wall(const Wall& wall) {
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    const auto count = static_cast<std::uint32_t>(wall.ring.size());
    first_.push_back(first);
    for (const double z : {wall.lower_mm, wall.upper_mm}) {
      for (const Point2 p : wall.ring) mesh_.vertices.push_back({p.x, p.y, z});
    }
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t below = first + i;
      const std::uint32_t next = first + (i + 1) % count;
      mesh_.triangles.push_back({below, next, next + count});
      mesh_.triangles.push_back({below, next + count, below + count});
    }
  }

  /// Adds the floors and ceilings at a height: the area between the rings that begin or end there.
  void close(double height) {
    std::vector<Point2> points;
    std::vector<std::uint32_t> vertex_of;
    std::vector<std::vector<std::uint32_t>> rings;
    std::map<std::pair<std::uint32_t, std::uint32_t>, bool> ends;  // directed sides of the rings
    for (std::size_t w = 0; w < walls_.size(); ++w) {
      const Wall& wall = walls_[w];
      if (wall.lower_mm != height && wall.upper_mm != height) continue;
      const bool ending = wall.upper_mm == height;
      const auto count = static_cast<std::uint32_t>(wall.ring.size());
      std::vector<std::uint32_t>& ring = rings.emplace_back();
      for (std::uint32_t i = 0; i < count; ++i) {
        ring.push_back(static_cast<std::uint32_t>(points.size()));
        points.push_back(wall.ring[i]);
        vertex_of.push_back(first_[w] + i + (ending ? count : 0));
      }
      for (std::uint32_t i = 0; i < count; ++i) ends[{ring[i], ring[(i + 1) % count]}] = ending;
    }
    const std::vector<Triangle> area = models::triangulate_area(points, rings);
    const std::vector<std::uint8_t> up = faces_up(area, ends);
    for (std::size_t t = 0; t < area.size(); ++t) {
      Triangle triangle{vertex_of[area[t][0]], vertex_of[area[t][1]], vertex_of[area[t][2]]};
      if (up[t] == 0) std::swap(triangle[1], triangle[2]);
      mesh_.triangles.push_back(triangle);
    }
  }

  /// Tells ceilings from floors: on the left of a wall that ends, and on the right of one that
  /// begins, the material is below. What lies between is as its neighbours are.
  static std::vector<std::uint8_t> faces_up(
      const std::vector<Triangle>& area,
      const std::map<std::pair<std::uint32_t, std::uint32_t>, bool>& ends) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> left_of;  // directed side
    for (std::size_t t = 0; t < area.size(); ++t) {
      for (std::size_t c = 0; c < 3; ++c) left_of[{area[t][c], area[t][(c + 1) % 3]}] = t;
    }
    constexpr std::uint8_t kUnknown = 2;
    std::vector<std::uint8_t> up(area.size(), kUnknown);
    std::vector<std::size_t> reached;
    const auto reach = [&](std::size_t t, bool is_up) {
      if (up[t] != kUnknown) return;
      up[t] = is_up ? 1 : 0;
      reached.push_back(t);
    };
    for (const auto& [side, ending] : ends) {
      if (const auto left = left_of.find(side); left != left_of.end()) reach(left->second, ending);
      const auto right = left_of.find({side.second, side.first});
      if (right != left_of.end()) reach(right->second, !ending);
    }
    while (!reached.empty()) {
      const std::size_t t = reached.back();
      reached.pop_back();
      for (std::size_t c = 0; c < 3; ++c) {
        const std::pair<std::uint32_t, std::uint32_t> across{area[t][(c + 1) % 3], area[t][c]};
        if (ends.contains(across) || ends.contains({across.second, across.first})) continue;
        if (const auto next = left_of.find(across); next != left_of.end()) {
          reach(next->second, up[t] == 1);
        }
      }
    }
    return up;
  }

  const std::vector<Wall>& walls_;
  std::vector<std::uint32_t> first_;  ///< vertex of each wall
  Mesh mesh_;
};

/// Pieces of a whole turn: a multiple of four, so that a circle is as wide as its diameter.
std::size_t pieces_of_turn(double radius_mm, double arc_mm) {
  constexpr double kFewest = 12;
  constexpr double kMost = 1e6;
  const double pieces = std::clamp(2 * std::numbers::pi * radius_mm / arc_mm, kFewest, kMost);
  return static_cast<std::size_t>(std::ceil(pieces / 4)) * 4;
}

/// Appends the points of a circle from one angle to another, both included, in steps of a turn.
void append_arc(Ring& ring, Point2 centre, double radius, std::size_t from, std::size_t to,
                std::size_t turn) {
  for (std::size_t i = from; i <= to; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(turn);
    ring.push_back({centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)});
  }
}

}  // namespace

Mesh stack(const std::vector<Wall>& walls) { return Stack(walls).run(); }

Mesh refined(std::size_t triangles, double arc_mm, const std::function<Mesh(double)>& build) {
  const auto wanted = static_cast<double>(triangles);
  const auto size_of = [](const Mesh& mesh) { return static_cast<double>(mesh.triangles.size()); };
  // Cutting n times as fine in both ways: half of it by finer arcs.
  double arc = arc_mm / std::sqrt(wanted / size_of(build(arc_mm)));
  Mesh mesh = build(arc);
  const double parts = std::max(1.0, std::round(std::sqrt(wanted / size_of(mesh))));
  arc *= size_of(mesh) * parts * parts / wanted;
  return subdivide(build(arc), static_cast<std::size_t>(parts));
}

Ring circle(Point2 centre, double radius_mm, double arc_mm) {
  const std::size_t turn = pieces_of_turn(radius_mm, arc_mm);
  Ring ring;
  append_arc(ring, centre, radius_mm, 0, turn - 1, turn);
  return ring;
}

Ring rectangle(Point2 lower, Point2 upper) {
  return {lower, {upper.x, lower.y}, upper, {lower.x, upper.y}};
}

Ring rounded_rectangle(Point2 lower, Point2 upper, double radius_mm, double arc_mm) {
  const std::size_t turn = pieces_of_turn(radius_mm, arc_mm);
  const double r = radius_mm;
  Ring ring;
  append_arc(ring, {upper.x - r, upper.y - r}, r, 0, turn / 4, turn);
  append_arc(ring, {lower.x + r, upper.y - r}, r, turn / 4, turn / 2, turn);
  append_arc(ring, {lower.x + r, lower.y + r}, r, turn / 2, turn / 4 * 3, turn);
  append_arc(ring, {upper.x - r, lower.y + r}, r, turn / 4 * 3, turn, turn);
  return ring;
}

Ring reversed(Ring ring) {
  std::reverse(ring.begin(), ring.end());
  return ring;
}

}  // namespace routebench::shapes
