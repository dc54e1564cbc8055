#include "plan_memo.hpp"

#include <bit>

namespace routebench {
namespace {

void mix(std::uint64_t& hash, double value) {
  hash = (std::rotl(hash, 5) ^ std::bit_cast<std::uint64_t>(value)) * 0x9E3779B97F4A7C15u;
}

std::uint64_t hash_of(const Polygons& region) {
  std::uint64_t hash = region.size();
  const auto add = [&](const Ring& ring) {
    for (const Point2 p : ring) {
      mix(hash, p.x);
      mix(hash, p.y);
    }
  };
  for (const Polygon& polygon : region) {
    add(polygon.outer);
    for (const Ring& hole : polygon.holes) add(hole);
  }
  return hash;
}

int phase_of(const Planner& planner, const Layer& part) {
  return part.index % planner.period_layers();
}

}  // namespace

std::optional<Route> PlanMemo::find(const Planner& planner, const Layer& part,
                                    const PlanContext& context) {
  const std::uint64_t hash = hash_of(part.polygons);
  const int phase = phase_of(planner, part);
  const std::scoped_lock lock(mutex_);
  const auto [begin, end] = entries_.equal_range(hash);
  for (auto at = begin; at != end; ++at) {
    const Entry& entry = at->second;
    if (entry.planner == &planner && entry.phase == phase && entry.height_mm == part.height_mm &&
        entry.start == context.start && entry.density == context.density &&
        entry.region == part.polygons)
      return entry.route;
  }
  return std::nullopt;
}

void PlanMemo::keep(const Planner& planner, const Layer& part, const PlanContext& context,
                    const Route& route) {
  const std::uint64_t hash = hash_of(part.polygons);
  const std::scoped_lock lock(mutex_);
  entries_.emplace(hash, Entry{&planner, phase_of(planner, part), part.height_mm, context.start,
                               context.density, part.polygons, route});
}

}  // namespace routebench
