#pragma once
/// The one exception type of routebench.

#include <stdexcept>
#include <string>
#include <string_view>

namespace routebench {

enum class ErrorKind {
  kBadUsage,  ///< a command line or a call that cannot be meant
  kBadInput,  ///< a file, model, config or parameter that cannot be used
  kStopped,   ///< a planner was asked to stop and did
  kInternal,  ///< our own fault
};

/// Thrown where the outside world comes in. The message is one line that names the file, key or
/// layer, says what is wrong and what would be right.
class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  Error(const Error&) = default;
  Error& operator=(const Error&) = default;
  ~Error() override;  // out of line: the type has one identity across shared libraries

  [[nodiscard]] ErrorKind kind() const noexcept { return kind_; }

 private:
  ErrorKind kind_;
};

/// A text that may quote anything, as a message may show it: blanks for its line ends and tabs, '?'
/// for other control bytes, which terminals obey, and for bytes that are no UTF-8. Ends in dots
/// after 4000 bytes.
[[nodiscard]] std::string one_line(std::string_view text);

}  // namespace routebench
