#include "judge/alike.hpp"

#include <boost/container_hash/hash.hpp>
#include <string_view>
#include <unordered_map>

namespace routebench::judging {
namespace {

bool are_alike(const LayerCase& a, const LayerCase& b) {
  return a.entered_from == b.entered_from && *a.route == *b.route &&
         (a.demand == b.demand || *a.demand == *b.demand);
}

/// Equal for equal cases but for zeros of other signs, which are then judged one by one.
std::size_t hash_of(const LayerCase& layer) {
  std::size_t hash = layer.demand->outline.size();
  const auto add = [&hash](std::span<const Point2> points) {
    const auto bytes = std::as_bytes(points);
    boost::hash_combine(hash, std::hash<std::string_view>{}(
                                  {reinterpret_cast<const char*>(bytes.data()), bytes.size()}));
  };
  for (const Polygon& polygon : layer.demand->outline) add(polygon.outer);
  for (const Stroke& stroke : layer.route->strokes) add(stroke.points);
  if (layer.entered_from) add({&*layer.entered_from, 1});
  return hash;
}

}  // namespace

std::vector<std::size_t> first_alike(std::span<const LayerCase> cases) {
  std::vector<std::size_t> first(cases.size());
  std::unordered_multimap<std::size_t, std::size_t> known;  // the first ones, by their hashes
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const std::size_t hash = hash_of(cases[i]);
    first[i] = i;
    const auto [begin, end] = known.equal_range(hash);
    for (auto at = begin; at != end && first[i] == i; ++at)
      if (are_alike(cases[at->second], cases[i])) first[i] = at->second;
    if (first[i] == i) known.emplace(hash, i);
  }
  return first;
}

}  // namespace routebench::judging
