#include <cmath>
#include <cstddef>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "layer_files/read_polygons.hpp"
#include "layer_files/text_cursor.hpp"
#include "model/raw_mesh.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/geometry/layer_io.hpp"

namespace routebench {
namespace {

using layer_files::append_number;
using layer_files::TextCursor;

constexpr std::string_view kFirstLine = "# routebench layers";
constexpr std::string_view kLayerLine = "# layer ";

void append_ring(std::string& text, const Ring& ring, const std::string& z) {
  for (std::size_t i = 0; i <= ring.size(); ++i) {
    const Point2 p = ring[i == ring.size() ? 0 : i];
    text += i == 0 ? '(' : ',';
    if (i > 0) text += ' ';
    append_number(text, p.x);
    text += ' ';
    append_number(text, p.y);
    text += z;
  }
  text += ')';
}

std::string header_of(const Layer& layer) {
  std::string text{kLayerLine};
  text += std::to_string(layer.index) + " z_mm ";
  append_number(text, layer.z_mm);
  text += " height_mm ";
  append_number(text, layer.height_mm);
  return text + (layer.repaired ? " repaired\n" : "\n");
}

std::string geometry_of(const Layer& layer) {
  if (layer.polygons.empty()) return "MULTIPOLYGON Z EMPTY\n";
  std::string z = " ";
  append_number(z, layer.z_mm);
  std::string text = "MULTIPOLYGON Z (";
  for (std::size_t i = 0; i < layer.polygons.size(); ++i) {
    text += i == 0 ? "(" : ", (";
    append_ring(text, layer.polygons[i].outer, z);
    for (const Ring& hole : layer.polygons[i].holes) {
      text += ", ";
      append_ring(text, hole, z);
    }
    text += ')';
  }
  return text + ")\n";
}

class WktReader {
 public:
  WktReader(std::string_view text, const std::string& file, double layer_height_mm)
      : in_(text, file), layer_height_mm_(layer_height_mm) {}

  std::vector<Layer> read() {
    in_.accept_text("\xEF\xBB\xBF");  // byte order mark
    for (in_.skip_spaces(); !in_.at_end(); in_.skip_spaces()) {
      if (in_.peek() == '#')
        read_comment();
      else
        read_layer();
    }
    if (ours_ && layers_.size() != headers_.size())
      in_.fail("the file announces " + std::to_string(headers_.size()) + " layers but has " +
               std::to_string(layers_.size()) + ": it is cut short or was edited");
    if (layers_.empty()) in_.fail("the file has no layer: expected a MULTIPOLYGON a line");
    return std::move(layers_);
  }

  /// The layers that were not taken to the letter, by index.
  [[nodiscard]] const std::vector<int>& unsound_layers() const noexcept { return unsound_layers_; }

 private:
  /// How many numbers a point has; unknown until the first point where the keyword does not say.
  enum class Points { kUnknown, kPlane, kWithZ };

  void read_comment() {
    if (in_.accept_text(kFirstLine))
      ours_ = true;
    else if (ours_ && in_.accept_text(kLayerLine))
      headers_.push_back(read_header());
    while (!in_.at_end() && in_.peek() != '\n' && in_.peek() != '\r') in_.advance();
  }

  Layer read_header() {
    Layer layer;
    layer.index = in_.index("the layer's index");
    layer.z_mm = read_named("z_mm");
    layer.height_mm = read_named("height_mm");
    in_.skip_blanks();
    layer.repaired = in_.accept_word("repaired");
    in_.skip_blanks();
    if (!at_line_end()) in_.fail("expected the end of the line or 'repaired'");
    return layer;
  }

  double read_named(std::string_view name) {
    in_.skip_blanks();
    if (!in_.accept_text(name)) in_.fail("expected '" + std::string(name) + "' and a number");
    in_.skip_blanks();
    return in_.number(name);
  }

  void read_layer() {
    const std::size_t begin = in_.place();
    points_ = Points::kUnknown;
    z_mm_.reset();
    Polygons polygons = read_geometry();
    in_.skip_blanks();
    if (!at_line_end())
      in_.fail("expected the end of the line after the geometry: one layer a line");
    Layer layer = placed(begin);
    layer_files::SoundPolygons sound = layer_files::sound_polygons(std::move(polygons));
    layer.polygons = std::move(sound.polygons);
    if (!sound.as_given) unsound_layers_.push_back(layer.index);
    layers_.push_back(std::move(layer));
  }

  /// A layer without polygons where the file says or, if it does not, where counting leads.
  Layer placed(std::size_t begin) {
    const std::size_t number = layers_.size();
    Layer layer;
    if (ours_) {
      if (number >= headers_.size())
        in_.fail_at(begin, "there is no line '" + std::string(kLayerLine) + "...' for this layer");
      layer = headers_[number];
      if (z_mm_ && *z_mm_ != layer.z_mm)
        in_.fail_at(begin, "the layer's z differs from the one that its comment states");
    } else {
      if (!(layer_height_mm_ > 0 && std::isfinite(layer_height_mm_)))
        throw Error(ErrorKind::kBadUsage, "the layer height must be a number above 0");
      layer.index = static_cast<int>(number);
      layer.height_mm = layer_height_mm_;
      layer.z_mm = z_mm_ ? *z_mm_ : (layer.index + 0.5) * layer_height_mm_;
    }
    if (number > 0 && !(layer.z_mm > layers_.back().z_mm && layer.index > layers_.back().index))
      in_.fail_at(begin,
                  "layers must rise from line to line; all polygons of one layer make one "
                  "MULTIPOLYGON");
    return layer;
  }

  Polygons read_geometry() {
    const std::size_t begin = in_.place();
    bool multi = true;
    if (in_.accept_word("MULTIPOLYGONZ") || in_.accept_word("POLYGONZ")) {
      points_ = Points::kWithZ;
      multi = begin + std::string_view("POLYGONZ").size() != in_.place();
    } else if (in_.accept_word("POLYGON")) {
      multi = false;
    } else if (!in_.accept_word("MULTIPOLYGON")) {
      in_.fail("expected MULTIPOLYGON or POLYGON, one layer a line");
    }
    in_.skip_blanks();
    if (in_.accept_word("Z")) points_ = Points::kWithZ;
    in_.skip_blanks();
    if (in_.accept_word("EMPTY")) return {};
    if (!in_.word().empty())
      in_.fail("'" + std::string(in_.word()) +
               "' is not understood here: expected Z, EMPTY or '('");
    Polygons polygons;
    if (multi)
      read_list([&] { polygons.push_back(read_polygon()); });
    else
      polygons.push_back(read_polygon());
    return polygons;
  }

  Polygon read_polygon() {
    Polygon polygon;
    in_.skip_blanks();
    if (in_.accept_word("EMPTY")) return polygon;
    bool first = true;
    read_list([&] {
      Ring ring = read_ring();
      if (std::exchange(first, false))
        polygon.outer = std::move(ring);
      else
        polygon.holes.push_back(std::move(ring));
    });
    return polygon;
  }

  Ring read_ring() {
    in_.skip_blanks();
    const std::size_t begin = in_.place();
    std::vector<Point2> points;
    read_list([&] { points.push_back(read_point()); });
    if (points.front() != points.back())
      in_.fail_at(begin, "the ring does not end at its first point");
    if (points.size() < 4)
      in_.fail_at(begin, "a ring needs three points, and the first one again at its end");
    return layer_files::read_ring(points);
  }

  Point2 read_point() {
    Point2 p;
    p.x = read_coordinate("x");
    p.y = read_coordinate("y");
    in_.skip_blanks();
    const bool more = in_.peek() != ',' && in_.peek() != ')';
    if (points_ == Points::kUnknown) points_ = more ? Points::kWithZ : Points::kPlane;
    if (points_ == Points::kPlane) {
      if (more) in_.fail("expected ',' or ')' after y: the points before have no z");
      return p;
    }
    const std::size_t place = in_.place();
    const double z_mm = read_coordinate("z");
    if (!z_mm_) z_mm_ = z_mm;
    if (*z_mm_ != z_mm) in_.fail_at(place, "all points of a layer must have the same z");
    return p;
  }

  double read_coordinate(std::string_view name) {
    in_.skip_blanks();
    const std::size_t place = in_.place();
    const double mm = in_.number(name);
    if (std::abs(mm) > layer_files::kMaxCoordinateMm)
      in_.fail_at(place, std::string(name) + " must be at most 1000 m from the origin");
    return mm;
  }

  /// '(' item ',' item ... ')'
  template <typename ReadItem>
  void read_list(ReadItem&& read_item) {
    in_.skip_blanks();
    if (!in_.accept('(')) in_.fail("expected '('");
    do {
      read_item();
      in_.skip_blanks();
    } while (in_.accept(','));
    if (!in_.accept(')')) in_.fail("expected ',' or ')'");
  }

  [[nodiscard]] bool at_line_end() const {
    return in_.at_end() || in_.peek() == '\n' || in_.peek() == '\r';
  }

  TextCursor in_;
  double layer_height_mm_;
  bool ours_ = false;  // announces every layer in a comment
  std::vector<Layer> headers_;
  std::vector<Layer> layers_;
  std::vector<int> unsound_layers_;
  Points points_ = Points::kUnknown;  // of the current layer
  std::optional<double> z_mm_;
};

}  // namespace

void write_wkt(std::ostream& out, const std::vector<Layer>& layers) {
  out << kFirstLine << ", millimetres\n";
  for (const Layer& layer : layers) out << header_of(layer);
  for (const Layer& layer : layers) out << geometry_of(layer);
}

std::vector<Layer> read_wkt(const std::filesystem::path& file, double layer_height_mm,
                            std::vector<std::string>* warnings) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored))
    throw Error(ErrorKind::kBadInput, file.string() + ": is a folder, not a file of layers");
  const std::string text = layer_files::read_file(file);
  WktReader reader(text, file.string(), layer_height_mm);
  std::vector<Layer> layers = reader.read();
  const std::vector<int>& unsound = reader.unsound_layers();
  if (warnings != nullptr && !unsound.empty())
    warnings->push_back(models::counted(unsound.size(), "layer") + " of " +
                        std::to_string(layers.size()) + ", first layer " +
                        std::to_string(unsound.front()) +
                        ", with rings that cross or overlap or holes outside: taken for what the "
                        "outer rings enclose and the holes do not");
  return layers;
}

}  // namespace routebench
