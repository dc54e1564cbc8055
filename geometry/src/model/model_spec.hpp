#pragma once
/// The grammar of a model's name.

#include <map>
#include <optional>
#include <string>

namespace routebench::models {

/// A name taken apart: SCHEME:SUBJECT?key=value&key=value
struct ModelSpec {
  enum class Scheme { kFile, kShape, kCgal };
  Scheme scheme = Scheme::kFile;
  std::string subject;                       ///< path, shape name or path in the archive
  std::map<std::string, std::string> query;  ///< as written
};

/// A file whose name contains a question mark is found under its whole name first.
/// Throws Error{kBadInput} for an empty name, a key without value or given twice.
[[nodiscard]] ModelSpec parse_model_spec(const std::string& spec);

/// The largest side that a spec asks for, mm, taken out of its query.
/// Throws Error{kBadInput} for what is not a length between 0.01 mm and 10 m.
[[nodiscard]] std::optional<double> take_size_mm(const std::string& spec, ModelSpec& parsed);

/// The share of the triangles that a spec wants to be left, taken out of its query.
/// Throws Error{kBadInput} for what is not in 0.001..1.
[[nodiscard]] std::optional<double> take_simplify_share(const std::string& spec, ModelSpec& parsed);

}  // namespace routebench::models
