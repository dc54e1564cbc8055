#include "model/model_spec.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "model/raw_mesh.hpp"

namespace routebench::models {
namespace {

void parse_query(const std::string& spec, std::string_view text,
                 std::map<std::string, std::string>& query) {
  while (!text.empty()) {
    const std::string_view item = text.substr(0, text.find('&'));
    text.remove_prefix(std::min(text.size(), item.size() + 1));
    const std::size_t equals = item.find('=');
    if (equals == std::string_view::npos || equals == 0 || equals + 1 == item.size()) {
      refuse_model(spec, in_quotes(item) + " after the question mark is not key=value");
    }
    const std::string key(item.substr(0, equals));
    if (!query.emplace(key, item.substr(equals + 1)).second) {
      refuse_model(spec, "key " + in_quotes(key) + " is given twice");
    }
  }
}

bool is_existing_file(const std::string& path) {
  std::error_code unknown;
  return std::filesystem::exists(path, unknown);
}

/// A number of the query, taken out of it.
std::optional<double> take_number(const std::string& spec, ModelSpec& parsed,
                                  const std::string& key, double least, double most,
                                  const std::string& what) {
  const auto item = parsed.query.extract(key);
  if (!item) return std::nullopt;
  const std::string& text = item.mapped();
  double value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && stop == text.data() + text.size();
  if (!whole || !(value >= least && value <= most))
    refuse_model(spec, key + "=" + text + " must be " + what);
  return value;
}

}  // namespace

ModelSpec parse_model_spec(const std::string& spec) {
  if (spec.find('\0') != std::string::npos) refuse_model(spec, "a name with a zero byte");
  ModelSpec parsed;
  std::string_view rest = spec;
  if (rest.starts_with("shape:")) {
    parsed.scheme = ModelSpec::Scheme::kShape;
    rest.remove_prefix(6);
  } else if (rest.starts_with("cgal:")) {
    parsed.scheme = ModelSpec::Scheme::kCgal;
    rest.remove_prefix(5);
  }
  const bool whole = parsed.scheme == ModelSpec::Scheme::kFile && is_existing_file(spec);
  const std::size_t question = whole ? std::string_view::npos : rest.rfind('?');
  parsed.subject = rest.substr(0, question);
  if (parsed.subject.empty()) refuse_model(spec, "no model is named");
  if (question != std::string_view::npos) {
    parse_query(spec, rest.substr(question + 1), parsed.query);
  }
  return parsed;
}

std::optional<double> take_size_mm(const std::string& spec, ModelSpec& parsed) {
  return take_number(spec, parsed, "size", 0.01, 10'000, "a number of mm in 0.01..10000");
}

std::optional<double> take_simplify_share(const std::string& spec, ModelSpec& parsed) {
  return take_number(spec, parsed, "simplify", 0.001, 1,
                     "the share of triangles to be left, in 0.001..1");
}

}  // namespace routebench::models
