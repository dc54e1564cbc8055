#include "shapes/shape_query.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <utility>

#include "model/raw_mesh.hpp"
#include "routebench/geometry/nearest_name.hpp"

namespace routebench::shapes {

ShapeQuery::ShapeQuery(std::string spec, std::map<std::string, std::string> values)
    : spec_(std::move(spec)), values_(std::move(values)) {}

void ShapeQuery::refuse(const std::string& complaint) const {
  models::refuse_model(spec_, complaint);
}

const std::string* ShapeQuery::given(const char* key) {
  known_.emplace_back(key);
  const auto found = values_.find(key);
  return found == values_.end() ? nullptr : &found->second;
}

double ShapeQuery::mm(const char* key, double by_default, double lowest, double highest) {
  return number(key, by_default, lowest, highest);
}

double ShapeQuery::number(const char* key, double by_default, double lowest, double highest) {
  const std::string* const text = given(key);
  if (text == nullptr) return by_default;
  double value = 0;
  const auto [stop, error] = std::from_chars(text->data(), text->data() + text->size(), value);
  const bool read = error == std::errc() && stop == text->data() + text->size();
  if (!read || !(value >= lowest && value <= highest)) {
    refuse(std::string(key) + '=' + *text + " must be a number in " + models::rounded(lowest) +
           ".." + models::rounded(highest));
  }
  return value;
}

std::int64_t ShapeQuery::whole(const char* key, std::int64_t by_default, std::int64_t lowest,
                               std::int64_t highest) {
  const std::string* const text = given(key);
  if (text == nullptr) return by_default;
  std::int64_t value = 0;
  const auto [stop, error] = std::from_chars(text->data(), text->data() + text->size(), value);
  const bool read = error == std::errc() && stop == text->data() + text->size();
  if (!read || value < lowest || value > highest) {
    refuse(std::string(key) + '=' + *text + " must be a whole number in " + std::to_string(lowest) +
           ".." + std::to_string(highest));
  }
  return value;
}

int ShapeQuery::count(const char* key, int by_default, int lowest, int highest) {
  return static_cast<int>(whole(key, by_default, lowest, highest));
}

std::string ShapeQuery::text(const char* key, std::string by_default) {
  const std::string* const text = given(key);
  return text == nullptr ? std::move(by_default) : *text;
}

std::uint64_t ShapeQuery::seed() {
  return static_cast<std::uint64_t>(whole("seed", 1, 0, std::numeric_limits<std::int64_t>::max()));
}

std::size_t ShapeQuery::triangles(std::size_t by_default) {
  constexpr std::int64_t kMost = 50'000'000;
  return static_cast<std::size_t>(
      whole("triangles", static_cast<std::int64_t>(by_default), 4, kMost));
}

void ShapeQuery::finish() const {
  for (const auto& [key, value] : values_) {
    if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
    std::vector<std::string> names = known_;
    names.emplace_back("size");
    const auto near = nearest_name(key, names);
    std::sort(names.begin(), names.end());
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
    refuse("unknown parameter " + models::in_quotes(key) +
           (near ? ", did you mean " + models::in_quotes(*near) + "?" : "") + " (known: " + list +
           ")");
  }
}

}  // namespace routebench::shapes
