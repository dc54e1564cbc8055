#include "gcode/words.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>

namespace routebench::gcode {
namespace {

constexpr bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r'; }
constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }
constexpr char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }
constexpr bool is_letter(char c) { return upper(c) >= 'A' && upper(c) <= 'Z'; }

/// Reads a number from the front of a text. Returns its end, or nullptr if there is none.
const char* read_number(const char* from, const char* end, double& number) {
  const bool plus = from != end && *from == '+';
  if (plus) ++from;
  const char* const digits = !plus && from != end && *from == '-' ? from + 1 : from;
  // The library would also take "inf" and "nan".
  if (digits == end || !(is_digit(*digits) || *digits == '.')) return nullptr;
  const auto [stop, failure] = std::from_chars(from, end, number, std::chars_format::fixed);
  return failure == std::errc{} ? stop : nullptr;
}

/// A character as a message can show it.
std::string shown(char c) {
  if (c >= ' ' && c <= '~') return "'" + std::string(1, c) + "'";
  constexpr std::string_view kHex = "0123456789abcdef";
  const auto byte = static_cast<unsigned char>(c);
  return std::string("the byte 0x") + kHex[byte >> 4] + kHex[byte & 15];
}

/// A word as a message can show it: printable and not too long.
std::string quoted(std::string_view text) {
  constexpr std::size_t kLongest = 24;
  std::string safe(text.substr(0, kLongest));
  std::replace_if(
      safe.begin(), safe.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return "'" + safe + (text.size() > kLongest ? "...'" : "'");
}

class LineParser {
 public:
  LineParser(std::string_view line, const Place& place, Command& command)
      : at_(line.data()), end_(line.data() + line.size()), place_(place), command_(command) {}

  void parse() {
    command_.clear();
    skip_spaces();
    if (at_ != end_ && upper(*at_) == 'N' && at_ + 1 != end_ && is_digit(at_[1]))
      skip_line_number();
    if (at_ == end_) return;
    const std::size_t letters = name_length();
    constexpr std::size_t kShortestName = 3;  // of Klipper's commands: PID_CALIBRATE, RESTART
    if (letters >= kShortestName) {
      read_name(letters);
      return;
    }
    read_code();
    if (command_.letter == 'G' ||
        (command_.letter == 'M' &&
         (command_.code == 82 || command_.code == 83 || command_.code == 200)))
      read_words();
  }

 private:
  void skip_spaces() {
    while (at_ != end_) {
      if (is_space(*at_)) {
        ++at_;
      } else if (*at_ == '(') {
        const char* close = std::find(at_, end_, ')');
        if (close == end_) place_.refuse("a comment in brackets does not end");
        at_ = close + 1;
      } else {
        return;
      }
    }
  }

  /// A line with a number may end with a checksum.
  void skip_line_number() {
    ++at_;
    while (at_ != end_ && is_digit(*at_)) ++at_;
    end_ = std::find(at_, end_, '*');
    skip_spaces();
  }

  /// Letters and underscores at the front.
  [[nodiscard]] std::size_t name_length() const {
    const auto is_name = [](char c) { return is_letter(c) || c == '_'; };
    return static_cast<std::size_t>(std::find_if_not(at_, end_, is_name) - at_);
  }

  void read_name(std::size_t letters) {
    command_.letter = 'N';
    command_.code = 0;
    command_.text = {at_, letters};
    command_.rest = {at_ + letters, static_cast<std::size_t>(end_ - at_) - letters};
    constexpr std::array<std::string_view, 7> kFlow = {"while", "elif",     "else", "break",
                                                       "skip",  "continue", "abort"};
    if (std::find(kFlow.begin(), kFlow.end(), command_.text) != kFlow.end())
      place_.refuse(quoted(command_.text) +
                    " cannot be followed: conditions and loops are not read");
  }

  void read_code() {
    const char* const start = at_;
    const char letter = upper(*at_);
    if (letter != 'G' && letter != 'M' && letter != 'T')
      place_.refuse(
          "the line begins with no command but with " +
          (is_letter(*at_) ? quoted({at_, static_cast<std::size_t>(end_ - at_)}) : shown(*at_)));
    ++at_;
    command_.letter = letter;
    command_.code = 0;
    const auto [stop, failure] = std::from_chars(at_, end_, command_.code);
    const bool numbered = failure == std::errc{} && stop != at_ && *at_ != '-';
    // Tx, Tc and T? are tools that a person chooses.
    if (!numbered && letter != 'T')
      place_.refuse(quoted({start, static_cast<std::size_t>(end_ - start)}) +
                    " is not a command: " + letter + " has no number");
    if (numbered)
      at_ = stop;
    else
      command_.code = -1;
    if (at_ != end_ && *at_ == '.') {  // G92.1 is not G92
      ++at_;
      while (at_ != end_ && is_digit(*at_)) ++at_;
      command_.code = -1;
    }
    command_.text = {start, static_cast<std::size_t>(at_ - start)};
  }

  void read_words() {
    for (skip_spaces(); at_ != end_; skip_spaces()) {
      const char word = upper(*at_);
      if (!is_letter(word)) place_.refuse(shown(*at_) + " is no word of a command");
      if (word == 'G' || word == 'M')
        place_.refuse("a second command stands on the line; each needs its own");
      if (!command_.add(word)) place_.refuse(std::string(1, word) + " is given twice");
      ++at_;
      const char* const number_at = at_;
      double number = 0;
      if (const char* const stop = read_number(at_, end_, number)) {
        at_ = stop;
        command_.set_number(word, number);
      } else if (at_ != end_ && !is_space(*at_) && !is_letter(*at_) && *at_ != '(') {
        place_.refuse(word + quoted({number_at, static_cast<std::size_t>(end_ - number_at)}) +
                      " is not a number");
      }
      if (at_ != end_ && at_ != number_at && (*at_ == '.' || *at_ == '-' || *at_ == '+'))
        place_.refuse(word + quoted({number_at, static_cast<std::size_t>(end_ - number_at)}) +
                      " is not a number");
    }
  }

  const char* at_;
  const char* end_;
  const Place& place_;
  Command& command_;
};

}  // namespace

void parse_command(std::string_view line, const Place& place, Command& command) {
  LineParser(line, place, command).parse();
}

std::optional<double> decimal_in(std::string_view text) {
  double number = 0;
  const char* const end = text.data() + text.size();
  if (text.empty() || read_number(text.data(), end, number) != end) return std::nullopt;
  return number;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

}  // namespace routebench::gcode
