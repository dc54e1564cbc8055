#pragma once
/// The JSON documents that commands print.

#include <cstdint>
#include <span>
#include <string>

#include "json_parts.hpp"
#include "routebench/harness/contender.hpp"
#include "routebench/harness/judge.hpp"
#include "routebench/harness/pipeline.hpp"

namespace routebench {

/// What `plan` has done, for its document.
struct PlanResult {
  const Contender& contender;
  const SlicedModel& model;
  const Judge& judge;
  std::uint64_t seed;
  std::size_t layers;  ///< that were to be planned
  const JudgedCell& cell;
};
[[nodiscard]] Json plan_document(const PlanResult& result);

[[nodiscard]] Json slice_document(const SlicedModel& model, std::string_view method);

[[nodiscard]] Json planners_document(const PlannerSet& planners);

}  // namespace routebench
