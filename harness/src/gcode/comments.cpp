#include "gcode/comments.hpp"

#include <algorithm>
#include <optional>
#include <string>

#include "gcode/words.hpp"

namespace routebench::gcode {
namespace {

/// The text after a key; nothing if the text does not begin with it.
std::optional<std::string_view> after(std::string_view key, std::string_view text) {
  if (!text.starts_with(key)) return std::nullopt;
  return trimmed(text.substr(key.size()));
}

std::optional<std::string_view> after_either(std::string_view one, std::string_view other,
                                             std::string_view text) {
  const std::optional<std::string_view> value = after(one, text);
  return value ? value : after(other, text);
}

double measure(std::string_view text, std::string_view what, const Place& place) {
  const std::optional<double> number = decimal_in(text);
  constexpr double kMostMm = 1000;
  if (!number || *number > kMostMm)
    place.refuse("the mark of a " + std::string(what) + " is not a number up to 1000 mm");
  return *number;
}

/// "1d 2h 57m 48s" in seconds; nothing for what is written in another way.
std::optional<double> duration_s(std::string_view text) {
  double sum_s = 0;
  for (std::string_view rest = trimmed(text); !rest.empty();) {
    const std::string_view part = rest.substr(0, rest.find(' '));
    rest = trimmed(rest.substr(part.size()));
    const std::optional<double> number = decimal_in(part.substr(0, part.size() - 1));
    if (!number) return std::nullopt;
    switch (part.back()) {
      case 'd':
        sum_s += 24 * 3600 * *number;
        break;
      case 'h':
        sum_s += 3600 * *number;
        break;
      case 'm':
        sum_s += 60 * *number;
        break;
      case 's':
        sum_s += *number;
        break;
      default:
        return std::nullopt;
    }
  }
  return sum_s > 0 ? std::optional(sum_s) : std::nullopt;
}

/// "1.75,1.75": one for each tool.
void read_diameters(std::string_view text, PrintBuilder& print) {
  std::optional<double> first;
  bool differ = false;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::optional<double> mm = decimal_in(trimmed(text.substr(begin, end - begin)));
    if (!mm || !(*mm > 0)) return;
    if (!first) first = mm;
    differ = differ || *mm != *first;
    begin = end + 1;
  }
  if (first) print.state_filament(*first, differ);
}

}  // namespace

void read_comment(std::string_view text, const Place& place, PrintBuilder& print,
                  Machine& machine) {
  text = trimmed(text);
  if (text == "LAYER_CHANGE" || text == "CHANGE_LAYER" || text.starts_with("LAYER:")) {
    print.mark_layer();
  } else if (const auto type = after_either("TYPE:", "FEATURE:", text)) {
    print.mark_type(*type);
  } else if (const auto width = after_either("WIDTH:", "LINE_WIDTH:", text)) {
    const double mm = measure(*width, "width", place);
    print.mark_width(mm > 0 ? std::optional(mm) : std::nullopt);
  } else if (const auto height = after_either("HEIGHT:", "LAYER_HEIGHT:", text)) {
    const double mm = measure(*height, "height", place);
    if (!(mm > 0)) place.refuse("the mark of a height is not positive");
    print.mark_height(mm);
  } else if (const auto time = after("estimated printing time (normal mode) =", text)) {
    if (const std::optional<double> time_s = duration_s(*time)) print.state_time(*time_s);
  } else if (const auto flavour = after("FLAVOR:", text)) {
    if (*flavour == "UltiGCode") machine.use_volumetric_e();
  } else if (const auto volumetric = after("use_volumetric_e =", text)) {
    if (*volumetric == "1") print.state_volumetric_e();
  } else if (const auto diameters =
                 after_either("filament_diameter =", "printer.filament_mm =", text)) {
    read_diameters(*diameters, print);
  }
}

}  // namespace routebench::gcode
