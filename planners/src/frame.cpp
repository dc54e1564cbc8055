#include "routebench/planning/frame.hpp"

#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench {
namespace {

void move(std::vector<Point2>& points, Point2 by) {
  for (Point2& p : points) p = p + by;
}

}  // namespace

Frame::Frame(const Layer& layer, const PlanContext& context)
    : origin_(snap(context.origin)), start_(context.start - origin_), polygons_(layer.polygons) {
  const Point2 back = Point2{} - origin_;
  for (Polygon& polygon : polygons_) {
    move(polygon.outer, back);
    for (Ring& hole : polygon.holes) move(hole, back);
  }
}

Route Frame::from_frame(Route route) const {
  for (Stroke& stroke : route.strokes) move(stroke.points, origin_);
  return route;
}

}  // namespace routebench
