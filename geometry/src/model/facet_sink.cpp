#include "model/facet_sink.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "model/join_parts.hpp"

namespace routebench::models {

FacetSink::FacetSink(const ReadContext& context, std::size_t expected, std::size_t facets_before)
    : context_(context), welder_(expected / 2), seen_(facets_before) {
  mesh_.triangles.reserve(expected);
}

bool FacetSink::each_is_finite(const Facet& facet) noexcept {
  for (const auto& corner : facet) {
    for (const float coordinate : corner) {
      if (!std::isfinite(coordinate)) return false;
    }
  }
  return true;
}

void FacetSink::refuse_not_finite(const Facet& facet, const std::string& place) const {
  std::size_t corner = 0;
  std::size_t axis = 0;
  while (std::isfinite(facet[corner][axis])) {
    if (++axis < 3) continue;
    axis = 0;
    ++corner;
  }
  const std::string what = std::isnan(facet[corner][axis]) ? "not a number" : "infinite";
  refuse_model(context_.name, "facet " + std::to_string(seen_ + 1) + " (" + place + "): the " +
                                  "xyz"[axis] + " of corner " + std::to_string(corner + 1) +
                                  " is " + what +
                                  ", but must be a finite number; with --repair such facets are "
                                  "left out");
}

void FacetSink::flush() {
  static_assert(VertexWelder::kBatch % 3 == 0);
  std::array<std::uint32_t, VertexWelder::kBatch> indices;  // written before it is read
  welder_.weld({batch_.data(), filled_}, indices.data());
  for (std::size_t i = 0; i < filled_; i += 3) {
    mesh_.triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
  }
  filled_ = 0;
}

Mesh FacetSink::take_mesh() {
  flush();
  mesh_.vertices = welder_.take_vertices();
  return std::exchange(mesh_, {});
}

RawMesh join_stl_parts(std::vector<Mesh> parts, std::size_t dropped,
                       const ParallelFor& parallel_for) {
  RawMesh raw;
  raw.single_precision = true;
  raw.mesh = join_parts(std::move(parts), parallel_for);
  if (dropped > 0) {
    raw.warnings.push_back(counted(dropped, "facet") +
                           " left out: with corners that are not finite numbers");
  }
  return raw;
}

}  // namespace routebench::models
