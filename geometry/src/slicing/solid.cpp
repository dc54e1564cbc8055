#include "routebench/geometry/solid.hpp"

#include <algorithm>
#include <cstddef>
#include <memory_resource>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "overlay/ring_index.hpp"
#include "overlay/scratch.hpp"
#include "overlay/to_grid.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/geometry/region.hpp"
#include "slicing/slivers.hpp"

namespace routebench {
namespace {

// Neighbouring layers are often equal: then no clipper is needed.
Polygons common_part(const Polygons& a, const Polygons& b) { return a == b ? a : intersect(a, b); }
Polygons rest(const Polygons& a, const Polygons& b) { return a == b ? Polygons{} : subtract(a, b); }

/// The common part of any `window` consecutive layers from two intersections, whatever the window's
/// width: layers are cut into blocks as long as the window, and every layer knows what is common to
/// it and all before it in its block, and to it and all after it. A window is the end of one block
/// and the beginning of the next.
/// Source: M. van Herk, 1992 (for the minimum of numbers).
class CommonParts {
 public:
  CommonParts(const std::vector<Layer>& layers, std::size_t window, const ParallelFor& parallel_for)
      : window_(window), from_block_begin_(layers.size()), to_block_end_(layers.size()) {
    parallel_for((layers.size() + window - 1) / window, [&](std::size_t block) {
      const std::size_t begin = block * window, end = std::min(layers.size(), begin + window);
      from_block_begin_[begin] = layers[begin].polygons;
      for (std::size_t i = begin + 1; i < end; ++i)
        from_block_begin_[i] = common_part(from_block_begin_[i - 1], layers[i].polygons);
      to_block_end_[end - 1] = layers[end - 1].polygons;
      for (std::size_t i = end - 1; i-- > begin;)
        to_block_end_[i] = common_part(layers[i].polygons, to_block_end_[i + 1]);
    });
  }

  [[nodiscard]] Polygons of_window(std::size_t begin) const {
    if (begin % window_ == 0) return to_block_end_[begin];
    return common_part(to_block_end_[begin], from_block_begin_[begin + window_ - 1]);
  }

 private:
  std::size_t window_;
  std::vector<Polygons> from_block_begin_;
  std::vector<Polygons> to_block_end_;
};

std::size_t checked_reach(int skin_layers) {
  if (skin_layers < 0)
    throw Error(ErrorKind::kBadUsage,
                "skin_layers = " + std::to_string(skin_layers) + ": must be 0 or more");
  return static_cast<std::size_t>(skin_layers);
}

}  // namespace

std::vector<std::size_t> first_of_equal_layers(const std::vector<Layer>& layers) {
  std::vector<std::size_t> first(layers.size());
  for (std::size_t i = 0; i < layers.size(); ++i)
    first[i] = i > 0 && layers[i].polygons == layers[i - 1].polygons ? first[i - 1] : i;
  return first;
}

struct SkinFinder::Impl {
  /// What overlays need of one layer; nothing if it is empty or does not fit on their grid.
  using Index = std::optional<overlay::RingIndex>;

  const std::vector<Layer>& layers;
  std::size_t reach;
  std::vector<std::size_t> first;  ///< see first_of_equal_layers
  std::vector<Index> indices;      ///< of those layers

  static Index index_of(std::span<const Polygon> polygons,
                        std::pmr::memory_resource* memory = std::pmr::get_default_resource()) {
    overlay::ToGrid grid(0, memory);
    for (const Polygon& polygon : polygons)
      if (!grid.add(polygon, {1, 0})) return std::nullopt;
    overlay::GridRings rings = grid.take();
    if (rings.rings() == 0) return std::nullopt;
    return overlay::RingIndex(std::move(rings));
  }

  /// Adds what of a polygon any of the layers leaves open; false if some do not fit on the grid.
  [[nodiscard]] bool add_skins(const Polygon& polygon, const std::vector<std::size_t>& around,
                               std::vector<overlay::GridPolygon>& skins) const {
    overlay::Scratch scratch;
    const Index own = index_of({&polygon, 1}, &scratch);
    if (!own) return false;
    // Most layers hold the polygon. The others are cut one after the other: at once, the sides of
    // all would be cut at each other too.
    std::vector<std::size_t> needed;
    for (const std::size_t other : around) {
      if (!indices[other] && !layers[other].polygons.empty()) return false;
      if (!indices[other] || !indices[other]->holds_all_of(*own)) needed.push_back(other);
    }
    // Each takes a piece of what those before it leave.
    std::vector<std::vector<overlay::GridPolygon>> pieces;
    Index left;
    const overlay::RingIndex* common = &*own;
    for (const std::size_t other : needed) {
      if (common == nullptr) break;
      if (!pieces.empty() && indices[other] && indices[other]->holds_all_of(*common)) continue;
      auto parts = divided(*common, pointer_to(indices[other]), &scratch);
      if (!parts) return false;
      if (parts->beyond.empty()) continue;
      pieces.push_back(std::move(parts->beyond));
      left.reset();
      if (!parts->within.empty()) left.emplace(overlay::rings_of(parts->within, &scratch));
      common = pointer_to(left);
    }
    if (!are_apart(pieces, &scratch)) {
      auto parts = divided(*own, common, &scratch);
      if (!parts) return false;
      pieces = {std::move(parts->beyond)};
    }
    for (const auto& piece : pieces) skins.insert(skins.end(), piece.begin(), piece.end());
    return true;
  }

  static const overlay::RingIndex* pointer_to(const Index& index) {
    return index ? &*index : nullptr;
  }

  /// What of an area lies in another one and what does not; nothing if they cannot be cut.
  [[nodiscard]] static std::optional<overlay::Divided> divided(const overlay::RingIndex& area,
                                                               const overlay::RingIndex* other,
                                                               std::pmr::memory_resource* memory) {
    overlay::GridRings rings(area.rings(), memory);
    if (other != nullptr) rings.add_near(other->rings(), area.rings(), {0, 1});
    return overlay::divide(rings);
  }

  /// Whether no two pieces share a side, so that they need not be joined. Cuts are moved by less
  /// than a unit each.
  [[nodiscard]] static bool are_apart(const std::vector<std::vector<overlay::GridPolygon>>& pieces,
                                      std::pmr::memory_resource* memory) {
    if (pieces.size() < 2) return true;
    std::vector<overlay::RingIndex> indices;
    for (const auto& piece : pieces) indices.emplace_back(overlay::rings_of(piece, memory));
    for (std::size_t i = 0; i < indices.size(); ++i)
      for (std::size_t k = 0; k < i; ++k)
        if (indices[i].comes_near(indices[k])) return false;
    return true;
  }

  [[nodiscard]] Polygons skins_off_the_grid(const Polygons& region,
                                            const std::vector<std::size_t>& around) const {
    Polygons common = region;
    for (const std::size_t other : around) common = common_part(common, layers[other].polygons);
    return rest(region, common);
  }
};

SkinFinder::SkinFinder(const std::vector<Layer>& layers, int skin_layers,
                       const ParallelFor& parallel_for)
    : impl_(std::make_unique<Impl>(Impl{layers, checked_reach(skin_layers), {}, {}})) {
  impl_->indices.resize(layers.size());
  if (impl_->reach == 0) return;
  impl_->first = first_of_equal_layers(layers);
  parallel_for(layers.size(), [&](std::size_t i) {
    if (impl_->first[i] == i) impl_->indices[i] = Impl::index_of(layers[i].polygons);
  });
}

SkinFinder::~SkinFinder() = default;
SkinFinder::SkinFinder(SkinFinder&&) noexcept = default;
SkinFinder& SkinFinder::operator=(SkinFinder&&) noexcept = default;

Polygons SkinFinder::skins_in(const Polygons& region, std::size_t layer) const {
  const std::size_t reach = impl_->reach, count = impl_->layers.size();
  if (reach == 0 || region.empty()) return {};
  if (layer < reach || layer + reach >= count) return region;
  // The farthest first: what they leave is mostly held by the nearer ones. A layer that equals the
  // region's own leaves nothing open.
  const std::vector<std::size_t>& first = impl_->first;
  std::vector<std::size_t> around;
  for (std::size_t distance = reach; distance > 0; --distance)
    for (const std::size_t other : {first[layer - distance], first[layer + distance]})
      if (other != first[layer] && std::find(around.begin(), around.end(), other) == around.end())
        around.push_back(other);
  if (around.empty()) return {};
  std::vector<overlay::GridPolygon> skins;
  for (const Polygon& polygon : region)
    if (!impl_->add_skins(polygon, around, skins)) return impl_->skins_off_the_grid(region, around);
  return overlay::to_polygons(skins);
}

void find_solid(std::vector<Layer>& layers, int skin_layers, const ParallelFor& parallel_for) {
  const std::size_t count = layers.size();
  const std::size_t reach = std::min(checked_reach(skin_layers), count);
  if (reach == 0 || 2 * reach >= count) {
    for (Layer& layer : layers) layer.solid = reach == 0 ? Polygons{} : layer.polygons;
    return;
  }
  const CommonParts common(layers, 2 * reach + 1, parallel_for);
  parallel_for(count, [&](std::size_t i) {
    Layer& layer = layers[i];
    const bool at_an_end = i < reach || i + reach >= count;
    layer.solid = at_an_end
                      ? layer.polygons
                      : slicing::without_slivers(rest(layer.polygons, common.of_window(i - reach)));
  });
}

}  // namespace routebench
