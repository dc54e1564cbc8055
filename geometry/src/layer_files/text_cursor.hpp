#pragma once
/// Reading and writing the numbers and words of layer files.

#include <cctype>
#include <charconv>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace routebench::layer_files {

/// Appends the shortest decimal that reads back as the same double, without an exponent.
void append_number(std::string& text, double value);

/// A whole file in memory. Throws Error{kBadInput} if it cannot be read.
[[nodiscard]] std::string read_file(const std::filesystem::path& file);

/// A place in a text that knows how to complain about itself.
class TextCursor {
 public:
  /// `text` must outlive the cursor; `file` is used in messages only.
  TextCursor(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {}

  [[nodiscard]] bool at_end() const { return place_ == text_.size(); }
  [[nodiscard]] char peek() const { return at_end() ? '\0' : text_[place_]; }
  [[nodiscard]] std::size_t place() const { return place_; }
  void move_to(std::size_t place) { place_ = place; }
  void advance() { ++place_; }

  void skip_blanks();  ///< spaces and tabs
  void skip_spaces();  ///< line ends too

  /// Steps over the character or the word if it stands here. Words are compared without regard to
  /// case and must not be followed by a letter.
  [[nodiscard]] bool accept(char c);
  [[nodiscard]] bool accept_word(std::string_view word);
  /// Steps over the text if it stands here exactly.
  bool accept_text(std::string_view text);
  /// The letters that stand here.
  [[nodiscard]] std::string_view word() const;

  /// A decimal number. Throws Error{kBadInput} if there is none or it is not finite.
  double number(std::string_view what);
  /// A whole number of at least 0. Throws as number().
  int index(std::string_view what);

  /// Throws Error{kBadInput}: "file:line:column: what", for where the cursor is or for another
  /// place.
  [[noreturn]] void fail(const std::string& what) const { fail_at(place_, what); }
  [[noreturn]] void fail_at(std::size_t place, const std::string& what) const;

 private:
  std::string_view text_;
  std::string file_;
  std::size_t place_ = 0;
};

}  // namespace routebench::layer_files
