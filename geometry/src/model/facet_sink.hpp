#pragma once
/// Where the STL readers put their facets.

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "model/raw_mesh.hpp"
#include "model/vertex_welder.hpp"

namespace routebench::models {

using Facet = std::array<FloatPoint, 3>;

/// Welds facets in batches and keeps out those whose corners are not finite.
class FacetSink {
 public:
  /// Gives room for so many more triangles, right after those before.
  using Room = std::function<std::array<std::uint32_t, 3>*(std::size_t count)>;

  /// `expected` facets at most, bounded by what the file can hold; messages count from
  /// `facets_before` on.
  FacetSink(const ReadContext& context, Room room, std::size_t expected,
            std::size_t facets_before = 0);

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
    for (const FloatPoint& corner : facet) batch_[filled_++] = corner;
    if (filled_ == batch_.size()) flush();
  }

  /// Adds up to kFacetsAtOnce facets, which lose their negative zeros, whatever their corners are:
  /// all_finite() tells afterwards. For a sink that takes no others.
  static constexpr std::size_t kFacetsAtOnce = VertexWelder<FloatPoint>::kBatch / 3;
  void add_unchecked(std::span<Facet> facets) {
    seen_ += facets.size();
    weld(std::span(facets.data()->data(), 3 * facets.size()));
  }
  /// Whether all corners so far are finite. Looks at vertices, of which there are a sixth as many.
  [[nodiscard]] bool all_finite() const noexcept;

  /// Facets added so far and before, left out ones included.
  [[nodiscard]] std::size_t seen() const noexcept { return seen_; }

  /// The vertices, when all triangles are to be where there was room for them; the sink is empty
  /// afterwards. What was left out stands in dropped().
  [[nodiscard]] std::vector<FloatPoint> take_vertices();
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
  void weld(std::span<FloatPoint> corners);
  void flush();

  const ReadContext& context_;
  Room room_;
  VertexWelder<FloatPoint> welder_;
  std::array<FloatPoint, VertexWelder<FloatPoint>::kBatch> batch_;
  std::size_t filled_ = 0;
  std::size_t seen_;
  std::size_t dropped_ = 0;
};

/// Adds a warning about facets left out, if there are any.
void warn_of_dropped(std::size_t dropped, std::vector<std::string>& warnings);

}  // namespace routebench::models
