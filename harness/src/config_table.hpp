#pragma once
/// Reading a TOML table key by key, with messages that name file, line and key.

#include <toml++/toml.h>

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "routebench/planning/params.hpp"

namespace routebench {

/// A key of a table with what stands there.
struct ConfigEntry {
  std::string key;
  const toml::node* node = nullptr;
  std::string place;  ///< "FILE:LINE"
  unsigned line = 0;
  unsigned column = 0;

  /// Throws Error{kBadInput}: "FILE:LINE: key `KEY`: COMPLAINT".
  [[noreturn]] void refuse(const std::string& complaint) const;
  /// As refuse: "must be WANTED, not VALUE".
  [[noreturn]] void refuse_value(const std::string& wanted) const;

  [[nodiscard]] std::string text() const;
  /// Within [lowest, highest], else refused.
  [[nodiscard]] std::int64_t whole_number(std::int64_t lowest, std::int64_t highest) const;
  [[nodiscard]] double number(double lowest, double highest) const;
  [[nodiscard]] const toml::array& list(const std::string& of_what) const;
  [[nodiscard]] const toml::table& table(const std::string& example) const;
  /// A truth value, number or text.
  [[nodiscard]] ParamValue value() const;
  /// The elements of a list as entries of the same key.
  [[nodiscard]] std::vector<ConfigEntry> elements(const std::string& of_what) const;
};

/// A table whose keys are known beforehand.
class ConfigTable {
 public:
  /// `title` is how messages call the table: "[run]".
  ConfigTable(std::string file, std::string title, const toml::table& table);

  /// Throws Error{kBadInput} for a key that is not among the known ones, with the nearest of them.
  void require_known(const std::vector<std::string>& known) const;

  [[nodiscard]] std::optional<ConfigEntry> find(std::string_view key) const;
  /// Throws Error{kBadInput} if the key is missing.
  [[nodiscard]] ConfigEntry at(std::string_view key) const;
  /// In the order in which they are written.
  [[nodiscard]] std::vector<ConfigEntry> entries() const;
  [[nodiscard]] const std::string& place() const noexcept { return place_; }

 private:
  [[nodiscard]] ConfigEntry entry(const toml::key& key, const toml::node& node) const;

  std::string file_;
  std::string title_;
  std::string place_;
  const toml::table* table_;
};

/// What stands at a node, for messages: `"fast"`, `3`, `a list`.
[[nodiscard]] std::string shown(const toml::node& node);

/// "; did you mean `x`?", or the known words if none is near.
[[nodiscard]] std::string suggestion(std::string_view word, const std::vector<std::string>& known);

}  // namespace routebench
