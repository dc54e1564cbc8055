#include "model/facet_sink.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

namespace routebench::models {

FacetSink::FacetSink(const ReadContext& context, Room room, std::size_t expected,
                     std::size_t facets_before)
    : context_(context),
      room_(std::move(room)),
      welder_(expected),  // a closed mesh has half as many vertices: with room few collide
      seen_(facets_before) {}

bool FacetSink::all_finite() const noexcept {
  // What is infinite or not a number has all bits of the exponent. Several numbers at a time.
  constexpr std::uint32_t kExponent = 0x7F800000U;
  std::uint32_t found = 0;
  for (const FloatPoint& vertex : welder_.vertices())
    for (const float number : vertex)
      found |= (std::bit_cast<std::uint32_t>(number) & kExponent) == kExponent ? 0xFFFFFFFFU : 0U;
  return found == 0;
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

void FacetSink::weld(std::span<FloatPoint> corners) {
  static_assert(decltype(welder_)::kBatch % 3 == 0);
  if (!corners.empty()) welder_.weld(corners, room_(corners.size() / 3)->data());
}

void FacetSink::flush() { weld(std::span(batch_).first(std::exchange(filled_, 0))); }

std::vector<FloatPoint> FacetSink::take_vertices() {
  flush();
  return welder_.take_vertices();
}

void warn_of_dropped(std::size_t dropped, std::vector<std::string>& warnings) {
  if (dropped == 0) return;
  warnings.push_back(counted(dropped, "facet") +
                     " left out: with corners that are not finite numbers");
}

}  // namespace routebench::models
