#pragma once
/// The JSON documents that commands print.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "json_parts.hpp"
#include "routebench/harness/contender.hpp"
#include "routebench/harness/gcode_reader.hpp"
#include "routebench/harness/gcode_score.hpp"
#include "routebench/harness/judge.hpp"
#include "routebench/harness/pipeline.hpp"

namespace routebench {

/// What `plan` has done, for its document.
/// CPU time of the program's own threads: programs that plan are not among them.
struct PlanPhases {
  std::int64_t prepare_ns = 0;           ///< read, slice, find what every layer demands
  std::int64_t plan_ns = 0;              ///< or put a file's strokes in their places
  std::optional<std::int64_t> judge_ns;  ///< nothing: not judged
};

struct PlanResult {
  Json contender;
  const SlicedModel& model;
  const Judge& judge;
  std::optional<std::uint64_t> seed;  ///< nothing if nobody has drawn lots
  std::size_t layers;                 ///< that were to be planned
  const JudgedCell* cell;             ///< nullptr: not judged
  const PlanPhases* cpu = nullptr;    ///< nullptr: not asked for
};
/// What is not judged has neither outcome nor scores: they are null.
[[nodiscard]] Json plan_document(const PlanResult& result);

/// What `score` has done, for its document.
struct ScoreResult {
  const std::string& file;
  const GcodePrint& print;
  const SlicedModel* model;                ///< nullptr: none
  const std::vector<std::size_t>& chosen;  ///< of its layers
  const Judge& judge;
  const GcodeScore& score;
};
/// As plan_document, and beside that: offset_mm, what was paired, what the file itself says. The
/// outcome is null without a model.
[[nodiscard]] Json score_document(const ScoreResult& result);

[[nodiscard]] Json slice_document(const SlicedModel& model, std::string_view method);

[[nodiscard]] Json planners_document(const PlannerSet& planners);

}  // namespace routebench
