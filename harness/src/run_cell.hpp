#pragma once
/// What happens in a cell's own process, and how its parent learns of it.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "routebench/harness/contender.hpp"
#include "routebench/harness/judge.hpp"
#include "routebench/harness/pipeline.hpp"
#include "routebench/harness/results.hpp"
#include "routebench/harness/slicer.hpp"
#include "run_child.hpp"

namespace routebench {

/// What a contender is: planners, a foreign slicer, or a way of cutting layers.
using Worker = std::variant<Contender, Slicer, SliceMethod>;

/// One cell, ready to be executed. Refers to what its parent holds.
struct CellWork {
  const Worker* worker = nullptr;
  const PreparedModel* model = nullptr;
  const Judge* judge = nullptr;
  std::uint64_t seed = 1;
  std::vector<std::size_t> kept_layers;  ///< places whose routes are sent along
  // For slicers and ways of cutting alone:
  bool repair = false;            ///< whether the model was mended; see ModelOptions
  std::filesystem::path scratch;  ///< a folder that may be written
  int memory_mb = 0;              ///< that the slicer may take
};

/// What a cell that was planned and judged tells.
struct CellResult {
  Outcome outcome = Outcome::kFailed;
  std::string reason;
  std::optional<std::string> route_hash;  ///< nothing if there is no whole route
  Scores totals;
  std::vector<LayerScore> layers;
  std::vector<RouteRecord> routes;
  TimingSample timing;  ///< repetition is left at 0
};

/// Plans, or has a foreign slicer do so, and judges; to be called in a child. Returns bytes for
/// cell_result_of.
[[nodiscard]] std::string execute_cell(const CellWork& work, ChildProgress& progress);

/// Plans only, for the time it takes, which foreign slicers do not tell; to be called in a child.
/// Returns bytes for cell_result_of.
[[nodiscard]] std::string time_cell(const CellWork& work, ChildProgress& progress);

/// What became of a cell's child. What did not end by telling a result has an outcome and a reason
/// that says how far it came.
[[nodiscard]] CellResult cell_result_of(const ChildEnd& end, const ChildLimits& limits);

/// Fingerprint of layers: shapes, skins, heights and repair marks.
[[nodiscard]] std::string hash_of_layers(const std::vector<Layer>& layers);

}  // namespace routebench
