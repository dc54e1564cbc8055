#include "model/text_lines.hpp"

#include <algorithm>
#include <charconv>
#include <limits>

#include "model/raw_mesh.hpp"

namespace routebench::models {
namespace {

bool is_line_end(char c) noexcept { return c == '\n' || c == '\r'; }
bool is_blank(char c) noexcept { return c >= 0 && c <= ' '; }

}  // namespace

TextLines::TextLines(std::span<const char> bytes, const std::string& name, std::size_t first_line)
    : begin_(bytes.data()),
      at_(begin_),
      end_(begin_ + bytes.size()),
      line_end_(at_),
      line_(first_line),
      name_(name) {
  if (std::string_view(begin_, bytes.size()).starts_with("\xEF\xBB\xBF")) at_ += 3;
  line_end_ = at_;
}

bool TextLines::next_line() {
  while (true) {
    const char* const next = begun_ ? begin_ + rest_offset() : at_;
    if (next == end_) {
      at_ = line_end_ = end_;
      return false;
    }
    at_ = next;
    line_ += begun_ ? 1 : 0;
    begun_ = true;
    const char* const full_end = std::find_if(at_, end_, is_line_end);
    line_end_ = std::find(at_, full_end, '#');
    while (at_ < line_end_ && is_blank(*at_)) ++at_;
    if (at_ < line_end_) return true;
  }
}

std::string_view TextLines::word() {
  while (at_ < line_end_ && is_blank(*at_)) ++at_;
  const char* const start = at_;
  while (at_ < line_end_ && !is_blank(*at_)) ++at_;
  return {start, static_cast<std::size_t>(at_ - start)};
}

std::string_view TextLines::word_on_any_line() {
  std::string_view found = word();
  while (found.empty() && next_line()) found = word();
  return found;
}

double TextLines::number(std::string_view word) const {
  const char* first = word.data();
  const char* const last = first + word.size();
  if (word.size() > 1 && *first == '+') ++first;
  double value = 0;
  const auto [stop, error] = std::from_chars(first, last, value);
  if (stop == last && error == std::errc()) return value;
  if (stop == last && error == std::errc::result_out_of_range) {
    const bool tiny =
        word.find("e-") != std::string_view::npos || word.find("E-") != std::string_view::npos;
    return tiny ? 0 : std::numeric_limits<double>::infinity();
  }
  if (word.find(',') != std::string_view::npos) {
    refuse(in_quotes(word) + " is written with a comma; a number must have a decimal point");
  }
  refuse(word.empty() ? "a number is missing" : in_quotes(word) + " is not a number");
}

std::int64_t TextLines::whole(std::string_view word) const {
  std::int64_t value = 0;
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error == std::errc() && stop == word.data() + word.size()) return value;
  refuse(word.empty() ? "a whole number is missing" : in_quotes(word) + " is not a whole number");
}

std::size_t TextLines::rest_offset() const {
  const char* next = std::find_if(std::max(at_, line_end_), end_, is_line_end);
  if (next < end_) {
    const bool pair = *next == '\r' && next + 1 < end_ && next[1] == '\n';
    next += pair ? 2 : 1;
  }
  return static_cast<std::size_t>(next - begin_);
}

void TextLines::refuse(const std::string& complaint) const {
  refuse_model(name_, place() + ": " + complaint);
}

}  // namespace routebench::models
