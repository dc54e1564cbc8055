#include "model/vertex_welder.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

namespace routebench::models {
namespace {

constexpr std::size_t kFewestSlots = 64;

}  // namespace

VertexWelder::VertexWelder(std::size_t expected)
    : slots_(std::bit_ceil(std::max(kFewestSlots, expected * 2))), mask_(slots_.size() - 1) {
  vertices_.reserve(expected);
}

void VertexWelder::weld(std::span<Point3> points, std::uint32_t* indices) {
  std::array<std::uint32_t, kBatch> tags;  // written before it is read
  for (std::size_t i = 0; i < points.size(); ++i) {
    Point3& p = points[i];
    p = {p.x + 0.0, p.y + 0.0, p.z + 0.0};  // -0.0 + 0.0 is 0.0
    tags[i] = tag_of(p);
    __builtin_prefetch(&slots_[tags[i] & mask_]);
  }
  for (std::size_t i = 0; i < points.size(); ++i) indices[i] = find_or_add(points[i], tags[i]);
}

std::uint32_t VertexWelder::find_or_add(const Point3& point, std::uint32_t tag) {
  std::size_t place = tag & mask_;
  while (slots_[place].vertex != 0) {
    const Slot& slot = slots_[place];
    if (slot.tag == tag && vertices_[slot.vertex - 1] == point) return slot.vertex - 1;
    place = (place + 1) & mask_;
  }
  vertices_.push_back(point);
  const auto number = static_cast<std::uint32_t>(vertices_.size());
  slots_[place] = {tag, number};
  if (vertices_.size() > slots_.size() / 8 * 5) grow();
  return number - 1;
}

void VertexWelder::grow() {
  const std::vector<Slot> old = std::exchange(slots_, std::vector<Slot>(slots_.size() * 2));
  mask_ = slots_.size() - 1;
  for (const Slot& slot : old) {
    if (slot.vertex == 0) continue;
    std::size_t place = slot.tag & mask_;
    while (slots_[place].vertex != 0) place = (place + 1) & mask_;
    slots_[place] = slot;
  }
}

std::vector<Point3> VertexWelder::take_vertices() {
  slots_.assign(kFewestSlots, Slot{});
  mask_ = kFewestSlots - 1;
  return std::exchange(vertices_, {});
}

void weld_mesh(Mesh& mesh) {
  constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> number(mesh.vertices.size(), kUnused);
  VertexWelder welder(mesh.vertices.size());
  for (auto& triangle : mesh.triangles) {
    for (std::uint32_t& corner : triangle) {
      std::uint32_t& welded = number[corner];
      if (welded == kUnused) {
        Point3 point = mesh.vertices[corner];
        welder.weld({&point, 1}, &welded);
      }
      corner = welded;
    }
  }
  mesh.vertices = welder.take_vertices();
}

}  // namespace routebench::models
