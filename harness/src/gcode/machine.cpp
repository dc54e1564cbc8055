#include "gcode/machine.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>
#include <utility>

#include "gcode/arc.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench::gcode {
namespace {

constexpr double kInchMm = 25.4;
constexpr double kFurthestMm = 1e6;  // a kilometre
constexpr std::array<char, 3> kAxisWords = {'X', 'Y', 'Z'};

/// G codes that neither move to another place nor change how moves are read: dwelling, the XY
/// plane, cleaning, parking, probing, levelling and priming.
constexpr std::array kHarmless = {4,  12, 17, 26, 27, 29, 30, 31, 32, 33,
                                  34, 35, 40, 49, 76, 80, 81, 87, 94, 280};

bool same_word(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
    return std::toupper(static_cast<unsigned char>(x)) ==
           std::toupper(static_cast<unsigned char>(y));
  });
}

/// The value of "KEY=value" among words; nothing if there is none.
std::optional<std::string_view> value_of(std::string_view key, std::string_view words) {
  for (words = trimmed(words); !words.empty(); words = trimmed(words)) {
    const std::string_view word = words.substr(0, words.find_first_of(" \t"));
    words.remove_prefix(word.size());
    const std::size_t equals = word.find('=');
    if (equals != word.npos && same_word(word.substr(0, equals), key))
      return word.substr(equals + 1);
  }
  return std::nullopt;
}

}  // namespace

void Machine::execute(const Command& command, const Place& place) {
  switch (command.letter) {
    case 0:
      return;
    case 'G':
      execute_g(command, place);
      return;
    case 'M':
      if (command.code == 82 || command.code == 83) {
        relative_e_ = command.code == 83;
        return;
      }
      if (command.code == 200) {
        set_volumetric(command, place);
        return;
      }
      break;
    case 'T':
      choose_tool(command.code);
      break;
    default:
      if (keep_state(command, place)) return;
      break;
  }
  print_.ignore(command.text);
}

void Machine::execute_g(const Command& command, const Place& place) {
  switch (command.code) {
    case 0:
    case 1:
      return move(command, place);
    case 2:
    case 3:
      return arc(command, place);
    case 10:
      if (std::any_of(kAxisWords.begin(), kAxisWords.end(),
                      [&](char word) { return command.has(word); }) ||
          command.has('P') || command.has('L') || command.has('R'))
        return print_.ignore(command.text);
      if (!pulled_by_firmware_ && pulled_ <= 0) print_.pull();
      pulled_by_firmware_ = true;
      return;
    case 11:
      pulled_by_firmware_ = false;
      return;
    case 20:
    case 21:
      unit_mm_ = command.code == 20 ? kInchMm : 1;
      return;
    case 28:
      return home(command);
    case 90:
    case 91:
      relative_ = command.code == 91;
      return;
    case 92:
      return set_position(command, place);
    default:
      if (std::find(kHarmless.begin(), kHarmless.end(), command.code) == kHarmless.end())
        place.refuse(std::string(command.text) + " is not known, and it might move the nozzle");
      print_.ignore(command.text);
  }
}

void Machine::home(const Command& command) {
  const bool some = std::any_of(kAxisWords.begin(), kAxisWords.end(),
                                [&](char word) { return command.has(word); });
  for (std::size_t axis = 0; axis < axes_.size(); ++axis)
    if (!some || command.has(kAxisWords[axis])) axes_[axis] = {0, 0, true};
  print_.travel(0);
}

void Machine::set_position(const Command& command, const Place& place) {
  const bool all = !command.has_any();
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const std::optional<double> value = length_mm(command, kAxisWords[i], place);
    if (!value && !all) continue;
    Axis& axis = axes_[i];
    if (!axis.known) axis.mm = value.value_or(0);
    axis.known = true;
    axis.origin_mm = axis.mm - value.value_or(0);
  }
  if (command.has('E') || all) e_ = command.number('E', place).value_or(0);
}

void Machine::set_volumetric(const Command& command, const Place& place) {
  // A diameter switches to volumes, 0 back to lengths; S does the same without one.
  if (const std::optional<double> diameter = command.number('D', place))
    volumetric_ = *diameter > 0;
  else if (const std::optional<double> state = command.number('S', place))
    volumetric_ = *state > 0;
}

void Machine::choose_tool(int tool) {
  if (tool < 0) return;
  if (tool_ && *tool_ != tool) {
    pulled_ = 0;
    pulled_by_firmware_ = false;
  }
  tool_ = tool;
}

bool Machine::keep_state(const Command& command, const Place& place) {
  const bool saves = same_word(command.text, "SAVE_GCODE_STATE");
  if (!saves && !same_word(command.text, "RESTORE_GCODE_STATE")) return false;
  const std::string name(value_of("NAME", command.rest).value_or("default"));
  if (saves) {
    states_.insert_or_assign(name, State{axes_, relative_, relative_e_, e_});
    return true;
  }
  const auto found = states_.find(name);
  if (found == states_.end()) place.refuse("the state '" + name + "' has not been saved");
  const State& state = found->second;
  relative_ = state.relative;
  relative_e_ = state.relative_e;
  e_ = state.e;
  const bool moves = value_of("MOVE", command.rest).value_or("0") != "0";
  const Point2 from = nozzle();
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (!state.axes[i].known) continue;
    axes_[i].origin_mm = state.axes[i].origin_mm;
    if (moves) axes_[i].mm = state.axes[i].mm;
  }
  if (moves) print_.travel(distance(from, nozzle()));
  return true;
}

std::optional<double> Machine::length_mm(const Command& command, char word,
                                         const Place& place) const {
  const std::optional<double> number = command.number(word, place);
  if (!number) return std::nullopt;
  return *number * unit_mm_;
}

void Machine::move_axes(const Command& command, const Place& place) {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const std::optional<double> value = length_mm(command, kAxisWords[i], place);
    if (!value) continue;
    Axis& axis = axes_[i];
    axis.mm = *value + (relative_ ? axis.mm : axis.origin_mm);
    axis.known = axis.known || !relative_;
    if (!(std::abs(axis.mm) <= kFurthestMm))
      place.refuse(std::string(1, kAxisWords[i]) + " is more than 1 km away");
  }
}

double Machine::extrusion(const Command& command, const Place& place) {
  const std::optional<double> number = command.number('E', place);
  if (!number) return 0;
  const bool relative = relative_ || relative_e_;
  const double by = relative ? *number : *number - e_;
  e_ = relative ? e_ + *number : *number;
  if (!(std::abs(by) <= kFurthestMm)) place.refuse("E asks for more than 1 km of filament");
  return by * (volumetric_ ? unit_mm_ * unit_mm_ * unit_mm_ : unit_mm_);
}

void Machine::pull(double e) {
  if (pulled_ <= 0 && !pulled_by_firmware_) print_.pull();
  pulled_ -= e;
}

double Machine::laid_by_move(double e) {
  constexpr double kRounding = 1e-6;
  pulled_by_firmware_ = false;
  const double returned = std::min(e, pulled_);
  pulled_ -= returned;
  if (pulled_ <= kRounding) pulled_ = 0;
  return e - returned > kRounding || returned <= 0 ? e - returned : 0;
}

void Machine::move(const Command& command, const Place& place) {
  const std::array<Axis, 3> from = axes_;
  move_axes(command, place);
  way_.assign(1, nozzle());
  go(way_, from, extrusion(command, place), place);
}

void Machine::arc(const Command& command, const Place& place) {
  const std::array<Axis, 3> from = axes_;
  const Point2 start = nozzle();
  if (!from[kX].known || !from[kY].known) place.refuse("an arc begins at an unknown place");
  if (command.has('P')) place.refuse("arcs of several turns (P) are not read");
  Arc arc{start, {}, command.code == 2, std::nullopt, length_mm(command, 'R', place)};
  const std::optional<double> i = length_mm(command, 'I', place);
  const std::optional<double> j = length_mm(command, 'J', place);
  if (i || j) arc.centre = Point2{i.value_or(0), j.value_or(0)};
  move_axes(command, place);
  arc.to = nozzle();
  flatten(arc, arc_tolerance_mm_, place, way_);
  go(way_, from, extrusion(command, place), place);
}

void Machine::go(const std::vector<Point2>& points, const std::array<Axis, 3>& from, double e,
                 const Place& place) {
  if (e < 0) pull(e);
  const Point2 start = snap(Point2{from[kX].mm, from[kY].mm});
  double length = 0;
  Point2 at = start;
  for (const Point2 p : points) length += distance(std::exchange(at, snap(p)), snap(p));
  if (length <= 0) {
    if (e > 0) {
      pulled_ = 0;
      pulled_by_firmware_ = false;
    }
    return;
  }
  const double laid = e > 0 ? laid_by_move(e) : 0;
  if (laid <= 0) {
    // The way to the first known place has no length.
    print_.travel(from[kX].known && from[kY].known ? length : 0);
    return;
  }
  for (std::size_t axis = 0; axis < axes_.size(); ++axis)
    if (!from[axis].known)
      place.refuse("material is laid before any move has said where " +
                   std::string(1, kAxisWords[axis]) +
                   " is: a travel, G28 or G92 has to come first");
  const double climb_mm = axes_[kZ].mm - from[kZ].mm;
  Bead bead{start, start, from[kZ].mm, from[kZ].mm, {}};
  double gone = 0;
  for (const Point2 p : points) {
    bead.to = snap(p);
    const double piece = distance(bead.from, bead.to);
    if (piece <= 0) continue;
    gone += piece;
    bead.to_z_mm = gone >= length ? axes_[kZ].mm : from[kZ].mm + climb_mm * gone / length;
    const double filament = laid * piece / length;
    bead.filament = volumetric_ ? Filament{0, filament} : Filament{filament, 0};
    print_.bead(bead, place);
    bead.from = bead.to;
    bead.from_z_mm = bead.to_z_mm;
  }
}

}  // namespace routebench::gcode
