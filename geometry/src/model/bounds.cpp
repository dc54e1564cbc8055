#include "model/bounds.hpp"

#include <vector>

#include "model/blocks.hpp"

namespace routebench::models {

Bounds bounds_of(const Mesh& mesh, const ParallelFor& parallel_for) {
  std::vector<Bounds> blocks(block_count(mesh.vertices.size()));
  const auto bound = [&](std::size_t block, std::size_t begin, std::size_t end) {
    Bounds own;
    for (std::size_t v = begin; v < end; ++v) own.add(mesh.vertices[v]);
    blocks[block] = own;
  };
  for_each_block(mesh.vertices.size(), parallel_for, bound);
  Bounds bounds;
  for (const Bounds& block : blocks) bounds.add(block);
  return bounds;
}

}  // namespace routebench::models
