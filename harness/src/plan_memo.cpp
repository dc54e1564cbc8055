#include "plan_memo.hpp"

#include <bit>
#include <utility>

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

}  // namespace

PlanMemo::Entry& PlanMemo::entry_of(const Question& question, const Polygons& region) {
  const std::uint64_t hash = hash_of(region);
  const std::scoped_lock lock(mutex_);
  const auto [begin, end] = entries_.equal_range(hash);
  for (auto at = begin; at != end; ++at)
    if (at->second->question == question && at->second->region == region) return *at->second;
  std::unique_ptr<Entry> entry(new Entry{question, region, {}, nullptr});
  return *entries_.emplace(hash, std::move(entry))->second;
}

std::shared_ptr<const Route> PlanMemo::route(const Question& question, const Polygons& region,
                                             const std::function<Route()>& plan) {
  Entry& entry = entry_of(question, region);
  const std::scoped_lock lock(entry.planning);
  if (!entry.route) entry.route = std::make_shared<const Route>(plan());
  return entry.route;
}

}  // namespace routebench
