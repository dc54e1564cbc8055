#include "model/surface.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <numeric>
#include <span>
#include <utility>

#include "model/blocks.hpp"
#include "model/edge_table.hpp"
#include "model/triangle_sets.hpp"

namespace routebench::models {
namespace {

using Sides = std::span<const EdgeTable::Side>;

class Survey {
 public:
  Survey(const Mesh& mesh, const ParallelFor& parallel_for)
      : mesh_(mesh), edges_(mesh.triangles, mesh.vertices.size(), parallel_for) {
    meet_edges(parallel_for);
  }

  Surface run(const ParallelFor& parallel_for) {
    if (clash_) tell_directions();
    label_patches(parallel_for);
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
    std::vector<std::vector<EdgeTable::Side>> wide;
    std::vector<std::array<std::uint32_t, 2>> far_neighbours;  ///< not both of the edge's range
  };

  /// First look at every edge: counts, copies, patches. Neighbours of different ranges are joined
  /// last, so that no two threads meet.
  void meet_edges(const ParallelFor& parallel_for) {
    patch_.resize(mesh_.triangles.size());
    std::vector<Met> ranges(edges_.ranges());
    parallel_for(ranges.size(), [&](std::size_t range) { ranges[range] = meet_edges(range); });
    parallel_for(ranges.size(),
                 [&](std::size_t range) { find_patches(ranges[range].far_neighbours); });
    for (Met& met : ranges) {
      result_.open_edges += met.open_edges;
      result_.copies_along += met.copies_along;
      result_.copies_against += met.copies_against;
      clash_ |= met.clash;
      for (const auto& [a, b] : met.far_neighbours) join_patch(a, b);
      std::move(met.wide.begin(), met.wide.end(), std::back_inserter(wide_));
    }
    result_.non_manifold_edges = wide_.size();
  }

  Met meet_edges(std::size_t range) {
    Met met;
    const auto [begin, end] = edges_.triangles_of(range);
    std::iota(patch_.data() + begin, patch_.data() + end, static_cast<std::uint32_t>(begin));
    edges_.for_each_edge(range, [&](std::uint32_t lower, Sides sides) {
      if (sides.size() == 1) {
        ++met.open_edges;
        return;
      }
      count_copies(lower, sides, met);
      if (sides.size() > 2) {
        met.wide.emplace_back(sides.begin(), sides.end());
        return;
      }
      met.clash |= sides[0].rising() == sides[1].rising();
      const std::uint32_t a = sides[0].triangle(), b = sides[1].triangle();
      if (EdgeTable::range_of(a) == range && EdgeTable::range_of(b) == range)
        join_patch(a, b);
      else
        met.far_neighbours.push_back({a, b});
    });
    for (std::size_t t = begin; t < end; ++t) patch_[t] = patch_[patch_[t]];
    return met;
  }

  /// Replaces triangles by those that their patches begin with and drops most that come again.
  void find_patches(std::vector<std::array<std::uint32_t, 2>>& neighbours) const {
    std::array<std::array<std::uint32_t, 2>, 256> seen{};
    std::size_t kept = 0;
    for (const auto& [a, b] : neighbours) {
      const std::array<std::uint32_t, 2> both{patch_[a], patch_[b]};
      std::array<std::uint32_t, 2>& last = seen[(both[0] ^ both[1] * 31) % seen.size()];
      if (both != last) neighbours[kept++] = last = both;
    }
    neighbours.resize(kept);
  }

  /// Union-find: each triangle has a lower one of its patch, the lowest has itself.
  ///
  /// Source  M. Rem's algorithm with splicing, found fastest by M. Patwary, J. Blair and F. Manne,
  ///         2010: both ways are followed at the same time, and each step joins them.
  void join_patch(std::uint32_t a, std::uint32_t b) {
    while (patch_[a] != patch_[b]) {
      if (patch_[a] < patch_[b]) std::swap(a, b);
      const std::uint32_t next = std::exchange(patch_[a], patch_[b]);
      if (next == a) return;
      a = next;
    }
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
      if (third != apex(lower, sides[1]) || third < sides[0].upper()) return;
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
  void label_patches(const ParallelFor& parallel_for) {
    std::vector<std::size_t> firsts(block_count(patch_.size()));
    const auto count_firsts = [&](std::size_t block, std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t)
        if (patch_[t] == t) ++firsts[block];
    };
    for_each_block(patch_.size(), parallel_for, count_firsts);
    if (std::accumulate(firsts.begin(), firsts.end(), std::size_t{0}) == 1) {
      const auto clear = [&](std::size_t, std::size_t begin, std::size_t end) {
        std::fill(patch_.data() + begin, patch_.data() + end, 0);
      };
      for_each_block(patch_.size(), parallel_for, clear);
      patches_ = 1;
      return;
    }
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
    for (const std::vector<EdgeTable::Side>& sides : wide_) {
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
    if (patches_ > 1)
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
  bool clash_ = false;                              ///< two neighbours disagree somewhere
  std::vector<std::vector<EdgeTable::Side>> wide_;  ///< sides of edges with three or more
  LargeVector<std::uint32_t> patch_;                ///< of each triangle
  std::uint32_t patches_ = 0;
};

}  // namespace

Surface survey(const Mesh& mesh, const ParallelFor& parallel_for) {
  return Survey(mesh, parallel_for).run(parallel_for);
}

}  // namespace routebench::models
