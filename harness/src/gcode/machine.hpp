#pragma once
/// What a printer does with commands: modes, position, filament.

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gcode/place.hpp"
#include "gcode/print_builder.hpp"
#include "gcode/words.hpp"

namespace routebench::gcode {

/// Follows commands by the rules of read_gcode and tells a builder what they lay.
class Machine {
 public:
  Machine(PrintBuilder& print, double arc_tolerance_mm)
      : print_(print), arc_tolerance_mm_(arc_tolerance_mm) {}

  /// Throws Error{kBadInput} for a command that cannot be followed.
  void execute(const Command& command, const Place& place);

  /// E counts mm3 of filament.
  void use_volumetric_e() { volumetric_ = true; }

 private:
  /// One of X, Y, Z. Where a printer is when it is switched on is not known.
  struct Axis {
    double mm = 0;         ///< of the machine
    double origin_mm = 0;  ///< of the file's coordinates, by G92
    bool known = false;
  };
  enum AxisName : std::size_t { kX, kY, kZ };

  void execute_g(const Command& command, const Place& place);
  void move(const Command& command, const Place& place);
  void arc(const Command& command, const Place& place);
  void home(const Command& command);
  void set_position(const Command& command, const Place& place);
  void set_volumetric(const Command& command, const Place& place);
  void choose_tool(int tool);
  /// Klipper's commands that keep and bring back how moves are read; false for all others.
  bool keep_state(const Command& command, const Place& place);

  /// Length of a word in mm, in the file's units.
  [[nodiscard]] std::optional<double> length_mm(const Command& command, char word,
                                                const Place& place) const;
  /// Moves the axes to where the words say.
  void move_axes(const Command& command, const Place& place);
  /// What the word E asks for: mm or mm3, negative if it pulls. Moves the counter.
  [[nodiscard]] double extrusion(const Command& command, const Place& place);
  /// Of `e`, what is laid by a move; the rest fills up what was pulled back.
  [[nodiscard]] double laid_by_move(double e);
  void pull(double e);
  /// Lays along or travels to points. Takes the axes where the move began.
  void go(const std::vector<Point2>& points, const std::array<Axis, 3>& from, double e,
          const Place& place);
  [[nodiscard]] Point2 nozzle() const { return {axes_[kX].mm, axes_[kY].mm}; }

  PrintBuilder& print_;
  double arc_tolerance_mm_;
  std::array<Axis, 3> axes_;
  std::vector<Point2> way_;  ///< of the move in hand
  double unit_mm_ = 1;
  bool relative_ = false;
  bool relative_e_ = false;
  bool volumetric_ = false;
  double e_ = 0;       ///< the counter, in the file's units
  double pulled_ = 0;  ///< filament that is pulled back by E
  bool pulled_by_firmware_ = false;
  std::optional<int> tool_;
  /// As SAVE_GCODE_STATE kept it.
  struct State {
    std::array<Axis, 3> axes;
    bool relative;
    bool relative_e;
    double e;
  };
  std::map<std::string, State, std::less<>> states_;
};

}  // namespace routebench::gcode
