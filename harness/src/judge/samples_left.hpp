#pragma once
/// A set of samples from which capsules take away.

#include <cstddef>
#include <span>
#include <utility>

#include "judge/bit_plane.hpp"
#include "judge/capsule.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench::judging {

/// Samples that no capsule has met yet. Where most are gone soon, or few were there to begin with,
/// most capsules find none in their box and are passed over.
class SamplesLeft {
 public:
  explicit SamplesLeft(BitPlane samples) : left_(std::move(samples)) {}

  /// Takes all samples within radius_mm of segment ab away.
  void remove(Point2 a, Point2 b, double radius_mm);
  /// The same for all segments of a path: those of a short one are passed over together.
  void remove(std::span<const Point2> path, double radius_mm);
  /// Takes all samples within radius_mm of the polygons' boundary away.
  void remove(const Polygons& polygons, double radius_mm);

  [[nodiscard]] std::size_t count() const { return left_.count(); }
  /// Whether all are gone. Cost   of all calls together, a look at every word.
  [[nodiscard]] bool empty();

 private:
  /// Whether a box that is made wider by a radius holds any sample. In steps.
  [[nodiscard]] bool any_near(Point2 lower, Point2 upper, double radius) const;
  /// Takes a capsule away. In steps.
  void remove_capsule(Point2 a, Point2 b, double radius);

  BitPlane left_;
  // Before this word of this strip there are none.
  std::size_t strip_ = 0;
  std::size_t row_ = 0;
};

}  // namespace routebench::judging
