#include "routebench/planning/registry.hpp"

#include <algorithm>
#include <utility>

#include "routebench/geometry/error.hpp"

namespace routebench {
namespace {

bool is_snake_case(const std::string& name) {
  const auto is_small = [](char c) { return c >= 'a' && c <= 'z'; };
  return !name.empty() && is_small(name.front()) &&
         std::all_of(name.begin(), name.end(),
                     [&](char c) { return is_small(c) || (c >= '0' && c <= '9') || c == '_'; });
}

}  // namespace

void Registry::add_entry(Entry entry) {
  const std::string name = entry.info.name;
  if (!is_snake_case(name) && !name.starts_with(kCommandPrefix)) {
    throw Error(ErrorKind::kBadInput,
                "planner name '" + name + "' must be snake_case: small letters, digits, _");
  }
  const auto [place, is_new] = entries_.try_emplace(name, std::move(entry));
  if (!is_new) {
    throw Error(ErrorKind::kBadInput,
                "planner name '" + name + "' is taken (" + place->second.origin + ")");
  }
}

const Registry::Entry& Registry::at(const std::string& name) const {
  const auto found = entries_.find(name);
  if (found != entries_.end()) return found->second;
  std::vector<std::string> names;
  std::string known;
  for (const auto& [other, entry] : entries_) {
    names.push_back(other);
    known += (known.empty() ? "" : ", ") + other;
  }
  const std::optional<std::string> near = nearest_name(name, names);
  throw Error(ErrorKind::kBadInput,
              "unknown planner '" + name + "'" + (near ? " (did you mean '" + *near + "'?)" : "") +
                  (known.empty() ? "; there are none" : "; known are " + known));
}

}  // namespace routebench
