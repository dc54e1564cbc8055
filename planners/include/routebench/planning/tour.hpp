#pragma once
/// Short orders for things that can each be laid in several ways.

#include <cstdint>
#include <vector>

#include "routebench/planning/planner.hpp"

namespace routebench {

/// Where something begins and ends if it is laid in one of its ways.
struct Way {
  Point2 in;
  Point2 out;
};

/// What is laid in one go. Ways come in pairs: way w and its reverse w ^ 1. A stroke has one pair,
/// a zigzag that can begin on either side two.
struct TourItem {
  std::vector<Way> ways;
};

/// One stop of a tour: an item and the way in which it is laid.
struct Visit {
  std::uint32_t item = 0;
  std::uint32_t way = 0;
  friend bool operator==(const Visit&, const Visit&) = default;
};

/// An order of all items and a way for each, with short gaps from `start` on: nearest first, then
/// made shorter by turning stretches of the tour round, moving single items and changing ways until
/// nothing of that helps. Never longer than nearest first.
///
/// Throws Error{kStopped} when asked to stop.
/// Cost   n times a window of 250 for each of a few passes.
/// Source generalised travelling salesman's path; moves of G. Croes, 1958 (2-opt) and I. Or, 1976.
[[nodiscard]] std::vector<Visit> short_tour(const std::vector<TourItem>& items, Point2 start,
                                            const PlanContext& context);

/// Strokes in such an order, turned round where that helps.
[[nodiscard]] std::vector<Stroke> in_short_order(std::vector<Stroke> strokes, Point2 start,
                                                 const PlanContext& context);

}  // namespace routebench
