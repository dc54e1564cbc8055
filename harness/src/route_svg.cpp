#include "routebench/harness/route_svg.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <ostream>
#include <string>

#include "fixed_point.hpp"
#include "routebench/geometry/layer_io.hpp"

namespace routebench {
namespace {

/// Colours that readers with any kind of colour vision can tell apart (M. Okabe, K. Ito, 2008).
constexpr std::string_view kMaterialColour = "#dddddd";
constexpr std::array<std::string_view, 3> kKindColours = {"#0072b2", "#009e73", "#e69f00"};
constexpr std::string_view kTravelColour = "#d55e00";
constexpr std::string_view kMarkColour = "#000000";
constexpr double kFinestLineMm = 0.1;

/// Builds the text of attributes and elements.
class Text {
 public:
  Text& operator<<(std::string_view words) {
    text_ += words;
    return *this;
  }
  Text& operator<<(double number) {
    append_fixed(text_, number, kGridDecimals);
    return *this;
  }
  Text& operator<<(std::size_t number) {
    text_ += std::to_string(number);
    return *this;
  }
  Text& operator<<(Point2 p) { return *this << p.x << " " << p.y; }
  [[nodiscard]] const std::string& str() const { return text_; }

 private:
  std::string text_;
};

/// Everything that has to be seen.
struct Frame {
  Point2 lower{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Point2 upper{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  double widest_mm = kFinestLineMm;

  void add(Point2 p) {
    lower = {std::min(lower.x, p.x), std::min(lower.y, p.y)};
    upper = {std::max(upper.x, p.x), std::max(upper.y, p.y)};
  }
};

Frame frame_of(const Layer& layer, const Route& route, std::optional<Point2> entered_from) {
  Frame frame;
  for (const Polygon& polygon : layer.polygons)
    for (const Point2 p : polygon.outer) frame.add(p);
  for (const Stroke& stroke : route.strokes) {
    for (const Point2 p : stroke.points) frame.add(p);
    frame.widest_mm = std::max(frame.widest_mm, stroke.width_mm);
  }
  if (entered_from && !route.strokes.empty()) frame.add(*entered_from);
  if (frame.lower.x > frame.upper.x) frame.add({0, 0});
  return frame;
}

void write_head(Text& svg, const Layer& layer, const Frame& frame) {
  const double margin = 2 * frame.widest_mm;
  const double width = frame.upper.x - frame.lower.x + 2 * margin;
  const double height = frame.upper.y - frame.lower.y + 2 * margin;
  const PictureSize shown = picture_size(width, height);
  svg << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << shown.width_px << "\" height=\""
      << shown.height_px << "\" viewBox=\"" << frame.lower.x - margin << " "
      << -frame.upper.y - margin << " " << width << " " << height << "\" data-index=\""
      << std::to_string(layer.index) << "\" data-z-mm=\"" << layer.z_mm << "\" data-height-mm=\""
      << layer.height_mm << "\" data-repaired=\"" << (layer.repaired ? "true" : "false") << "\">\n"
      << "<title>layer " << std::to_string(layer.index) << ", z " << layer.z_mm << " mm</title>\n"
      << "<g transform=\"scale(1 -1)\">\n";
}

void write_ring(Text& svg, const Ring& ring) {
  for (std::size_t i = 0; i < ring.size(); ++i) svg << (i == 0 ? "M" : "L") << ring[i];
  svg << "Z";
}

void write_material(Text& svg, const Polygons& polygons) {
  svg << "<path id=\"material\" fill=\"" << kMaterialColour << "\" fill-rule=\"evenodd\" d=\"";
  for (const Polygon& polygon : polygons) {
    write_ring(svg, polygon.outer);
    for (const Ring& hole : polygon.holes) write_ring(svg, hole);
  }
  svg << "\"/>\n";
}

void write_strokes(Text& svg, const PlannedLayer& planned, StrokeKind kind) {
  svg << "<g id=\"" << to_string(kind) << "\" fill=\"none\" stroke=\""
      << kKindColours[static_cast<std::size_t>(kind)]
      << "\" stroke-opacity=\"0.7\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n";
  for (std::size_t i = 0; i < planned.route.strokes.size(); ++i) {
    if (planned.kinds[i] != kind) continue;
    const Stroke& stroke = planned.route.strokes[i];
    svg << "<path data-stroke=\"" << i << "\" stroke-width=\"" << stroke.width_mm << "\" d=\"";
    for (std::size_t k = 0; k < stroke.points.size(); ++k)
      svg << (k == 0 ? "M" : "L") << stroke.points[k];
    svg << "\"/>\n";
  }
  svg << "</g>\n";
}

void write_travels(Text& svg, const Route& route, std::optional<Point2> entered_from,
                   double line_mm) {
  svg << "<g id=\"travel\" fill=\"none\" stroke=\"" << kTravelColour << "\" stroke-width=\""
      << line_mm << "\" stroke-linecap=\"round\">\n";
  std::optional<Point2> from = entered_from;
  for (const Stroke& stroke : route.strokes) {
    const Point2 to = stroke.points.front();
    if (from && *from != to) svg << "<path d=\"M" << *from << "L" << to << "\"/>\n";
    from = stroke.points.back();
  }
  svg << "</g>\n";
}

void write_ends(Text& svg, const Route& route, double size_mm) {
  if (route.strokes.empty()) return;
  const Point2 begin = route.strokes.front().points.front();
  const Point2 end = route.strokes.back().points.back();
  // The start is hollow: where a route ends at its beginning, both are seen.
  svg << "<rect id=\"end\" fill=\"" << kMarkColour << "\" x=\"" << end.x - size_mm / 2 << "\" y=\""
      << end.y - size_mm / 2 << "\" width=\"" << size_mm << "\" height=\"" << size_mm << "\"/>\n"
      << "<circle id=\"start\" fill=\"none\" stroke=\"" << kMarkColour << "\" stroke-width=\""
      << size_mm / 4 << "\" cx=\"" << begin.x << "\" cy=\"" << begin.y << "\" r=\"" << size_mm
      << "\"/>\n";
}

}  // namespace

void write_route_svg(std::ostream& out, const Layer& layer, const PlannedLayer& planned,
                     std::optional<Point2> entered_from) {
  const Frame frame = frame_of(layer, planned.route, entered_from);
  Text svg;
  write_head(svg, layer, frame);
  write_material(svg, layer.polygons);
  for (const StrokeKind kind : {StrokeKind::kSparse, StrokeKind::kDense, StrokeKind::kWall})
    write_strokes(svg, planned, kind);
  write_travels(svg, planned.route, entered_from, std::max(kFinestLineMm, frame.widest_mm / 4));
  write_ends(svg, planned.route, frame.widest_mm);
  svg << "</g>\n</svg>\n";
  out << svg.str();
}

}  // namespace routebench
