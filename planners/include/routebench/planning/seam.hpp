#pragma once
/// Where closed walls and loops begin.

#include <cstddef>
#include <span>

#include "routebench/geometry/types.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/planning/params.hpp"

namespace routebench {

enum class Seam { kNearest, kFixedPoint, kMinX };

/// The parameters of a seam, for planners that lay loops.
struct SeamParams {
  Seam seam = Seam::kNearest;
  double seam_x_mm = 0;
  double seam_y_mm = 0;

  void bind(ParamBinder& bind) {
    bind(
        "seam", seam,
        {{"nearest", Seam::kNearest}, {"fixed_point", Seam::kFixedPoint}, {"min_x", Seam::kMinX}},
        "where a loop begins: at its vertex nearest to the nozzle, nearest to a fixed point, or of "
        "smallest x");
    bind("seam_x_mm", seam_x_mm, {-10000, 10000}, "mm", "of the fixed point, from the origin");
    bind("seam_y_mm", seam_y_mm, {-10000, 10000}, "mm", "of the fixed point, from the origin");
  }
};

/// Orders points by x, then by y.
[[nodiscard]] constexpr bool less_by_x(Point2 a, Point2 b) noexcept {
  return a.x != b.x ? a.x < b.x : a.y < b.y;
}

/// Chooses where a closed loop may be begun.
class SeamRule {
 public:
  explicit SeamRule(const SeamParams& params)
      : seam_(params.seam), place_{params.seam_x_mm, params.seam_y_mm} {}

  /// True if a loop may begin at every vertex: at the one nearest to the nozzle.
  [[nodiscard]] bool anywhere() const noexcept { return seam_ == Seam::kNearest; }

  /// The vertex with which a ring begins, for a nozzle at `from`; of equally good ones the first.
  /// Both are as seen from the origin. Cost   linear.
  [[nodiscard]] std::size_t begin_of(std::span<const Point2> ring, Point2 from) const {
    const Point2 place = anywhere() ? from : place_;
    std::size_t best = 0;
    for (std::size_t i = 1; i < ring.size(); ++i) {
      const bool better = seam_ == Seam::kMinX ? less_by_x(ring[i], ring[best])
                                               : squared_distance(ring[i], place) <
                                                     squared_distance(ring[best], place);
      if (better) best = i;
    }
    return best;
  }

 private:
  Seam seam_;
  Point2 place_;
};

}  // namespace routebench
