#include "gcode/stroke_types.hpp"

#include <algorithm>
#include <array>

namespace routebench::gcode {
namespace {

struct NamedType {
  std::string_view name;
  StrokeType type;
};

constexpr StrokeType kWall{false, StrokeKind::kWall};
constexpr StrokeType kDense{false, StrokeKind::kDense};
constexpr StrokeType kSparse{false, StrokeKind::kSparse};
constexpr StrokeType kOther{true, std::nullopt};

constexpr std::array kTypes = std::to_array<NamedType>({
    // PrusaSlicer and our own writer
    {"External perimeter", kWall},
    {"Perimeter", kWall},
    {"Overhang perimeter", kWall},
    {"Thin wall", kWall},
    {"Gap fill", kDense},
    {"Solid infill", kDense},
    {"Top solid infill", kDense},
    {"Bridge infill", kDense},
    {"Ironing", kOther},
    {"Internal infill", kSparse},
    {"Skirt", kOther},
    {"Skirt/Brim", kOther},
    {"Brim", kOther},
    {"Support material", kOther},
    {"Support material interface", kOther},
    {"Wipe tower", kOther},
    {"Custom", kOther},
    // its descendants
    {"Outer wall", kWall},
    {"Inner wall", kWall},
    {"Overhang wall", kWall},
    {"Gap infill", kDense},
    {"Top surface", kDense},
    {"Bottom surface", kDense},
    {"Internal solid infill", kDense},
    {"Bridge", kDense},
    {"Internal Bridge", kDense},
    {"Floating vertical shell", kDense},
    {"Sparse infill", kSparse},
    {"Support", kOther},
    {"Support interface", kOther},
    {"Support transition", kOther},
    {"Prime tower", kOther},
    // CuraEngine
    {"WALL-OUTER", kWall},
    {"WALL-INNER", kWall},
    {"SKIN", kDense},
    {"FILL", kSparse},
    {"SKIRT", kOther},
    {"BRIM", kOther},
    {"RAFT", kOther},
    {"SUPPORT", kOther},
    {"SUPPORT-INTERFACE", kOther},
    {"PRIME-TOWER", kOther},
    {"DRAFT-SHIELD", kOther},
    {"OOZE-SHIELD", kOther},
});

}  // namespace

std::optional<StrokeType> stroke_type(std::string_view name) {
  const auto* const found = std::ranges::find(kTypes, name, &NamedType::name);
  if (found == kTypes.end()) return std::nullopt;
  return found->type;
}

}  // namespace routebench::gcode
