#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "model/face_sink.hpp"
#include "model/formats.hpp"
#include "model/text_lines.hpp"

namespace routebench::models {
namespace {

/// A vertex is written in no less than "0 0 0\n", a face in no less than "0\n".
constexpr std::size_t kVertexBytes = 6;
constexpr std::size_t kFaceBytes = 2;

class OffReader {
 public:
  OffReader(std::span<const char> bytes, const ReadContext& context)
      : lines_(bytes, context.name), context_(context), sink_(context) {}

  RawMesh read() {
    const std::string_view first = read_keyword();
    read_counts(first);
    for (std::size_t i = 0; i < vertices_; ++i) read_vertex(i);
    std::string cut;
    for (std::size_t i = 0; i < faces_ && cut.empty(); ++i) cut = read_face(i);
    RawMesh raw = sink_.finish(false);
    if (!cut.empty()) raw.warnings.push_back(cut);
    return raw;
  }

 private:
  /// Passes over the keyword, which may be missing. Returns the word after it.
  std::string_view read_keyword() {
    const std::string_view word = lines_.word_on_any_line();
    if (!word.ends_with("OFF")) return word;
    if (word.find('4') != std::string_view::npos || word.find('n') != std::string_view::npos) {
      lines_.refuse(in_quotes(word) + " has points of other than three dimensions");
    }
    const std::string_view next = lines_.word_on_any_line();
    if (next == "BINARY") lines_.refuse("binary OFF is not read; save it as text");
    return next;
  }

  void read_counts(std::string_view first) {
    vertices_ = count(first);
    faces_ = count(lines_.word_on_any_line());
    // The third number, of edges, may be missing; nobody needs it.
    if (vertices_ > lines_.bytes_left() / kVertexBytes + 1 ||
        faces_ > lines_.bytes_left() / kFaceBytes + 1) {
      lines_.refuse("the file is too short for " + std::to_string(vertices_) + " vertices and " +
                    std::to_string(faces_) + " faces");
    }
    sink_.reserve(vertices_, faces_);
  }

  std::size_t count(std::string_view word) {
    const std::int64_t number = lines_.whole(word);
    if (number < 0) lines_.refuse("a count of " + std::to_string(number) + " cannot be meant");
    return static_cast<std::size_t>(number);
  }

  /// Normals and colours may follow on the line.
  void read_vertex(std::size_t i) {
    if (!lines_.next_line()) {
      lines_.refuse("the file ends before vertex " + std::to_string(i) + " of " +
                    std::to_string(vertices_) + " (counted from 0)");
    }
    const double x = lines_.number(lines_.word());
    const double y = lines_.number(lines_.word());
    sink_.add_vertex({x, y, lines_.number(lines_.word())});
  }

  /// Colours may follow on the line. Returns a warning if the file ends before.
  std::string read_face(std::size_t i) {
    corners_.clear();
    std::string_view word;
    if (lines_.next_line()) {
      word = lines_.word();
      const std::int64_t size = lines_.whole(word);
      for (std::int64_t c = 0; c < size && !word.empty(); ++c) {
        word = lines_.word_on_any_line();
        if (!word.empty()) corners_.push_back(lines_.whole(word));
      }
    }
    if (word.empty()) {
      std::string cut = "cut short: the file ends inside face " + std::to_string(i) + " of " +
                        std::to_string(faces_) + " (counted from 0)";
      if (!context_.repair) lines_.refuse(cut + "; with --repair the whole faces are read");
      return cut;
    }
    sink_.add_face(corners_, [this] { return lines_.place(); });
    return {};
  }

  TextLines lines_;
  const ReadContext& context_;
  FaceSink sink_;
  std::size_t vertices_ = 0;
  std::size_t faces_ = 0;
  std::vector<std::int64_t> corners_;
};

}  // namespace

bool is_off_keyword(std::string_view word) {
  constexpr std::string_view kPrefix = "STCN4n";
  return word.ends_with("OFF") && word.size() <= kPrefix.size() + 3 &&
         std::all_of(word.begin(), word.end() - 3,
                     [&](char c) { return kPrefix.find(c) != std::string_view::npos; });
}

RawMesh read_off(std::span<const char> bytes, const ReadContext& context) {
  return OffReader(bytes, context).read();
}

}  // namespace routebench::models
