#pragma once
/// A set of samples from which capsules take away.

#include <cstddef>
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
  /// Takes all samples within radius_mm of the polygons' boundary away.
  void remove(const Polygons& polygons, double radius_mm);

  [[nodiscard]] std::size_t count() const { return left_.count(); }

 private:
  /// Whether the box of a capsule holds any sample. In steps.
  [[nodiscard]] bool any_near(Point2 a, Point2 b, double radius) const;

  BitPlane left_;
};

}  // namespace routebench::judging
