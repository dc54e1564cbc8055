#pragma once
/// Pairs of points that lie near each other.

#include <cstdint>
#include <span>
#include <vector>

#include "routebench/geometry/types.hpp"

namespace routebench {

/// For every point the point that it is paired with.
using Matching = std::vector<std::uint32_t>;

/// Sum of the distances between partners, each pair once, mm.
[[nodiscard]] double length_mm(std::span<const Point2> points, const Matching& matching);

/// Pairs points in their order, each with the nearest one that is still free.
///
/// Takes   an even number of points; they may repeat.
/// Throws  Error{kBadUsage} if their number is odd.
/// Cost    O(n log n) typical.
/// Source  S. Lei, 2015, second step of making a graph Eulerian.
[[nodiscard]] Matching greedy_matching(std::span<const Point2> points);

/// Pairs points so that the sum of the distances is the least possible, to the grid (2^-20 mm a
/// pair).
///
/// Solves exactly on a few near neighbours of each point and the pairs of greedy_matching, then
/// asks the solution's prices whether any pair that was left out could make it shorter, and solves
/// again with such pairs until none is left: the optimum among all pairs.
///
/// Takes   an even number of points; they may repeat; |coordinate| < 2^20 mm.
/// Throws  Error{kBadUsage} if their number is odd.
/// Cost    about O(n^1.5 log n) on points that are spread evenly.
/// Source  J. Edmonds, 1965, by the implementation in LEMON.
[[nodiscard]] Matching minimum_matching(std::span<const Point2> points);

}  // namespace routebench
