#include "model/facet_sink.hpp"

#include <cmath>
#include <string>
#include <utility>

namespace routebench::models {

FacetSink::FacetSink(const ReadContext& context, std::size_t expected)
    : context_(context), welder_(expected / 2) {
  raw_.single_precision = true;
  raw_.mesh.triangles.reserve(expected);
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
    raw_.mesh.triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
  }
  filled_ = 0;
}

RawMesh FacetSink::finish() {
  flush();
  if (dropped_ > 0) {
    raw_.warnings.push_back(counted(dropped_, "facet") +
                            " left out: with corners that are not finite numbers");
  }
  raw_.mesh.vertices = welder_.take_vertices();
  return std::move(raw_);
}

}  // namespace routebench::models
