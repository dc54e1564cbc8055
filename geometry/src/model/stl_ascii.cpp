#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "large_vector.hpp"
#include "model/facet_sink.hpp"
#include "model/join_parts.hpp"
#include "model/quick_float.hpp"
#include "model/stl_reader.hpp"
#include "routebench/geometry/error.hpp"

namespace routebench::models {
namespace {

/// Whether a word is a keyword, in any case. `keyword` is lower case.
bool is_keyword(std::string_view word, std::string_view keyword) noexcept {
  return word.size() == keyword.size() &&
         std::equal(word.begin(), word.end(), keyword.begin(),
                    [](char have, char want) { return (have | 0x20) == want; });
}

bool is_line_end(char c) noexcept { return c == '\n' || c == '\r'; }
/// Blanks, tabs, line ends and other control bytes; bytes of UTF-8 are not.
bool is_blank(char c) noexcept { return c >= 0 && c <= ' '; }

/// Reads facets from text. Only the words facet, vertex, endloop, endfacet, solid and endsolid
/// matter; whatever else stands between them is passed over, as writers put their own words there.
class AsciiStl {
 public:
  AsciiStl(std::span<const char> bytes, const ReadContext& context)
      : begin_(bytes.data()),
        at_(begin_),
        end_(begin_ + bytes.size()),
        context_(context),
        // Writers take some 200 bytes a facet.
        sink_(
            context, [this](std::size_t count) { return room(count); },
            std::min<std::size_t>(bytes.size() / 200 + 1, kMostTriangles)) {
    if (std::string_view(begin_, bytes.size()).starts_with("\xEF\xBB\xBF")) at_ += 3;
  }

  /// What was read of it.
  struct Result {
    std::vector<FloatPoint> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::size_t facets = 0;            ///< left out ones included
    std::optional<bool> inside_solid;  ///< at the end; nothing if no solid began or ended
    std::string cut;                   ///< a warning, if it ends inside a facet
  };

  Result read() {
    while (next_word()) {
      if (is_keyword(word_, "facet")) {
        if (begins_facet() && !read_facet()) break;
      } else if (is_keyword(word_, "solid")) {
        inside_solid_ = true;
        pass_name();
      } else if (is_keyword(word_, "endsolid")) {
        inside_solid_ = false;
        pass_name();
      }
    }
    std::vector<FloatPoint> vertices = sink_.take_vertices();
    return {std::move(vertices), std::move(triangles_), sink_.seen(), inside_solid_, cut_};
  }

 private:
  [[nodiscard]] std::array<std::uint32_t, 3>* room(std::size_t count) {
    triangles_.resize(triangles_.size() + count);
    return triangles_.data() + triangles_.size() - count;
  }

  [[noreturn]] void refuse(const std::string& complaint) const {
    refuse_model(context_.name, complaint);
  }

  /// "line 12", counting \n, \r\n and \r.
  [[nodiscard]] std::string line(const char* place) const {
    std::size_t lines = 1;
    for (const char* p = begin_; p < place; ++p) {
      const bool pair = *p == '\r' && p + 1 < end_ && p[1] == '\n';
      if (is_line_end(*p) && !pair) ++lines;
    }
    return "line " + std::to_string(lines);
  }

  [[nodiscard]] std::string this_facet(const char* place) const {
    return "facet " + std::to_string(sink_.seen() + 1) + " (" + line(place) + ")";
  }

  /// The next word into word_; false at the end.
  bool next_word() noexcept {
    while (at_ < end_ && is_blank(*at_)) ++at_;
    const char* const start = at_;
    while (at_ < end_ && !is_blank(*at_)) ++at_;
    word_ = {start, static_cast<std::size_t>(at_ - start)};
    return !word_.empty();
  }

  /// Looks one word ahead.
  [[nodiscard]] std::string_view peek_word() noexcept {
    const char* const here = at_;
    const std::string_view current = word_;
    next_word();
    at_ = here;
    return std::exchange(word_, current);
  }

  /// Whether the word facet, just read, is the keyword and not a part of some remark.
  [[nodiscard]] bool begins_facet() noexcept {
    const std::string_view next = peek_word();
    const bool cut_off = next.data() + next.size() == end_;
    return is_keyword(next, "normal") || is_keyword(next, "outer") || cut_off;
  }

  /// Passes over a solid's name: to the end of the line, or to a facet if all is on one line. A
  /// name may contain keywords, but hardly a normal with its number.
  void pass_name() noexcept {
    const char* const line_end = std::find_if(at_, end_, is_line_end);
    while (next_word() && word_.data() < line_end) {
      if (!is_keyword(word_, "facet") || !is_keyword(peek_word(), "normal")) continue;
      const char* const facet = word_.data();
      next_word();
      const std::string_view number = peek_word();
      const bool real = !number.empty() && number.data() < line_end &&
                        std::string_view("+-.0123456789").find(number[0]) != std::string_view::npos;
      if (!real) continue;
      at_ = facet;
      return;
    }
    at_ = line_end;
  }

  /// Reads from the normal to endfacet. False if the file ends before.
  bool read_facet() {
    const char* const start = word_.data();
    Facet facet{};
    std::size_t corners = 0;
    while (next_word()) {
      if (is_keyword(word_, "vertex")) {
        if (corners == 3) refuse(this_facet(start) + " has more than three corners");
        if (!read_corner(facet[corners])) break;
        ++corners;
      } else if (is_keyword(word_, "endfacet")) {
        if (corners < 3) {
          refuse(this_facet(start) + " has " + counted(corners, "corner") + ", but must have 3");
        }
        sink_.add(facet, [&] { return line(start); });
        return true;
      } else if (is_keyword(word_, "endsolid") || (is_keyword(word_, "facet") && begins_facet())) {
        refuse(this_facet(start) + " has no endfacet before " + line(word_.data()));
      }
    }
    cut_ = "cut short: the file ends inside " + this_facet(start);
    if (!context_.repair) refuse(cut_ + "; with --repair the whole facets are read");
    cut_ += "; " + counted(sink_.seen(), "whole facet") + " read";
    return false;
  }

  /// Reads three numbers. False if the file ends before they are complete.
  bool read_corner(std::array<float, 3>& corner) {
    for (float& coordinate : corner) {
      while (at_ < end_ && is_blank(*at_)) ++at_;
      if (const char* const after = quick_float(at_, end_, coordinate)) {
        at_ = after;
        continue;
      }
      if (!next_word()) return false;
      coordinate = number();
    }
    if (at_ == end_) return false;  // the last number may have lost digits
    const std::string_view next = peek_word();
    const bool fourth = !next.empty() && (next[0] == '-' || (next[0] >= '0' && next[0] <= '9'));
    if (fourth) {
      refuse(this_facet(next.data()) + ": a corner with more than three numbers (" +
             in_quotes(next) + ")");
    }
    return true;
  }

  /// The number that word_ is.
  [[nodiscard]] float number() const {
    const char* first = word_.data();
    const char* const last = first + word_.size();
    if (*first == '+' && word_.size() > 1) ++first;
    float value = 0;
    const auto [stop, error] = std::from_chars(first, last, value);
    if (error == std::errc() && stop == last) return value;
    if (error == std::errc::result_out_of_range && stop == last) return out_of_range(first, last);
    const std::string shown = in_quotes(word_);
    if (word_.find(',') != std::string_view::npos) {
      refuse(this_facet(first) + ": " + shown +
             " is written with a comma; a number must have a decimal point");
    }
    refuse(this_facet(first) + ": " + shown + " is not a number");
  }

  /// Numbers too small for single precision are 0; too large ones are infinite and refused as such.
  [[nodiscard]] static float out_of_range(const char* first, const char* last) {
    double value = 0;
    const bool known = std::from_chars(first, last, value).ec == std::errc();
    const std::string_view text(first, static_cast<std::size_t>(last - first));
    const bool tiny = known ? std::abs(value) < 1
                            : text.find("e-") != std::string_view::npos ||
                                  text.find("E-") != std::string_view::npos;
    return tiny ? 0.0F : std::numeric_limits<float>::infinity();
  }

  const char* begin_;
  const char* at_;
  const char* end_;
  std::string_view word_;
  const ReadContext& context_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  FacetSink sink_;
  std::optional<bool> inside_solid_;
  std::string cut_;  ///< a warning about how the file ends
};

/// Where the first line from `from` on begins, the one at `from` left out, that opens a facet as
/// every writer does; the end of the text if there is none. A solid's name ends with its line, so
/// whoever reads on from there is in no name.
std::size_t next_facet_line(std::string_view text, std::size_t from) {
  const auto keyword_at = [&](std::size_t& at, std::string_view keyword) {
    while (at < text.size() && is_blank(text[at])) ++at;
    if (!is_keyword(text.substr(at, keyword.size()), keyword)) return false;
    at += keyword.size();
    return at < text.size() && is_blank(text[at]);
  };
  while ((from = text.find_first_of("\n\r", from)) != std::string_view::npos) {
    std::size_t at = from;
    if (keyword_at(at, "facet") && keyword_at(at, "normal")) return from;
    ++from;
  }
  return text.size();
}

/// Sections of some megabytes that begin with facets; the same for every number of threads.
std::vector<std::span<const char>> sections_of(std::span<const char> bytes) {
  constexpr std::size_t kBytesPerSection = std::size_t{1} << 23U;
  std::vector<std::span<const char>> sections;
  for (std::size_t begin = 0, end = 0; begin < bytes.size(); begin = end) {
    end = bytes.size() - begin > kBytesPerSection
              ? next_facet_line({bytes.data(), bytes.size()}, begin + kBytesPerSection)
              : bytes.size();
    sections.push_back(bytes.subspan(begin, end - begin));
  }
  return sections;
}

/// Reads all sections at the same time. A fault in any of them is looked at again in one reading
/// from the beginning, which knows numbers of facets and lines, and whether it is a fault at all.
std::vector<AsciiStl::Result> read_sections(std::span<const char> bytes,
                                            const ReadContext& context) {
  const std::vector<std::span<const char>> sections = sections_of(bytes);
  std::vector<AsciiStl::Result> results(sections.size());
  std::vector<std::uint8_t> faulty(sections.size(), sections.size() > 1 ? 0 : 1);
  if (sections.size() > 1) {
    context.parallel_for(sections.size(), [&](std::size_t i) {
      try {
        results[i] = AsciiStl(sections[i], context).read();
        faulty[i] = results[i].cut.empty() ? 0 : 1;
      } catch (const Error&) {
        faulty[i] = 1;
      }
    });
  }
  if (std::find(faulty.begin(), faulty.end(), 1) == faulty.end()) return results;
  results.resize(1);
  results[0] = AsciiStl(bytes, context).read();
  return results;
}

}  // namespace

RawMesh read_ascii_stl(std::span<const char> bytes, const ReadContext& context) {
  std::vector<AsciiStl::Result> results = read_sections(bytes, context);
  std::vector<WeldedPart> parts;
  std::vector<std::size_t> end;  // of the parts' triangles among all
  std::size_t triangles = 0;
  std::size_t facets = 0;
  bool inside_solid = false;
  for (AsciiStl::Result& result : results) {
    parts.push_back({std::move(result.vertices), result.triangles});
    end.push_back(triangles += result.triangles.size());
    facets += result.facets;
    inside_solid = result.inside_solid.value_or(inside_solid);
  }
  if (facets == 0) refuse_model(context.name, "an ASCII STL file without any whole facet");
  refuse_too_many_triangles(context.name, facets);
  RawMesh raw;
  raw.single_precision = true;
  raw.mesh.vertices = join_parts(parts, context.parallel_for);
  resize_large(raw.mesh.triangles, triangles, context.parallel_for);
  context.parallel_for(results.size(), [&](std::size_t i) {
    const auto& own = results[i].triangles;
    std::copy(own.begin(), own.end(), raw.mesh.triangles.data() + (end[i] - own.size()));
  });
  warn_of_dropped(facets - triangles, raw.warnings);
  const std::string& cut = results.back().cut;
  if (!cut.empty()) {
    raw.warnings.push_back(cut);
  } else if (inside_solid) {
    raw.warnings.emplace_back("no endsolid: the file may be cut short");
  }
  return raw;
}

}  // namespace routebench::models
