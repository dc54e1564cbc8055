/// Solids of revolution.

#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <vector>

#include "shapes/shapes.hpp"

namespace routebench::shapes {
namespace {

/// How finely a surface is cut: pieces for a length.
struct Fineness {
  double edge_mm;
  [[nodiscard]] std::size_t pieces(double length_mm, std::size_t fewest) const {
    return std::max(fewest, static_cast<std::size_t>(std::ceil(length_mm / edge_mm)));
  }
  /// Pieces of a whole turn: a multiple of four, so that the solid is as wide as its diameter.
  [[nodiscard]] std::size_t turn(double radius_mm) const {
    return (pieces(2 * std::numbers::pi * radius_mm, 12) + 3) / 4 * 4;
  }
};

/// The longest edge for which `count` gives at least the wanted number of triangles.
Fineness fineness_for(std::size_t triangles, double longest_mm,
                      const std::function<std::size_t(Fineness)>& count) {
  double fine = longest_mm / 1e5;
  double coarse = longest_mm;
  if (count({coarse}) >= triangles) return {coarse};
  for (int i = 0; i < 60; ++i) {
    const double middle = std::sqrt(fine * coarse);
    (count({middle}) >= triangles ? fine : coarse) = middle;
  }
  return {fine};
}

/// Where a profile meets the half plane at angle 0: distance from the axis and height.
struct ProfilePoint {
  double radius;
  double z;
};

/// Turns a profile about the axis (centre, centre). The profile runs with the material on its left
/// when radius points right and z up; it begins and ends on the axis or, if `loop`, closes itself.
Mesh revolve(const std::vector<ProfilePoint>& profile, bool loop, std::size_t turn, double centre) {
  const auto around = static_cast<std::uint32_t>(turn);
  Mesh mesh;
  std::vector<std::uint32_t> first;  // vertex of each profile point at angle 0
  for (const ProfilePoint& p : profile) {
    first.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
    const std::uint32_t copies = p.radius == 0 ? 1 : around;
    for (std::uint32_t i = 0; i < copies; ++i) {
      const double angle = 2 * std::numbers::pi * i / around;
      mesh.vertices.push_back(
          {centre + p.radius * std::cos(angle), centre + p.radius * std::sin(angle), p.z});
    }
  }
  const auto vertex = [&](std::size_t p, std::uint32_t i) {
    return profile[p].radius == 0 ? first[p] : first[p] + i % around;
  };
  const std::size_t spans = loop ? profile.size() : profile.size() - 1;
  for (std::size_t p = 0; p < spans; ++p) {
    const std::size_t q = (p + 1) % profile.size();
    for (std::uint32_t i = 0; i < around; ++i) {
      if (profile[p].radius != 0) {
        mesh.triangles.push_back({vertex(p, i), vertex(p, i + 1), vertex(q, i)});
      }
      if (profile[q].radius != 0) {
        mesh.triangles.push_back({vertex(q, i), vertex(p, i + 1), vertex(q, i + 1)});
      }
    }
  }
  return mesh;
}

/// Triangles that revolve() makes of a profile of so many spans.
std::size_t revolved_triangles(std::size_t spans, bool loop, std::size_t turn) {
  return (loop ? 2 * spans : 2 * spans - 2) * turn;
}

}  // namespace

Mesh make_cylinder(ShapeQuery& query) {
  const double radius = query.mm("diameter", 20) / 2;
  const double height = query.mm("height", 20);
  const auto segments = static_cast<std::size_t>(query.count("segments", 0, 3, 10'000'000));
  const std::size_t triangles = query.triangles(segments > 0 ? 0 : 1024);
  query.finish();
  if (segments > 0) {
    if (triangles > 0) query.refuse("segments and triangles exclude each other");
    return revolve({{0, 0}, {radius, 0}, {radius, height}, {0, height}}, false, segments, radius);
  }
  const Fineness fine = fineness_for(triangles, std::max(2 * radius, height), [&](Fineness f) {
    const std::size_t spans = 2 * f.pieces(radius, 1) + f.pieces(height, 1);
    return revolved_triangles(spans, false, f.turn(radius));
  });
  const std::size_t out = fine.pieces(radius, 1);
  const std::size_t up = fine.pieces(height, 1);
  const auto part = [](double whole, std::size_t i, std::size_t of) {
    return whole * (static_cast<double>(i) / static_cast<double>(of));
  };
  std::vector<ProfilePoint> profile;
  for (std::size_t i = 0; i < out; ++i) profile.push_back({part(radius, i, out), 0});
  for (std::size_t i = 0; i < up; ++i) profile.push_back({radius, part(height, i, up)});
  for (std::size_t i = 0; i <= out; ++i) profile.push_back({part(radius, out - i, out), height});
  return revolve(profile, false, fine.turn(radius), radius);
}

Mesh make_sphere(ShapeQuery& query) {
  const double radius = query.mm("diameter", 20) / 2;
  const std::size_t triangles = query.triangles(4096);
  query.finish();
  const auto spans_of = [&](Fineness f) { return f.pieces(std::numbers::pi * radius, 4); };
  const Fineness fine = fineness_for(triangles, 2 * radius, [&](Fineness f) {
    return revolved_triangles(spans_of(f), false, f.turn(radius));
  });
  const std::size_t spans = spans_of(fine);
  std::vector<ProfilePoint> profile;
  for (std::size_t i = 0; i <= spans; ++i) {
    const double angle = std::numbers::pi * (static_cast<double>(i) / static_cast<double>(spans));
    const bool pole = i == 0 || i == spans;
    profile.push_back({pole ? 0 : radius * std::sin(angle), radius - radius * std::cos(angle)});
  }
  return revolve(profile, false, fine.turn(radius), radius);
}

Mesh make_torus(ShapeQuery& query) {
  const double diameter = query.mm("diameter", 30);
  const double tube = query.mm("tube", 10) / 2;
  const std::size_t triangles = query.triangles(4096);
  query.finish();
  if (!(diameter > 4 * tube)) {
    query.refuse("the tube must be thinner than half of the diameter");
  }
  const double outer = diameter / 2;
  const Fineness fine = fineness_for(triangles, diameter, [&](Fineness f) {
    return revolved_triangles(f.turn(tube), true, f.turn(outer));
  });
  const std::size_t spans = fine.turn(tube);
  std::vector<ProfilePoint> profile;
  for (std::size_t i = 0; i < spans; ++i) {
    const double angle =
        2 * std::numbers::pi * (static_cast<double>(i) / static_cast<double>(spans));
    profile.push_back({outer - tube + tube * std::cos(angle), tube + tube * std::sin(angle)});
  }
  return revolve(profile, true, fine.turn(outer), outer);
}

}  // namespace routebench::shapes
