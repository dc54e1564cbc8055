#pragma once
/// A line of G-code as words.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "gcode/place.hpp"

namespace routebench::gcode {

/// One command with its words. A word is a letter with or without a number.
class Command {
 public:
  char letter = 0;        ///< 'G', 'M' or 'T'; 'N' for a command with a name; 0 for an empty line
  int code = 0;           ///< 1 of G1; -1 of "G92.1" and of "Tx"
  std::string_view text;  ///< the command itself, as written: "G1", "M104", "SET_FAN_SPEED"
  std::string_view rest;  ///< what follows a name: " NAME=here MOVE=1"

  [[nodiscard]] bool has(char word) const noexcept { return (there_ & bit(word)) != 0; }
  [[nodiscard]] bool has_any() const noexcept { return there_ != 0; }
  /// The number of a word; nothing if the word is not there.
  /// Throws Error{kBadInput} if the word is there without a number.
  [[nodiscard]] std::optional<double> number(char word, const Place& place) const {
    if (!has(word)) return std::nullopt;
    if ((numbered_ & bit(word)) == 0) place.refuse(std::string(1, word) + " has no number");
    return numbers_[static_cast<std::size_t>(word - 'A')];
  }

  /// Forgets everything.
  void clear() noexcept {
    letter = 0;
    there_ = numbered_ = 0;
  }
  /// Adds a word. Returns false if it is there already.
  bool add(char word) noexcept {
    if (has(word)) return false;
    there_ |= bit(word);
    return true;
  }
  void set_number(char word, double number) noexcept {
    numbered_ |= bit(word);
    numbers_[static_cast<std::size_t>(word - 'A')] = number;
  }

 private:
  static constexpr std::uint32_t bit(char word) noexcept { return 1u << (word - 'A'); }

  std::uint32_t there_ = 0;
  std::uint32_t numbered_ = 0;
  std::array<double, 26> numbers_{};
};

/// Reads a line without its comment. Letters may be small, words need no spaces between them; line
/// numbers and checksums are passed over, and so is text in round brackets.
///
/// Words are read for G codes, M82, M83 and M200 alone: others may be followed by any text.
/// Throws Error{kBadInput} for a line that begins with no command, a number that is none, a word
///        given twice, a second command, or a construct that a single pass cannot follow (loops and
///        conditions of RepRapFirmware).
void parse_command(std::string_view line, const Place& place, Command& command);

/// The decimal number that all of a text is, without spaces; nothing for anything else, exponents,
/// infinities and NaN included.
[[nodiscard]] std::optional<double> decimal_in(std::string_view text);

/// A text without spaces and tabs at both ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

}  // namespace routebench::gcode
