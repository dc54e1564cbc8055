#pragma once
/// A set of samples from which capsules take away.

#include <cstddef>
#include <vector>

#include "judge/bit_plane.hpp"
#include "judge/capsule.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench::judging {

/// Samples that no capsule has met yet. Where most are gone soon, or few were there to begin with,
/// most capsules find none in their box and are passed over.
class SamplesLeft {
 public:
  explicit SamplesLeft(BitPlane samples);

  /// Takes all samples within radius_mm of segment ab away.
  void remove(Point2 a, Point2 b, double radius_mm);
  /// Takes all samples within radius_mm of the polygons' boundary away.
  void remove(const Polygons& polygons, double radius_mm);

  /// Finds where samples are left, which happens by itself now and then. Cost linear in the plane's
  /// words.
  void look();
  /// Whether nothing was left at the last look.
  [[nodiscard]] bool none() const noexcept { return none_; }
  [[nodiscard]] std::size_t count() const { return none_ ? 0 : left_.count(); }

 private:
  /// Whether the box of a capsule held any sample at the last look, to the word. In steps.
  [[nodiscard]] bool any_near(Point2 a, Point2 b, double radius) const;

  BitPlane left_;
  std::vector<Span> rows_;
  std::size_t rows_removed_ = 0;  // since the last look
  bool none_ = true;
};

}  // namespace routebench::judging
