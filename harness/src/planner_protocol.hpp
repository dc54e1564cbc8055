#pragma once
/// The lines that go to and come from planners in processes of their own, as JSON.

#include <optional>
#include <string>
#include <vector>

#include "plan_timing.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/planning/params.hpp"
#include "routebench/planning/planner.hpp"
#include "routebench/planning/registry.hpp"

namespace routebench {

/// What a planner's program says is wrong, in its own words.
class PlannerComplaint : public Error {
 public:
  explicit PlannerComplaint(const std::string& message) : Error(ErrorKind::kBadInput, message) {}
};

/// One planner of a program, as it describes it.
struct PlannerDescription {
  PlannerInfo info;
  std::vector<ParamSchema> params;
};

/// All that a program tells of itself.
struct ProgramDescription {
  std::string made_with;  ///< "python 3.11.2, numpy 1.24.2"; may be empty
  std::vector<PlannerDescription> planners;
};

[[nodiscard]] std::string describe_request();
/// Throws PlannerComplaint, or Error{kBadInput} saying what is wrong with the answer.
[[nodiscard]] ProgramDescription read_description(const std::string& line);

/// The layer and the nozzle's place are given relative to context.origin.
[[nodiscard]] std::string plan_request(const std::string& planner, const ParamSet& params,
                                       const Layer& layer, const PlanContext& context);

struct PlanAnswer {
  Route route;                    ///< as the printer sees it, on the grid
  std::optional<PlanTime> times;  ///< if the answer gives any
};

/// Takes  the context of the request.
/// Throws PlannerComplaint, or Error{kBadInput} saying what is wrong with the answer;
///        std::bad_alloc if it says that it has no more memory.
[[nodiscard]] PlanAnswer read_route(const std::string& line, const PlanContext& context);

/// Checks values against a schema as ParamBinder does, and fills in defaults. Throws
/// Error{kBadInput} naming the owner.
[[nodiscard]] ParamSet resolved_params(const std::string& owner,
                                       const std::vector<ParamSchema>& schema,
                                       const ParamSet& values);

}  // namespace routebench
