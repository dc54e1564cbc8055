#pragma once
/// The parameters of a `shape:` model: read once each, by name, with default and range.

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace routebench::shapes {

class ShapeQuery {
 public:
  /// `spec` is the whole name, for messages.
  ShapeQuery(std::string spec, std::map<std::string, std::string> values);

  /// A length, mm.
  [[nodiscard]] double mm(const char* key, double by_default, double lowest = 0.01,
                          double highest = 10'000);
  [[nodiscard]] double number(const char* key, double by_default, double lowest, double highest);
  [[nodiscard]] int count(const char* key, int by_default, int lowest, int highest);
  [[nodiscard]] std::string text(const char* key, std::string by_default);
  [[nodiscard]] std::uint64_t seed();
  /// About how many triangles the mesh shall have; the shape comes as near as its structure lets
  /// it.
  [[nodiscard]] std::size_t triangles(std::size_t by_default);

  /// To be called when all parameters are read and before anything is made of them.
  /// Throws Error{kBadInput} if a key was given that nobody asked for, with the nearest one.
  void finish() const;

  /// Throws Error{kBadInput} for parameters that do not go together.
  [[noreturn]] void refuse(const std::string& complaint) const;

 private:
  [[nodiscard]] const std::string* given(const char* key);
  [[nodiscard]] std::int64_t whole(const char* key, std::int64_t by_default, std::int64_t lowest,
                                   std::int64_t highest);

  std::string spec_;
  std::map<std::string, std::string> values_;
  std::vector<std::string> known_;
};

}  // namespace routebench::shapes
