#pragma once
/// Where the readers of indexed formats put their vertices and faces.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "model/raw_mesh.hpp"

namespace routebench::models {

/// Cuts faces into triangles and keeps out those with corners that are not finite.
class FaceSink {
 public:
  using Place = std::function<std::string()>;

  explicit FaceSink(const ReadContext& context) : context_(context) {}

  /// Makes room. Takes counts that the bytes of the file can hold.
  void reserve(std::size_t vertices, std::size_t faces);
  void add_vertex(const Point3& point);
  [[nodiscard]] std::size_t vertices() const noexcept { return raw_.mesh.vertices.size(); }
  [[nodiscard]] std::size_t faces() const noexcept { return faces_; }

  /// Adds a face by its corners, numbered from 0. Faces of one or two corners are points and lines:
  /// they are passed over.
  /// Takes  `place` for messages, for example "line 12"; it is asked for only when needed.
  /// Throws Error{kBadInput} for a corner that is no vertex and, unless the context says repair,
  /// for
  ///        one that is not finite.
  void add_face(std::span<const std::int64_t> corners, const Place& place);

  /// What was collected, welded. Throws Error{kBadInput} if there is no face.
  [[nodiscard]] RawMesh finish(bool single_precision);

 private:
  [[nodiscard]] bool is_usable(std::uint32_t vertex) const;
  [[noreturn]] void refuse_vertex(std::uint32_t vertex, const Place& place) const;

  const ReadContext& context_;
  RawMesh raw_;
  std::size_t faces_ = 0;
  std::size_t dropped_ = 0;
  std::vector<std::uint32_t> corners_;
};

}  // namespace routebench::models
