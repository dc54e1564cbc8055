#pragma once
/// Nodes at nearly even distances all over a region, joined to their neighbours inside it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "routebench/geometry/edge_grid.hpp"
#include "routebench/geometry/types.hpp"
#include "routebench/planning/ring_path.hpp"

namespace routebench::eulerian {

inline constexpr std::uint32_t kNone = UINT32_MAX;

/// Distances of a lattice.
struct Pitch {
  double wanted_mm;  ///< between neighbours
  double widest_mm;  ///< never more than this in a row or column; >= wanted_mm
  double margin_mm;  ///< what lies so far outside the region is to be filled too; <= wanted_mm
  bool fit;          ///< spread over each region evenly, or at multiples of the wanted distance
};

/// Evenly spaced coordinates.
struct Axis {
  double first_mm = 0;
  double step_mm = 1;
  std::uint32_t count = 1;

  [[nodiscard]] double at(std::uint32_t i) const noexcept { return first_mm + i * step_mm; }
};

/// Spreads coordinates from low to high. Fitted, each has the same share of what is to be filled,
/// and their number is even if that costs no more than a tenth of the pitch.
[[nodiscard]] Axis axis_over(double low_mm, double high_mm, const Pitch& pitch);

/// Number of places that two axes span, with a frame of one place round them.
/// Throws Error{kBadInput} if they are more than 2^24 (a square of 1.6 m at 0.4 mm), about 30 bytes
/// each.
[[nodiscard]] std::uint32_t framed_places(const Axis& x, const Axis& y);

/// A lattice over one polygon. Nodes are numbered row by row with a frame of empty places round
/// them, so that the neighbours of a node are node +- 1 and node +- stride().
///
/// Places that lie outside by no more than the margin are pulled in to the boundary, and those
/// inside it by less than a quarter of the pitch are pushed out to it: so a region has as many
/// nodes as what is to be filled takes, and its rim follows the wall. None comes nearer than half a
/// pitch to another by that.
class Lattice {
 public:
  /// Throws  see framed_places.
  /// Cost    linear in places and boundary vertices, and in the boundary's length over the pitch.
  Lattice(const Polygon& region, const Pitch& pitch);

  [[nodiscard]] std::uint32_t stride() const noexcept { return stride_; }
  [[nodiscard]] std::uint32_t size() const noexcept {
    return static_cast<std::uint32_t>(has_.size());
  }
  [[nodiscard]] std::uint32_t first() const noexcept { return stride_ + 1; }
  /// One behind the last place that may have a node.
  [[nodiscard]] std::uint32_t last() const noexcept { return size() - stride_ - 1; }
  [[nodiscard]] bool has(std::uint32_t node) const { return has_[node]; }
  [[nodiscard]] Point2 place(std::uint32_t node) const;
  /// Column and row of a node, from 0; the frame is not counted.
  [[nodiscard]] std::uint32_t column(std::uint32_t node) const { return node % stride_ - 1; }
  [[nodiscard]] std::uint32_t row(std::uint32_t node) const { return node / stride_ - 1; }

  /// True if there is a node and one to the right of it, and a way between them.
  [[nodiscard]] bool joined_right(std::uint32_t node) const {
    return (joined_[node] & kRight) != 0;
  }
  /// The same for the one above it.
  [[nodiscard]] bool joined_up(std::uint32_t node) const { return (joined_[node] & kUp) != 0; }
  /// The same for any two nodes that are neighbours in a row, a column or a diagonal.
  [[nodiscard]] bool joined(std::uint32_t a, std::uint32_t b) const {
    return way(a, b) != Way::kBlocked;
  }

  /// Appends the way between two neighbours to a polyline that ends in the first one: straight, or
  /// along the wall where that stands in between. Takes   nodes that are joined.
  void append_way(std::uint32_t a, std::uint32_t b, std::vector<Point2>& points) const;

 private:
  static constexpr std::uint8_t kRight = 1, kUp = 2, kRightBent = 4, kUpBent = 8;

  /// A place of the boundary, as a node near it sees it.
  struct Rim {
    double squared_mm;
    RingPlace place;
    std::uint32_t ring;
    bool taken;  ///< the node lies there
  };
  struct Rings {
    std::vector<Ring> rings;
    std::vector<std::vector<double>> along_mm;  ///< of each vertex, from the ring's first
  };

  void mark_inside();
  void find_rims();
  void pull_in();
  void join();
  [[nodiscard]] bool is_free(std::uint32_t node, Point2 p) const;
  [[nodiscard]] Point2 lattice_place(std::uint32_t node) const;
  /// True if no wall can stand between two neighbours, for they are far enough from all.
  [[nodiscard]] bool is_clear(std::uint32_t a, std::uint32_t b) const;
  enum class Way { kBlocked, kStraight, kBent };
  [[nodiscard]] Way find_way(std::uint32_t a, std::uint32_t b) const;
  [[nodiscard]] Way way(std::uint32_t a, std::uint32_t b) const;  ///< remembered if not diagonal
  /// Along the wall from one node to the other; nothing if both do not lie on one wall, or far.
  [[nodiscard]] std::optional<std::vector<Point2>> along_wall(std::uint32_t a,
                                                              std::uint32_t b) const;

  Pitch pitch_;
  Axis x_, y_;
  std::uint32_t stride_ = 0;
  EdgeGrid edges_;
  Rings wall_;
  std::vector<std::uint8_t> has_;
  std::vector<std::uint8_t> joined_;
  std::vector<std::uint32_t> rim_of_;  // of a node near the boundary, in rims_
  std::vector<Rim> rims_;
};

}  // namespace routebench::eulerian
