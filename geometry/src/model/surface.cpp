#include "model/surface.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "model/blocks.hpp"
#include "model/edge_table.hpp"
#include "model/shared_sets.hpp"
#include "model/triangle_sets.hpp"

namespace routebench::models {
namespace {

using Sides = std::span<const EdgeTable::Side>;

class Survey {
 public:
  Survey(const Mesh& mesh, const ParallelFor& parallel_for)
      : mesh_(mesh),
        edges_(mesh.triangles, mesh.vertices.size(), parallel_for),
        patch_(meet_edges(parallel_for)) {}

  Surface run() {
    if (clash_) tell_directions();
    label_patches();
    if (clash_) turn_minorities();
    join_patches();
    return std::move(result_);
  }

 private:
  /// What was met at some of the edges.
  struct Met {
    std::size_t open_edges = 0;
    std::size_t copies_along = 0;
    std::size_t copies_against = 0;
    bool clash = false;
    std::vector<Sides> wide;
  };

  /// First look at every edge: counts, copies, patches. Returns for each triangle a lower one of
  /// its patch, or itself.
  std::vector<std::uint32_t> meet_edges(const ParallelFor& parallel_for) {
    SharedSets sets(mesh_.triangles.size());
    std::vector<Met> blocks(block_count(mesh_.vertices.size()));
    const auto meet = [&](std::size_t block, std::size_t begin, std::size_t end) {
      Met met;
      edges_.for_each_edge(begin, end, [&](std::uint32_t lower, Sides sides) {
        if (sides.size() == 1) {
          ++met.open_edges;
          return;
        }
        count_copies(lower, sides, met);
        if (sides.size() > 2) {
          met.wide.push_back(sides);
          return;
        }
        met.clash |= sides[0].rising() == sides[1].rising();
        sets.join(sides[0].triangle(), sides[1].triangle());
      });
      blocks[block] = std::move(met);
    };
    for_each_block(mesh_.vertices.size(), parallel_for, meet);
    for (const Met& met : blocks) {
      result_.open_edges += met.open_edges;
      result_.copies_along += met.copies_along;
      result_.copies_against += met.copies_against;
      clash_ |= met.clash;
      wide_.insert(wide_.end(), met.wide.begin(), met.wide.end());
    }
    result_.non_manifold_edges = wide_.size();
    return sets.take_parents();
  }

  /// The third corner of the triangle that a side belongs to.
  [[nodiscard]] std::uint32_t apex(std::uint32_t lower, EdgeTable::Side side) const {
    const auto& [a, b, c] = mesh_.triangles[side.triangle()];
    return a ^ b ^ c ^ lower ^ side.upper();
  }

  /// Counts copies at the edge between their two lowest vertices, so that each counts once.
  void count_copies(std::uint32_t lower, Sides sides, Met& met) const {
    if (sides.size() == 2) {
      const std::uint32_t third = apex(lower, sides[0]);
      if (third < sides[0].upper() || third != apex(lower, sides[1])) return;
      ++(sides[0].rising() == sides[1].rising() ? met.copies_along : met.copies_against);
      return;
    }
    std::vector<std::pair<std::uint32_t, bool>> found;  // apex, direction
    for (const EdgeTable::Side side : sides) {
      const std::uint32_t third = apex(lower, side);
      if (third > side.upper()) found.emplace_back(third, side.rising());
    }
    std::sort(found.begin(), found.end());
    for (std::size_t i = 1; i < found.size(); ++i) {
      if (found[i].first != found[i - 1].first) continue;
      ++(found[i].second == found[i - 1].second ? met.copies_along : met.copies_against);
    }
  }

  /// Which triangles run against the first of their patch.
  void tell_directions() {
    TriangleSets sets(mesh_.triangles.size());
    edges_.for_each_edge([&](std::uint32_t, Sides sides) {
      if (sides.size() != 2) return;
      sets.join(sides[0].triangle(), sides[1].triangle(), sides[0].rising() == sides[1].rising());
    });
    result_.turn.resize(mesh_.triangles.size());
    for (std::uint32_t t = 0; t < result_.turn.size(); ++t)
      result_.turn[t] = sets.find(t).against ? 1 : 0;
  }

  /// Numbers the patches by their first triangles.
  void label_patches() {
    for (std::uint32_t t = 0; t < patch_.size(); ++t)
      patch_[t] = patch_[t] == t ? patches_++ : patch_[patch_[t]];
  }

  /// In every patch the smaller part is turned to run as the larger one does.
  void turn_minorities() {
    std::vector<std::size_t> size(patches_, 0);
    std::vector<std::size_t> against(patches_, 0);
    for (std::size_t t = 0; t < patch_.size(); ++t) {
      ++size[patch_[t]];
      against[patch_[t]] += result_.turn[t];
    }
    for (std::size_t t = 0; t < patch_.size(); ++t) {
      const std::size_t p = patch_[t];
      if (against[p] > size[p] - against[p]) result_.turn[t] ^= 1U;
      result_.flipped_triangles += result_.turn[t];
    }
  }

  [[nodiscard]] bool rising(EdgeTable::Side side) const {
    return side.rising() != (clash_ && result_.turn[side.triangle()] != 0);
  }

  /// From patches to components and shells, and which of them are closed.
  void join_patches() {
    TriangleSets components(patches_);
    TriangleSets shells(patches_);
    std::vector<std::uint8_t> open(patches_, 0);
    for (const Sides sides : wide_) {
      for (const EdgeTable::Side side : sides) {
        components.join(patch_[sides[0].triangle()], patch_[side.triangle()], false);
      }
      join_shells(sides, shells, open);
    }
    if (result_.open_edges > 0 || clash_) mark_open(open);

    std::vector<std::uint32_t> shell_of_patch(patches_);
    for (std::uint32_t p = 0; p < patches_; ++p) {
      if (components.find(p).set == p) ++result_.components;
      const std::uint32_t set = shells.find(p).set;
      if (set == p) {
        shell_of_patch[p] = static_cast<std::uint32_t>(result_.closed.size());
        result_.closed.push_back(1);
      } else {
        shell_of_patch[p] = shell_of_patch[set];
      }
      if (open[p] != 0) result_.closed[shell_of_patch[p]] = 0;
    }
    for (std::uint32_t& p : patch_) p = shell_of_patch[p];
    result_.shell = std::move(patch_);
  }

  /// At an edge with many triangles those patches that do not close alone belong together.
  void join_shells(Sides sides, TriangleSets& shells, std::vector<std::uint8_t>& open) {
    std::vector<std::pair<std::uint32_t, int>> net;  // patch, runs up minus runs down
    for (const EdgeTable::Side side : sides) {
      net.emplace_back(patch_[side.triangle()], rising(side) ? 1 : -1);
    }
    std::sort(net.begin(), net.end());
    int total = 0;
    std::vector<std::uint32_t> needy;
    for (std::size_t first = 0, next = 0; first < net.size(); first = next) {
      int sum = 0;
      for (; next < net.size() && net[next].first == net[first].first; ++next) {
        sum += net[next].second;
      }
      if (sum != 0) needy.push_back(net[first].first);
      total += sum;
    }
    for (const std::uint32_t patch : needy) shells.join(needy[0], patch, false);
    if (total == 0) return;
    ++result_.unpaired_edges;
    for (const std::uint32_t patch : needy) open[patch] = 1;
  }

  /// Second look at the edges with one or two triangles, where some are unpaired.
  void mark_open(std::vector<std::uint8_t>& open) {
    edges_.for_each_edge([&](std::uint32_t, Sides sides) {
      const bool unpaired =
          sides.size() == 1 || (sides.size() == 2 && rising(sides[0]) == rising(sides[1]));
      if (!unpaired) return;
      ++result_.unpaired_edges;
      open[patch_[sides[0].triangle()]] = 1;
    });
  }

  const Mesh& mesh_;
  EdgeTable edges_;
  Surface result_;
  bool clash_ = false;  ///< two neighbours disagree somewhere
  std::vector<Sides> wide_;
  std::vector<std::uint32_t> patch_;  ///< of each triangle
  std::uint32_t patches_ = 0;
};

}  // namespace

Surface survey(const Mesh& mesh, const ParallelFor& parallel_for) {
  return Survey(mesh, parallel_for).run();
}

}  // namespace routebench::models
