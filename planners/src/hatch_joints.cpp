#include <algorithm>
#include <cstddef>
#include <numeric>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

#include "routebench/geometry/edge_grid.hpp"
#include "routebench/planning/hatch.hpp"

namespace routebench {
namespace {

/// Which pieces are one stroke already.
class Strokes {
 public:
  explicit Strokes(std::size_t pieces) : parent_(pieces) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }

  /// Makes one of two strokes; false if they are one already.
  bool join(std::size_t a, std::size_t b) {
    a = root(a);
    b = root(b);
    if (a == b) return false;
    parent_[std::max(a, b)] = std::min(a, b);
    return true;
  }

 private:
  std::size_t root(std::size_t piece) {
    while (parent_[piece] != piece) {
      parent_[piece] = parent_[parent_[piece]];
      piece = parent_[piece];
    }
    return piece;
  }

  std::vector<std::size_t> parent_;
};

/// A stretch that may become a joint.
struct Candidate {
  const Stretch* stretch;
  double length_mm;
  std::uint32_t lower_line;
};

}  // namespace

std::vector<Joint> join_flows(const Hatch& hatch, const Polygon* region) {
  std::optional<EdgeGrid> edges;
  if (region != nullptr) edges.emplace(Polygons{*region});
  std::vector<Joint> joints;
  std::vector<bool> first_is_open;  // of the flows that reach the line below: the end that is free
  for (std::uint32_t line = 0; line + 1 < hatch.lines(); ++line) {
    const std::size_t below = hatch.first_piece(line), above = hatch.first_piece(line + 1);
    const std::size_t count = above - below;
    // A flow begins with a piece laid from its first end to its last.
    first_is_open.resize(count, false);
    if (hatch.first_piece(line + 2) - above != count) {
      first_is_open.clear();
      continue;
    }
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t side = first_is_open[k] ? 0 : 1;
      const std::size_t from = 2 * (below + k) + side, to = 2 * (above + k) + side;
      const Point2 a = hatch.ends()[from].point, b = hatch.ends()[to].point;
      const bool joined = !edges || edges->covers(a, b);
      if (joined) joints.push_back({from, to, {a, b}});
      first_is_open[k] = joined && !first_is_open[k];
    }
  }
  return joints;
}

std::vector<Joint> join_along_boundary(const Hatch& hatch, std::span<const Stretch> stretches,
                                       double max_mm) {
  std::vector<Candidate> candidates;
  for (const Stretch& stretch : stretches) {
    if (stretch.from_end == kNoEnd || stretch.from_end / 2 == stretch.to_end / 2) continue;
    const double along_mm = length_mm(stretch.path);
    if (along_mm > max_mm) continue;
    const std::uint32_t line =
        std::min(hatch.line_of_end(stretch.from_end), hatch.line_of_end(stretch.to_end));
    candidates.push_back({&stretch, along_mm, line});
  }
  std::stable_sort(
      candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
        return std::tie(a.lower_line, a.length_mm) < std::tie(b.lower_line, b.length_mm);
      });

  std::vector<Joint> joints;
  std::vector<bool> taken(hatch.ends().size(), false);
  Strokes strokes(hatch.pieces());
  for (const Candidate& candidate : candidates) {
    const Stretch& stretch = *candidate.stretch;
    if (taken[stretch.from_end] || taken[stretch.to_end]) continue;
    if (!strokes.join(stretch.from_end / 2, stretch.to_end / 2)) continue;
    taken[stretch.from_end] = taken[stretch.to_end] = true;
    joints.push_back({stretch.from_end, stretch.to_end, stretch.path});
  }
  return joints;
}

}  // namespace routebench
