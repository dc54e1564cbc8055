#include "routebench/planning/tour.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "routebench/geometry/vec.hpp"
#include "routebench/planning/nearest_grid.hpp"

namespace routebench {
namespace {

constexpr std::size_t kWindow = 250;  // how far apart in the tour a move may reach
constexpr int kPasses = 30;           // of the local search at most
constexpr double kGainMm = 1e-6;      // less is rounding

std::vector<Visit> nearest_item_first(const std::vector<TourItem>& items, Point2 start,
                                      const PlanContext& context) {
  std::vector<Point2> points;
  std::vector<Visit> visits;  // of a point
  std::vector<std::uint32_t> first_point;
  for (std::uint32_t i = 0; i < items.size(); ++i) {
    first_point.push_back(static_cast<std::uint32_t>(points.size()));
    for (std::uint32_t way = 0; way < items[i].ways.size(); ++way) {
      points.push_back(items[i].ways[way].in);
      visits.push_back({i, way});
    }
  }
  NearestGrid grid(std::move(points));
  std::vector<Visit> tour;
  while (const auto nearest = grid.nearest(start)) {
    stop_if_asked(context);
    const Visit visit = visits[*nearest];
    const std::vector<Way>& ways = items[visit.item].ways;
    for (std::uint32_t way = 0; way < ways.size(); ++way)
      grid.remove(first_point[visit.item] + way);
    start = ways[visit.way].out;
    tour.push_back(visit);
  }
  return tour;
}

/// Makes a tour shorter, move by move.
class LocalSearch {
 public:
  LocalSearch(const std::vector<TourItem>& items, std::vector<Visit> tour, Point2 start)
      : items_(items), tour_(std::move(tour)), start_(start) {}

  std::vector<Visit> run(const PlanContext& context) {
    bool better = true;
    for (int pass = 0; better && pass < kPasses; ++pass) {
      better = false;
      for (std::size_t i = 0; i < tour_.size(); ++i) {
        stop_if_asked(context);
        better |= choose_way(i);
        const std::size_t end = std::min(tour_.size(), i + kWindow);
        for (std::size_t j = i; j < end; ++j) better |= turn_round(i, j);
        for (std::size_t k = i + 1; k < end; ++k) better |= move_behind(i, k) || move_before(i, k);
      }
    }
    return std::move(tour_);
  }

 private:
  static Visit turned(Visit visit) { return {visit.item, visit.way ^ 1U}; }
  [[nodiscard]] const Way& way(Visit visit) const { return items_[visit.item].ways[visit.way]; }
  [[nodiscard]] Point2 in(Visit visit) const { return way(visit).in; }
  [[nodiscard]] Point2 out(Visit visit) const { return way(visit).out; }
  [[nodiscard]] Point2 before(std::size_t i) const { return i == 0 ? start_ : out(tour_[i - 1]); }
  /// From a place to where visit `next` begins; the tour ends anywhere.
  [[nodiscard]] double gap_mm(Point2 from, std::size_t next) const {
    return next < tour_.size() ? distance(from, in(tour_[next])) : 0;
  }
  /// What a visit between `from` and visit `next` makes longer.
  [[nodiscard]] double detour_mm(Point2 from, Visit visit, std::size_t next) const {
    return distance(from, in(visit)) + gap_mm(out(visit), next) - gap_mm(from, next);
  }
  [[nodiscard]] Visit better_of_both(Point2 from, Visit visit, std::size_t next) const {
    return detour_mm(from, turned(visit), next) < detour_mm(from, visit, next) ? turned(visit)
                                                                               : visit;
  }
  std::vector<Visit>::iterator at(std::size_t i) {
    return tour_.begin() + static_cast<std::ptrdiff_t>(i);
  }

  bool choose_way(std::size_t i) {
    const std::uint32_t item = tour_[i].item;
    Visit best = tour_[i];
    for (std::uint32_t way = 0; way < items_[item].ways.size(); ++way)
      if (detour_mm(before(i), {item, way}, i + 1) < detour_mm(before(i), best, i + 1) - kGainMm)
        best.way = way;
    return std::exchange(tour_[i], best) != best;
  }

  /// Takes the visits from i to j the other way round.
  bool turn_round(std::size_t i, std::size_t j) {
    const Point2 from = before(i);
    const double now_mm = distance(from, in(tour_[i])) + gap_mm(out(tour_[j]), j + 1);
    const double then_mm = distance(from, out(tour_[j])) + gap_mm(in(tour_[i]), j + 1);
    if (then_mm >= now_mm - kGainMm) return false;
    std::reverse(at(i), at(j + 1));
    std::transform(at(i), at(j + 1), at(i), turned);
    return true;
  }

  /// Takes visit i out and puts it behind visit k > i.
  bool move_behind(std::size_t i, std::size_t k) {
    const Point2 from = out(tour_[k]);
    const Visit moved = better_of_both(from, tour_[i], k + 1);
    if (detour_mm(from, moved, k + 1) >= detour_mm(before(i), tour_[i], i + 1) - kGainMm)
      return false;
    std::rotate(at(i), at(i + 1), at(k + 1));
    tour_[k] = moved;
    return true;
  }

  /// Takes visit k > i out and puts it before visit i.
  bool move_before(std::size_t i, std::size_t k) {
    const Visit moved = better_of_both(before(i), tour_[k], i);
    if (detour_mm(before(i), moved, i) >= detour_mm(before(k), tour_[k], k + 1) - kGainMm)
      return false;
    std::rotate(at(i), at(k), at(k + 1));
    tour_[i] = moved;
    return true;
  }

  const std::vector<TourItem>& items_;
  std::vector<Visit> tour_;
  Point2 start_;
};

}  // namespace

std::vector<Visit> short_tour(const std::vector<TourItem>& items, Point2 start,
                              const PlanContext& context) {
  return LocalSearch(items, nearest_item_first(items, start, context), start).run(context);
}

std::vector<Stroke> in_short_order(std::vector<Stroke> strokes, Point2 start,
                                   const PlanContext& context) {
  std::vector<TourItem> items;
  for (const Stroke& stroke : strokes) {
    const Point2 a = stroke.points.front(), b = stroke.points.back();
    items.push_back({{{a, b}, {b, a}}});
  }
  std::vector<Stroke> ordered;
  for (const Visit& visit : short_tour(items, start, context)) {
    Stroke& stroke = ordered.emplace_back(std::move(strokes[visit.item]));
    if (visit.way == 1) std::reverse(stroke.points.begin(), stroke.points.end());
  }
  return ordered;
}

}  // namespace routebench
