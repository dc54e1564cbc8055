#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "gcode/comments.hpp"
#include "gcode/machine.hpp"
#include "gcode/place.hpp"
#include "gcode/print_builder.hpp"
#include "gcode/words.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/harness/gcode_reader.hpp"

namespace routebench {
namespace {

constexpr std::size_t kBlockBytes = std::size_t{1} << 20;

/// Reads lines from blocks of a stream; the text itself is never held as a whole.
class Reader {
 public:
  Reader(const std::string& name, const GcodeOptions& options)
      : place_{name, 0}, print_(options), machine_(print_, options.arc_tolerance_mm) {}

  GcodePrint read(std::istream& in) {
    std::vector<char> buffer(kBlockBytes);
    std::size_t held = 0;  // the beginning of a line whose end is still to come
    while (in) {
      if (held == buffer.size()) {
        ++place_.line;
        place_.refuse("the line is longer than 1 MB; this is no G-code");
      }
      in.read(buffer.data() + held, static_cast<std::streamsize>(buffer.size() - held));
      const std::size_t filled = held + static_cast<std::size_t>(in.gcount());
      const std::size_t used = read_lines({buffer.data(), filled});
      held = filled - used;
      std::memmove(buffer.data(), buffer.data() + used, held);
    }
    if (in.bad()) throw Error(ErrorKind::kBadInput, place_.name + ": cannot be read");
    if (held > 0) read_line({buffer.data(), held});
    return print_.finish(place_);
  }

 private:
  /// Reads all whole lines; returns how many characters they have.
  std::size_t read_lines(std::string_view text) {
    std::size_t at = 0;
    for (std::size_t end = text.find('\n'); end != text.npos; end = text.find('\n', at)) {
      read_line(text.substr(at, end - at));
      at = end + 1;
    }
    return at;
  }

  /// What editors of some systems put before a text is no part of it. Throws for what is no text.
  void check_beginning(std::string_view& line) {
    if (line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
    if (line.starts_with("GCDE")) place_.refuse("this is binary G-code; export it as text");
    if (line.starts_with("\x1F\x8B") || line.starts_with("PK\x03\x04"))
      place_.refuse("this is a compressed file; unpack it");
    if (line.starts_with("\xFF\xFE") || line.starts_with("\xFE\xFF") ||
        line.substr(0, 2).find('\0') != line.npos)
      place_.refuse("this is UTF-16 or no text at all; G-code is plain text, in ASCII or UTF-8");
  }

  void read_line(std::string_view line) {
    ++place_.line;
    if (place_.line == 1) check_beginning(line);
    const std::size_t semicolon = line.find(';');
    const std::string_view code = line.substr(0, semicolon);
    gcode::parse_command(code, place_, command_);
    if (command_.letter != 0) {
      machine_.execute(command_, place_);
    } else if (semicolon != line.npos) {
      gcode::read_comment(line.substr(semicolon + 1), place_, print_, machine_);
    }
  }

  gcode::Place place_;
  gcode::PrintBuilder print_;
  gcode::Machine machine_;
  gcode::Command command_;
};

}  // namespace

GcodePrint read_gcode(std::istream& in, const std::string& name, const GcodeOptions& options) {
  return Reader(name, options).read(in);
}

GcodePrint read_gcode_file(const std::filesystem::path& file, const GcodeOptions& options) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error))
    throw Error(ErrorKind::kBadInput, file.string() + ": is a folder, not a file of G-code");
  std::ifstream in(file, std::ios::binary);
  if (!in)
    throw Error(ErrorKind::kBadInput,
                file.string() + ": cannot be opened: " + std::generic_category().message(errno));
  return read_gcode(in, file.string(), options);
}

}  // namespace routebench
