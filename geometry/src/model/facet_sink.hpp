#pragma once
/// Where the STL readers put their facets.

#include <array>
#include <cstddef>
#include <cstdint>

#include "model/raw_mesh.hpp"
#include "model/vertex_welder.hpp"

namespace routebench::models {

using Facet = std::array<std::array<float, 3>, 3>;

/// Welds facets in batches and keeps out those whose corners are not finite.
class FacetSink {
 public:
  /// `expected` facets at most, bounded by what the file can hold.
  FacetSink(const ReadContext& context, std::size_t expected);

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

  /// Facets added so far, left out ones included.
  [[nodiscard]] std::size_t seen() const noexcept { return seen_; }

  /// What was collected, with a warning about facets left out.
  [[nodiscard]] RawMesh finish();

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
  RawMesh raw_;
  std::array<Point3, VertexWelder::kBatch> batch_;
  std::size_t filled_ = 0;
  std::size_t seen_ = 0;
  std::size_t dropped_ = 0;
};

}  // namespace routebench::models
