#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <ostream>
#include <string>
#include <string_view>
#include <utility>

#include "layer_files/read_polygons.hpp"
#include "layer_files/text_cursor.hpp"
#include "routebench/geometry/layer_io.hpp"
#include "routebench/geometry/region.hpp"

namespace routebench {
namespace {

using layer_files::append_number;
using layer_files::TextCursor;

constexpr std::string_view kMaterialClass = "material";
constexpr std::string_view kSolidClass = "solid";
constexpr double kMarginMm = 1;
constexpr double kLongerSidePx = 800;

std::string number(double value) {
  std::string text;
  append_number(text, value);
  return text;
}

void append_ring(std::string& path, const Ring& ring) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    path += i == 0 ? 'M' : 'L';
    append_number(path, ring[i].x);
    path += ' ';
    append_number(path, ring[i].y);
  }
  path += 'Z';
}

void append_paths(std::string& text, const Polygons& polygons, std::string_view name,
                  std::string_view colour) {
  for (const Polygon& polygon : polygons) {
    text += "<path class=\"" + std::string(name) + "\" fill=\"" + std::string(colour) + "\" d=\"";
    append_ring(text, polygon.outer);
    for (const Ring& hole : polygon.holes) append_ring(text, hole);
    text += "\"/>\n";
  }
}

using Attributes = std::map<std::string, std::pair<std::string_view, std::size_t>, std::less<>>;

/// Reads the elements and attributes of the files that write_svg writes; no general XML.
class SvgReader {
 public:
  SvgReader(std::string_view text, const std::string& file)
      : text_(text), file_(file), in_(text, file) {}

  Layer read() {
    while (next_tag()) {
      if (tag_ == "svg" && !found_)
        read_head();
      else if (tag_ == "path")
        read_path();
    }
    if (!found_)
      in_.fail("expected an <svg> element with data-index, data-z-mm and data-height-mm");
    if (!closed_) in_.fail("the file ends before </svg>: it is cut short");
    layer_.polygons = layer_files::sound_polygons(std::move(layer_.polygons)).polygons;
    layer_.solid = layer_files::sound_polygons(std::move(layer_.solid)).polygons;
    return std::move(layer_);
  }

 private:
  /// Steps to the next opening tag and reads its attributes. False at the end of the file.
  bool next_tag() {
    while (!in_.at_end()) {
      if (!in_.accept('<')) {
        in_.advance();
        continue;
      }
      if (in_.accept_text("!--")) {
        skip_past("-->", "comment");
      } else if (in_.accept_text("/svg")) {
        closed_ = true;
      } else if (in_.peek() != '?' && in_.peek() != '!' && in_.peek() != '/') {
        read_tag();
        return true;
      }
    }
    return false;
  }

  void skip_past(std::string_view mark, const std::string& what) {
    const std::size_t begin = in_.place();
    while (!in_.at_end()) {
      if (in_.accept_text(mark)) return;
      in_.advance();
    }
    in_.fail_at(begin, "the " + what + " does not end");
  }

  void read_tag() {
    begin_ = in_.place();
    tag_ = in_.word();
    in_.move_to(begin_ + tag_.size());
    attributes_.clear();
    for (in_.skip_spaces(); !in_.accept('>'); in_.skip_spaces()) {
      if (in_.accept('/')) continue;
      read_attribute();
    }
  }

  void read_attribute() {
    const std::size_t begin = in_.place();
    while (!in_.at_end() &&
           std::string_view("=<>\"' \t\r\n").find(in_.peek()) == std::string_view::npos)
      in_.advance();
    std::string name(text_.substr(begin, in_.place() - begin));
    in_.skip_spaces();
    if (name.empty() || !in_.accept('=')) in_.fail_at(begin, "expected an attribute or '>'");
    in_.skip_spaces();
    const char quote = in_.peek();
    if (quote != '"' && quote != '\'') in_.fail("expected a quoted value");
    in_.advance();
    const std::size_t value = in_.place();
    const std::size_t end = text_.find(quote, value);
    if (end == std::string_view::npos) in_.fail("the value does not end");
    in_.move_to(end + 1);
    attributes_[std::move(name)] = {text_.substr(value, end - value), value};
  }

  /// A cursor over an attribute's value, which keeps its place in the file.
  TextCursor value_of(std::string_view name) {
    const auto found = attributes_.find(name);
    if (found == attributes_.end())
      in_.fail_at(begin_, "<" + std::string(tag_) + "> has no attribute " + std::string(name));
    const auto& [value, place] = found->second;
    TextCursor cursor(text_.substr(0, place + value.size()), file_);
    cursor.move_to(place);
    return cursor;
  }

  template <typename Read>
  auto read_whole(std::string_view name, Read&& read) {
    TextCursor value = value_of(name);
    value.skip_spaces();
    const auto result = read(value);
    value.skip_spaces();
    if (!value.at_end()) value.fail("expected nothing more in " + std::string(name));
    return result;
  }

  void read_head() {
    found_ = true;
    layer_.index = read_whole("data-index", [](TextCursor& in) { return in.index("data-index"); });
    layer_.z_mm = read_whole("data-z-mm", [](TextCursor& in) { return in.number("data-z-mm"); });
    layer_.height_mm =
        read_whole("data-height-mm", [](TextCursor& in) { return in.number("data-height-mm"); });
    layer_.repaired = read_whole("data-repaired", [](TextCursor& in) {
      if (in.accept_word("true")) return true;
      if (in.accept_word("false")) return false;
      in.fail("data-repaired must be true or false");
    });
  }

  void read_path() {
    if (!found_) in_.fail_at(begin_, "expected <svg> before <path>");
    TextCursor name = value_of("class");
    const bool solid = name.accept_word(kSolidClass);
    if (!solid && !name.accept_word(kMaterialClass))
      name.fail("a path's class must be material or solid");
    (solid ? layer_.solid : layer_.polygons).push_back(read_polygon(value_of("d")));
  }

  /// M x y L x y ... Z for the outer ring, then for every hole.
  static Polygon read_polygon(TextCursor in) {
    Polygon polygon;
    bool first = true;
    for (in.skip_spaces(); !in.at_end() || first; in.skip_spaces()) {
      const std::size_t begin = in.place();
      if (!in.accept('M')) in.fail("expected M, the beginning of a ring");
      std::vector<Point2> points{read_point(in)};
      for (in.skip_spaces(); in.accept('L'); in.skip_spaces()) points.push_back(read_point(in));
      if (!in.accept('Z')) in.fail("expected L and a point, or Z");
      if (points.size() < 3) in.fail_at(begin, "a ring needs at least three points");
      Ring ring = layer_files::read_ring(points);
      if (std::exchange(first, false))
        polygon.outer = std::move(ring);
      else
        polygon.holes.push_back(std::move(ring));
    }
    return polygon;
  }

  static Point2 read_point(TextCursor& in) {
    Point2 p;
    for (double* const coordinate : {&p.x, &p.y}) {
      in.skip_spaces();
      if (coordinate == &p.y && in.accept(',')) in.skip_spaces();
      const std::size_t place = in.place();
      *coordinate = in.number("a coordinate");
      if (std::abs(*coordinate) > layer_files::kMaxCoordinateMm)
        in.fail_at(place, "coordinates must be at most 1000 m from the origin");
    }
    return p;
  }

  std::string_view text_;
  std::string file_;
  TextCursor in_;
  std::size_t begin_ = 0;  // of the current tag
  std::string_view tag_;
  Attributes attributes_;
  bool found_ = false;
  bool closed_ = false;
  Layer layer_;
};

}  // namespace

PictureSize picture_size(double width_mm, double height_mm) {
  const double px_per_mm = kLongerSidePx / std::max(width_mm, height_mm);
  const auto whole = [](double px) { return std::max(1.0, std::round(px)); };
  return {whole(width_mm * px_per_mm), whole(height_mm * px_per_mm)};
}

void write_svg(std::ostream& out, const Layer& layer) {
  Box2 box = bounding_box(layer.polygons);
  if (layer.polygons.empty()) box = {};
  const double left = box.lower.x - kMarginMm, top = -box.upper.y - kMarginMm;
  const double width_mm = box.upper.x - box.lower.x + 2 * kMarginMm;
  const double height_mm = box.upper.y - box.lower.y + 2 * kMarginMm;
  const PictureSize shown = picture_size(width_mm, height_mm);
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  text += "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + number(shown.width_px) +
          "\" height=\"" + number(shown.height_px) + "\" viewBox=\"" + number(left) + " " +
          number(top) + " " + number(width_mm) + " " + number(height_mm) + "\" data-index=\"" +
          std::to_string(layer.index) + "\" data-z-mm=\"" + number(layer.z_mm) +
          "\" data-height-mm=\"" + number(layer.height_mm) + "\" data-repaired=\"" +
          (layer.repaired ? "true" : "false") + "\">\n";
  text += "<g transform=\"scale(1 -1)\" fill-rule=\"evenodd\">\n";
  append_paths(text, layer.polygons, kMaterialClass, "#b8b8b8");
  append_paths(text, layer.solid, kSolidClass, "#6e6e6e");
  text += "</g>\n</svg>\n";
  out << text;
}

Layer read_svg(const std::filesystem::path& file) {
  const std::string text = layer_files::read_file(file);
  return SvgReader(text, file.string()).read();
}

}  // namespace routebench
