#include "routebench/planning/line_crossings.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>

namespace routebench {
namespace {

/// An edge that spans at least one line.
struct Span {
  Point2 low;
  Point2 high;
  std::uint32_t ring;
  std::uint32_t edge;
  std::uint32_t first_line;
  std::uint32_t end_line;

  [[nodiscard]] Crossing at(const EvenLines& lines, std::uint32_t line) const {
    // Always from the lower to the upper end, and never beyond either.
    const double share = (lines.y(line) - low.y) / (high.y - low.y);
    const double x = low.x + share * (high.x - low.x);
    const auto [left, right] = std::minmax(low.x, high.x);
    return {std::clamp(x, left, right), line, ring, edge};
  }
};

std::vector<Span> spans_of(const std::vector<Ring>& rings, const EvenLines& lines) {
  std::vector<Span> spans;
  for (std::uint32_t r = 0; r < rings.size(); ++r) {
    const Ring& ring = rings[r];
    for (std::uint32_t e = 0; e < ring.size(); ++e) {
      Point2 low = ring[e], high = ring[e + 1 < ring.size() ? e + 1 : 0];
      if (low.y > high.y) std::swap(low, high);
      const std::uint32_t first = lines.first_at_or_above(low.y);
      const std::uint32_t end = lines.first_at_or_above(high.y);
      if (first < end) spans.push_back({low, high, r, e, first, end});
    }
  }
  return spans;
}

std::vector<Crossing> by_bucket(const std::vector<Span>& spans, const EvenLines& lines) {
  std::vector<std::size_t> place(std::size_t{lines.count} + 1, 0);
  for (const Span& span : spans)
    for (std::uint32_t line = span.first_line; line < span.end_line; ++line) ++place[line + 1];
  for (std::size_t line = 1; line < place.size(); ++line) place[line] += place[line - 1];
  std::vector<Crossing> crossings(place.back());
  for (const Span& span : spans)
    for (std::uint32_t line = span.first_line; line < span.end_line; ++line)
      crossings[place[line]++] = span.at(lines, line);
  return crossings;
}

std::vector<Crossing> by_naive(const std::vector<Span>& spans, const EvenLines& lines) {
  std::vector<Crossing> crossings;
  for (std::uint32_t line = 0; line < lines.count; ++line)
    for (const Span& span : spans)
      if (span.first_line <= line && line < span.end_line)
        crossings.push_back(span.at(lines, line));
  return crossings;
}

std::vector<Crossing> by_sweep(const std::vector<Span>& spans, const EvenLines& lines) {
  std::vector<std::size_t> entering(spans.size());
  for (std::size_t i = 0; i < spans.size(); ++i) entering[i] = i;
  std::sort(entering.begin(), entering.end(), [&](std::size_t a, std::size_t b) {
    return std::tie(spans[a].first_line, a) < std::tie(spans[b].first_line, b);
  });
  std::vector<Crossing> crossings;
  std::vector<std::size_t> active;
  auto next = entering.begin();
  for (std::uint32_t line = 0; line < lines.count; ++line) {
    std::erase_if(active, [&](std::size_t i) { return spans[i].end_line <= line; });
    for (; next != entering.end() && spans[*next].first_line == line; ++next)
      active.push_back(*next);
    for (const std::size_t i : active) crossings.push_back(spans[i].at(lines, line));
  }
  return crossings;
}

}  // namespace

std::uint32_t EvenLines::first_at_or_above(double y_mm) const noexcept {
  const double guess = std::ceil((y_mm - first_mm) / step_mm);
  std::uint32_t line =
      static_cast<std::uint32_t>(std::clamp(guess, 0.0, static_cast<double>(count)));
  // The guess is rounded; the lines themselves decide.
  while (line > 0 && y(line - 1) >= y_mm) --line;
  while (line < count && y(line) < y_mm) ++line;
  return line;
}

std::vector<Crossing> cross_lines(const std::vector<Ring>& rings, const EvenLines& lines,
                                  CrossingSearch search) {
  const std::vector<Span> spans = spans_of(rings, lines);
  std::vector<Crossing> crossings = search == CrossingSearch::kBucket  ? by_bucket(spans, lines)
                                    : search == CrossingSearch::kSweep ? by_sweep(spans, lines)
                                                                       : by_naive(spans, lines);
  // They come line by line; only within a line are they out of order.
  for (auto begin = crossings.begin(); begin != crossings.end();) {
    const auto end = std::find_if(begin, crossings.end(),
                                  [&](const Crossing& c) { return c.line != begin->line; });
    std::sort(begin, end, [](const Crossing& a, const Crossing& b) {
      return std::tie(a.x, a.ring, a.edge) < std::tie(b.x, b.ring, b.edge);
    });
    begin = end;
  }
  return crossings;
}

}  // namespace routebench
