#include "layer_files/text_cursor.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <system_error>

#include "routebench/geometry/error.hpp"

namespace routebench::layer_files {
namespace {

// The C library's functions depend on the locale; file formats do not.
bool is_blank(char c) { return c == ' ' || c == '\t'; }
bool is_space(char c) { return is_blank(c) || c == '\n' || c == '\r' || c == '\f' || c == '\v'; }
char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }
bool is_letter(char c) { return lower(c) >= 'a' && lower(c) <= 'z'; }

}  // namespace

void append_number(std::string& text, double value) {
  std::array<char, 400> digits;  // the largest double has 309 digits, the smallest 324 zeros
  value += 0.0;                  // no negative zero
  const auto [end, error] =
      std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed);
  text.append(digits.data(), end);
}

std::string read_file(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    throw Error(ErrorKind::kBadInput, file.string() + ": there is no such file");
  std::string text(std::filesystem::file_size(file, error), '\0');
  std::ifstream in(file, std::ios::binary);
  if (error || !in.read(text.data(), static_cast<std::streamsize>(text.size())))
    throw Error(ErrorKind::kBadInput, file.string() + ": cannot be read");
  return text;
}

void TextCursor::skip_blanks() {
  while (is_blank(peek())) advance();
}

void TextCursor::skip_spaces() {
  while (is_space(peek())) advance();
}

bool TextCursor::accept(char c) {
  if (at_end() || peek() != c) return false;
  advance();
  return true;
}

bool TextCursor::accept_text(std::string_view text) {
  if (!text_.substr(place_).starts_with(text)) return false;
  place_ += text.size();
  return true;
}

std::string_view TextCursor::word() const {
  std::size_t end = place_;
  while (end < text_.size() && is_letter(text_[end])) ++end;
  return text_.substr(place_, end - place_);
}

bool TextCursor::accept_word(std::string_view expected) {
  const std::string_view found = word();
  if (!std::equal(found.begin(), found.end(), expected.begin(), expected.end(),
                  [](char a, char b) { return lower(a) == lower(b); }))
    return false;
  place_ += found.size();
  return true;
}

double TextCursor::number(std::string_view what) {
  std::size_t begin = place_;
  if (peek() == '+') ++begin;  // which from_chars does not know
  double value = 0;
  const auto [end, error] =
      std::from_chars(text_.data() + begin, text_.data() + text_.size(), value);
  if (error == std::errc::result_out_of_range || (error == std::errc{} && !std::isfinite(value)))
    fail(std::string(what) + " must be a finite number");
  if (error != std::errc{}) fail("expected " + std::string(what) + ", a number");
  place_ = static_cast<std::size_t>(end - text_.data());
  return value;
}

int TextCursor::index(std::string_view what) {
  int value = 0;
  const auto [end, error] =
      std::from_chars(text_.data() + place_, text_.data() + text_.size(), value);
  if (error != std::errc{} || value < 0)
    fail("expected " + std::string(what) + ", a whole number of at least 0");
  place_ = static_cast<std::size_t>(end - text_.data());
  return value;
}

void TextCursor::fail_at(std::size_t place, const std::string& what) const {
  const std::string_view before = text_.substr(0, place);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t line_begin = before.rfind('\n') + 1;  // npos + 1 is 0
  throw Error(ErrorKind::kBadInput, file_ + ":" + std::to_string(line) + ":" +
                                        std::to_string(place - line_begin + 1) + ": " + what);
}

}  // namespace routebench::layer_files
