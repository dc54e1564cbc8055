#include "model/vertex_welder.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <utility>

namespace routebench::models {
namespace {

constexpr std::size_t kFewestSlots = 256;

void drop_negative_zeros(std::span<Point3> points) noexcept {
  for (Point3& point : points) point = without_negative_zeros(point);
}
/// Four numbers at a time.
void drop_negative_zeros(std::span<FloatPoint> points) noexcept {
  float* const numbers = reinterpret_cast<float*>(points.data());
  for (std::size_t i = 0; i < 3 * points.size(); ++i) numbers[i] += 0.0F;
}

bool are_same(const Point3& a, const Point3& b) noexcept { return a == b; }

/// Without negative zeros points are equal where all their bits are: one branch instead of three.
bool are_same(const FloatPoint& a, const FloatPoint& b) noexcept {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

}  // namespace

template <typename Point>
VertexWelder<Point>::VertexWelder(std::size_t expected)
    : slots_(std::bit_ceil(std::max(kFewestSlots, expected * 2))), mask_(slots_.size() - 1) {
  vertices_.reserve(expected);
}

template <typename Point>
void VertexWelder<Point>::weld(std::span<Point> points, std::uint32_t* indices) {
  std::array<std::uint32_t, kBatch> tags;  // written before it is read
  drop_negative_zeros(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    tags[i] = tag_of(points[i]);
    __builtin_prefetch(&slots_[tags[i] & mask_]);
  }
  if (vertices_.size() + points.size() > slots_.size() / 8 * 5) grow();
  Slot* const slots = slots_.data();
  const std::size_t mask = mask_;
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::size_t place = tags[i] & mask;
    while (slots[place].vertex != 0 && !(slots[place].tag == tags[i] &&
                                         are_same(vertices_[slots[place].vertex - 1], points[i])))
      place = (place + 1) & mask;
    if (slots[place].vertex == 0) {
      vertices_.push_back(points[i]);
      slots[place] = {tags[i], static_cast<std::uint32_t>(vertices_.size())};
    }
    indices[i] = slots[place].vertex - 1;
  }
}

template <typename Point>
void VertexWelder<Point>::grow() {
  const std::vector<Slot> old = std::exchange(slots_, std::vector<Slot>(slots_.size() * 2));
  mask_ = slots_.size() - 1;
  for (const Slot& slot : old) {
    if (slot.vertex == 0) continue;
    std::size_t place = slot.tag & mask_;
    while (slots_[place].vertex != 0) place = (place + 1) & mask_;
    slots_[place] = slot;
  }
}

template <typename Point>
std::vector<Point> VertexWelder<Point>::take_vertices() {
  slots_.assign(kFewestSlots, Slot{});
  mask_ = kFewestSlots - 1;
  return std::exchange(vertices_, {});
}

template class VertexWelder<Point3>;
template class VertexWelder<FloatPoint>;

void weld_mesh(Mesh& mesh) {
  constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> number(mesh.vertices.size(), kUnused);
  VertexWelder<Point3> welder(mesh.vertices.size());
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
