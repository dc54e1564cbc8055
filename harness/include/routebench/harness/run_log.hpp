#pragma once
/// Where and how an experiment tells what it does.

#include <iosfwd>

namespace routebench {

/// How a run tells how far it is.
enum class ProgressForm {
  kBar,    ///< a line that is written over, with the time to go, for terminals
  kLines,  ///< a line a cell
  kJson,   ///< a JSON object a line, for programs
  kNone    ///< nothing at all
};

/// Where and how a run reports.
struct RunLog {
  std::ostream* out;
  ProgressForm form = ProgressForm::kLines;
};

}  // namespace routebench
