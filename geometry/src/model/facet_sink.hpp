#pragma once
/// Where the STL readers put their facets.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "model/raw_mesh.hpp"
#include "model/vertex_welder.hpp"

namespace routebench::models {

using Facet = std::array<std::array<float, 3>, 3>;

/// Welds facets in batches and keeps out those whose corners are not finite.
class FacetSink {
 public:
  /// `expected` facets at most, bounded by what the file can hold; messages count from
  /// `facets_before` on.
  FacetSink(const ReadContext& context, std::size_t expected, std::size_t facets_before = 0);

  /// Adds a facet. Throws Error{kBadInput} if a corner is not finite, unless the context says
  /// repair: then it is left out and counted. `place` tells a message where the facet is, for
  /// example "byte 84"; it is asked for only when needed.
  template <typename Place>
  void add(const Facet& facet, const Place& place) {
    if (!is_finite(facet)) {
      if (!context_.repair) refuse_not_finite(facet, place());
      ++dropped_;
      ++seen_;
      return;
    }
    ++seen_;
    for (const auto& [x, y, z] : facet) {
      batch_[filled_++] = {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
    }
    if (filled_ == batch_.size()) flush();
  }

  /// Facets added so far and before, left out ones included.
  [[nodiscard]] std::size_t seen() const noexcept { return seen_; }

  /// What was collected; the sink is empty afterwards. What was left out stands in dropped().
  [[nodiscard]] Mesh take_mesh();
  [[nodiscard]] std::size_t dropped() const noexcept { return dropped_; }

 private:
  [[nodiscard]] static bool is_finite(const Facet& facet) noexcept {
    // One test for nine numbers: zero times anything finite is zero. Finite numbers may overflow
    // in the sum, so that a failure is looked into.
    float sum = 0;
    for (const auto& corner : facet) sum += corner[0] + corner[1] + corner[2];
    return sum * 0.0F == 0.0F || each_is_finite(facet);
  }
  [[nodiscard]] static bool each_is_finite(const Facet& facet) noexcept;
  [[noreturn]] void refuse_not_finite(const Facet& facet, const std::string& place) const;
  void flush();

  const ReadContext& context_;
  VertexWelder welder_;
  Mesh mesh_;
  std::array<Point3, VertexWelder::kBatch> batch_;
  std::size_t filled_ = 0;
  std::size_t seen_;
  std::size_t dropped_ = 0;
};

/// The mesh of an STL file from those of its parts, with a warning about facets left out.
[[nodiscard]] RawMesh join_stl_parts(std::vector<Mesh> parts, std::size_t dropped,
                                     const ParallelFor& parallel_for);

}  // namespace routebench::models
