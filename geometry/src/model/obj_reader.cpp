#include <cstdint>
#include <string_view>
#include <vector>

#include "model/face_sink.hpp"
#include "model/formats.hpp"
#include "model/text_lines.hpp"

namespace routebench::models {
namespace {

/// The vertex of a face's corner, counted from 0: "7", "7/1", "7//3", "7/1/3"; -1 is the last one
/// so far.
std::int64_t corner_of(const TextLines& lines, std::string_view word, std::size_t vertices) {
  const std::int64_t number = lines.whole(word.substr(0, word.find('/')));
  if (number == 0) lines.refuse("vertex 0: vertices are counted from 1");
  return number > 0 ? number - 1 : static_cast<std::int64_t>(vertices) + number;
}

}  // namespace

RawMesh read_obj(std::span<const char> bytes, const ReadContext& context) {
  TextLines lines(bytes, context.name);
  FaceSink sink(context);
  std::vector<std::int64_t> corners;
  while (lines.next_line()) {
    const std::string_view keyword = lines.word();
    if (keyword == "v") {
      const double x = lines.number(lines.word());
      const double y = lines.number(lines.word());
      sink.add_vertex({x, y, lines.number(lines.word())});
    } else if (keyword == "f") {
      corners.clear();
      for (std::string_view word = lines.word(); !word.empty(); word = lines.word()) {
        // A backslash says that the line goes on in the next one.
        if (word == "\\" && lines.next_line()) continue;
        corners.push_back(corner_of(lines, word, sink.vertices()));
      }
      if (corners.size() < 3) lines.refuse("a face must have three corners or more");
      sink.add_face(corners, [&lines] { return lines.place(); });
    }
    // Whatever else there is says how the surface looks, not where it is.
  }
  return sink.finish(false);
}

}  // namespace routebench::models
