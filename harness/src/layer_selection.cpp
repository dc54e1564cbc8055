#include "layer_selection.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

#include "routebench/geometry/error.hpp"

namespace routebench {
namespace {

constexpr std::string_view kRangeMark = "..";

struct IndexRange {
  int first;
  int last;
};

std::optional<int> index_in(std::string_view text) {
  int index = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (error != std::errc{} || end != text.data() + text.size() || index < 0) return std::nullopt;
  return index;
}

IndexRange range_in(std::string_view text) {
  const std::size_t mark = text.find(kRangeMark);
  const std::optional<int> first = index_in(text.substr(0, mark));
  const std::optional<int> last =
      mark == text.npos ? first : index_in(text.substr(mark + kRangeMark.size()));
  if (!first || !last || *first > *last)
    throw Error(ErrorKind::kBadUsage,
                "--layers: '" + std::string(text) +
                    "' is neither a layer's index nor a range of them; write 3 or 10..20");
  return {*first, *last};
}

}  // namespace

std::vector<std::size_t> select_layers(const std::string& text, const std::vector<Layer>& layers) {
  std::vector<IndexRange> ranges;
  for (std::size_t begin = 0; !text.empty() && begin <= text.size();) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    ranges.push_back(range_in(std::string_view(text).substr(begin, comma - begin)));
    begin = comma + 1;
  }
  const auto has = [&](int index) {
    return std::any_of(layers.begin(), layers.end(),
                       [index](const Layer& layer) { return layer.index == index; });
  };
  for (const IndexRange& range : ranges)
    for (const int index : {range.first, range.last})
      if (!has(index))
        throw Error(
            ErrorKind::kBadUsage,
            "--layers: there is no layer " + std::to_string(index) +
                (layers.empty() ? "; the model has none"
                                : "; the model has layers " + std::to_string(layers.front().index) +
                                      ".." + std::to_string(layers.back().index)));
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const int index = layers[i].index;
    const bool meant = std::any_of(ranges.begin(), ranges.end(), [index](const IndexRange& range) {
      return range.first <= index && index <= range.last;
    });
    if (meant || text.empty()) chosen.push_back(i);
  }
  return chosen;
}

}  // namespace routebench
