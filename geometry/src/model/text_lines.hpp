#pragma once
/// Text formats of lines and words: OFF, OBJ, the head of PLY.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace routebench::models {

/// Reads words line by line; `#` begins a remark, blank lines do not count, lines end in \n, \r\n
/// or \r. Complaints name the line.
class TextLines {
 public:
  /// Both must outlive the reader. A byte order mark is passed over. `first_line` is the number of
  /// the first line in its file.
  TextLines(std::span<const char> bytes, const std::string& name, std::size_t first_line = 1);

  /// Goes to the next line that has words; false at the end.
  bool next_line();
  /// The next word of the line; empty at its end.
  std::string_view word();
  /// The next word wherever it is; empty at the end of the text.
  std::string_view word_on_any_line();

  /// A number from a word; infinite if it is too large. Refuses what is none.
  [[nodiscard]] double number(std::string_view word) const;
  /// A whole number from a word. Refuses what is none.
  [[nodiscard]] std::int64_t whole(std::string_view word) const;

  /// Where the rest of the text begins: after the line end of the current line.
  [[nodiscard]] std::size_t rest_offset() const;
  /// Bytes from the current word on: a bound for what may still come.
  [[nodiscard]] std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - at_); }
  [[nodiscard]] std::size_t line() const { return line_; }
  [[nodiscard]] std::string place() const { return "line " + std::to_string(line_); }
  [[noreturn]] void refuse(const std::string& complaint) const;

 private:
  const char* begin_;
  const char* at_;
  const char* end_;
  const char* line_end_;  ///< of the current line, before a remark
  std::size_t line_;
  bool begun_ = false;
  const std::string& name_;
};

}  // namespace routebench::models
