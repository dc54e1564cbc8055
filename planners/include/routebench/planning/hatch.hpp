#pragma once
/// Parallel lines across one region, and how they are joined to longer strokes.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "routebench/geometry/types.hpp"
#include "routebench/planning/line_crossings.hpp"
#include "routebench/planning/planner.hpp"
#include "routebench/planning/ring_path.hpp"

namespace routebench {

/// A turned frame in which lines of one direction are level.
class Turn {
 public:
  /// Takes the direction of the lines, 0 along x. Multiples of 90 degrees turn exactly.
  explicit Turn(double angle_deg);

  [[nodiscard]] Point2 to_level(Point2 p) const;
  [[nodiscard]] Point2 from_level(Point2 p) const;  ///< not on the grid

 private:
  Point2 along_;
};

/// Lines over a region at multiples of distance_mm in the turned frame, so that lines of one layer
/// lie over those of another.
[[nodiscard]] EvenLines lines_over(const Polygon& region, double angle_deg, double distance_mm);

/// Lines over a region at density 1: the first and the last on its edge, the others evenly between
/// them, nearly context.spacing_mm apart and never more than a line's width.
[[nodiscard]] EvenLines fitted_lines_over(const Polygon& region, double angle_deg,
                                          const PlanContext& context);

/// How a hatch is laid.
struct HatchRule {
  double angle_deg = 0;
  EvenLines lines;  ///< in the turned frame
  CrossingSearch search = CrossingSearch::kBucket;
  double end_gap_mm = 0;     ///< ends are pulled in along the line by this
  double min_length_mm = 0;  ///< shorter lines are left out
};

/// The lines across one polygon. Line pieces are numbered from the lowest line upwards, along each
/// line; piece i has the ends 2 i (first along the line) and 2 i + 1.
class Hatch {
 public:
  struct End {
    Point2 point;     ///< on the grid
    double x = 0;     ///< in the turned frame
    RingPlace place;  ///< where the line meets the boundary
    std::uint32_t ring = 0;
  };

  Hatch(const Polygon& region, const HatchRule& rule);

  [[nodiscard]] const std::vector<Ring>& rings() const noexcept { return rings_; }
  [[nodiscard]] const std::vector<End>& ends() const noexcept { return ends_; }
  [[nodiscard]] std::size_t pieces() const noexcept { return ends_.size() / 2; }
  [[nodiscard]] std::uint32_t lines() const noexcept { return rule_.lines.count; }
  /// Pieces of a line: [first_piece(line), first_piece(line + 1)).
  [[nodiscard]] std::size_t first_piece(std::uint32_t line) const { return first_piece_[line]; }
  [[nodiscard]] std::uint32_t line_of_end(std::size_t end) const { return line_of_[end / 2]; }

  /// True if a piece passes within reach_mm of a point. Cost   the lines within reach, times the
  /// logarithm of their pieces.
  [[nodiscard]] bool passes_near(Point2 p, double reach_mm) const;

 private:
  HatchRule rule_;
  Turn turn_;
  std::vector<Ring> rings_;
  std::vector<End> ends_;
  std::vector<std::uint32_t> line_of_;    // of a piece
  std::vector<std::size_t> first_piece_;  // of a line; one more at the end
};

/// A stretch of a region's boundary between two ends that are neighbours on it, in the ring's
/// direction.
struct Stretch {
  std::size_t from_end = 0;
  std::size_t to_end = 0;
  std::vector<Point2> path;
};

/// All of the boundary as stretches, ring by ring. A ring without ends is one closed stretch whose
/// ends are kNoEnd.
inline constexpr std::size_t kNoEnd = static_cast<std::size_t>(-1);
[[nodiscard]] std::vector<Stretch> boundary_stretches(const Hatch& hatch);

/// Joins two ends of a hatch's pieces.
struct Joint {
  std::size_t from_end = 0;
  std::size_t to_end = 0;
  std::vector<Point2> path;  ///< from end to end, both included
};

/// Joins pieces of neighbouring lines straight while the number of pieces stays the same and, if a
/// region is given, the joint stays inside it.
/// Source   a tutorial's "flows": piece k goes on as piece k, wherever that leads.
[[nodiscard]] std::vector<Joint> join_flows(const Hatch& hatch, const Polygon* region);

/// Joins pieces whose ends are neighbours on the boundary along it, if that is at most max_mm long.
/// `stretches` are boundary_stretches(hatch). None of them is used twice, and no stroke is closed.
/// Lines are joined from the lowest upwards, which makes a zigzag where there is a choice.
[[nodiscard]] std::vector<Joint> join_along_boundary(const Hatch& hatch,
                                                     std::span<const Stretch> stretches,
                                                     double max_mm);

/// The polylines that pieces and joints make, each joint being used once.
[[nodiscard]] std::vector<std::vector<Point2>> joined_lines(const Hatch& hatch,
                                                            const std::vector<Joint>& joints);

/// What of the boundary every piece is farther from than reach_mm, as polylines; no two of them
/// nearer than that to each other, none shorter than min_length_mm. `stretches` are
/// boundary_stretches(hatch); those that joints use are left out.
/// Cost   near linear in the boundary's length over reach_mm.
[[nodiscard]] std::vector<std::vector<Point2>> bare_boundary(const Hatch& hatch,
                                                             std::span<const Stretch> stretches,
                                                             const std::vector<Joint>& joints,
                                                             double reach_mm, double min_length_mm,
                                                             const PlanContext& context);

}  // namespace routebench
