#include "model/face_sink.hpp"

#include <cmath>
#include <utility>

#include "model/triangulate.hpp"
#include "model/vertex_welder.hpp"

namespace routebench::models {
namespace {

/// The largest number that single precision holds, rounded down. Nothing near it can be meant.
constexpr double kLargestCoordinate = 3e38;

bool is_usable_coordinate(double c) noexcept {
  return std::abs(c) <= kLargestCoordinate;  // false for NaN
}

}  // namespace

void FaceSink::reserve(std::size_t vertices, std::size_t faces) {
  raw_.mesh.vertices.reserve(vertices);
  raw_.mesh.triangles.reserve(faces);
}

void FaceSink::add_vertex(const Point3& point) {
  if (raw_.mesh.vertices.size() >= kMostVertices) {
    refuse_model(context_.name,
                 "more than " + std::to_string(kMostVertices) + " vertices are too many");
  }
  raw_.mesh.vertices.push_back(point);
}

bool FaceSink::is_usable(std::uint32_t vertex) const {
  const Point3& p = raw_.mesh.vertices[vertex];
  return is_usable_coordinate(p.x) && is_usable_coordinate(p.y) && is_usable_coordinate(p.z);
}

void FaceSink::refuse_vertex(std::uint32_t vertex, const Place& place) const {
  const Point3& p = raw_.mesh.vertices[vertex];
  const std::size_t axis = !is_usable_coordinate(p.x) ? 0 : !is_usable_coordinate(p.y) ? 1 : 2;
  refuse_model(context_.name,
               "face " + std::to_string(faces_) + " (" + place() + "): the " + "xyz"[axis] +
                   " of vertex " + std::to_string(vertex) + " (counted from 0) is " +
                   rounded(axis == 0   ? p.x
                           : axis == 1 ? p.y
                                       : p.z) +
                   ", but must be a finite number; with --repair such faces are left out");
}

void FaceSink::add_face(std::span<const std::int64_t> corners, const Place& place) {
  ++faces_;
  corners_.clear();
  bool usable = true;
  for (const std::int64_t corner : corners) {
    if (corner < 0 || static_cast<std::uint64_t>(corner) >= vertices()) {
      refuse_model(context_.name, "face " + std::to_string(faces_) + " (" + place() +
                                      ") names vertex " + std::to_string(corner) +
                                      " (counted from 0), but there are only " +
                                      std::to_string(vertices()));
    }
    const auto vertex = static_cast<std::uint32_t>(corner);
    if (!is_usable(vertex)) {
      if (!context_.repair) refuse_vertex(vertex, place);
      usable = false;
    }
    corners_.push_back(vertex);
  }
  if (corners_.size() < 3) return;
  if (!usable) {
    ++dropped_;
    return;
  }
  refuse_too_many_triangles(context_.name, raw_.mesh.triangles.size() + corners_.size() - 2);
  triangulate_face(raw_.mesh.vertices, corners_, raw_.mesh.triangles);
}

RawMesh FaceSink::finish(bool single_precision) {
  if (raw_.mesh.triangles.empty()) {
    refuse_model(context_.name, dropped_ > 0 ? "no face with finite corners"
                                             : "no faces: points alone have no surface to slice");
  }
  if (dropped_ > 0) {
    raw_.warnings.push_back(counted(dropped_, "face") +
                            " left out: with corners that are not finite numbers");
  }
  raw_.single_precision = single_precision;
  weld_mesh(raw_.mesh);
  return std::move(raw_);
}

}  // namespace routebench::models
