#include "slicing/close_gaps.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <utility>

#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench::slicing {
namespace {

/// The largest share of a ring that may be invented: with more, the lines are taken for a surface
/// without thickness. A half tube still closes to a half disc; a flat or slightly bent sheet does
/// not.
constexpr double kMaxInventedShare = 0.4;

/// Line c begins at end 2 c and finishes at end 2 c + 1.
using End = std::uint32_t;

constexpr double kFirstReachMm = 1 / kGridUnitsPerMm;
constexpr double kReachFactor = 4;
constexpr std::size_t kPairsPerSite = 32;

End other_end(End end) { return end ^ 1u; }
bool is_finish(End end) { return (end & 1u) != 0; }

/// Free ends at one point. Those up to `next` are taken.
struct EndList {
  std::vector<End> ends;
  std::size_t next = 0;
  [[nodiscard]] std::size_t free() const { return ends.size() - next; }
  End take() { return ends[next++]; }
};

struct Site {
  Point2 at;
  EndList begins;
  EndList finishes;
};

/// Greedy matching of line ends by distance: of all pairs the closest first. Up to crack_mm, ends
/// are joined to beginnings wherever there is a choice; what is left may also be joined end to end
/// or beginning to beginning (neighbouring facets that disagree on what is outside). Beyond, such a
/// pair counts as crack_mm further apart than it is.
class EndMatching {
 public:
  EndMatching(const std::vector<Chain>& lines, double crack_mm)
      : crack_mm_(crack_mm), mates_(2 * lines.size()) {
    gather_sites(lines);
    match_up_to(crack_mm, {.directed = true, .clashing = false});
    match_up_to(crack_mm, {.directed = false, .clashing = true});
    for (double reach_mm = std::max(kFirstReachMm, 2 * crack_mm); free_ends_ > 0; reach_mm *= 2)
      match(candidates_within(reach_mm, {.directed = true, .clashing = true}));
  }

  [[nodiscard]] End mate(End end) const { return mates_[end]; }

 private:
  /// Which pairs are wanted.
  struct Kinds {
    bool directed, clashing;
  };
  struct Candidate {
    double cost_mm;
    std::uint32_t a, b;  // sites, a <= b
    bool clash;
  };
  struct Cell {
    std::int64_t row, column;
    std::uint32_t site;
    friend auto operator<=>(const Cell&, const Cell&) = default;
  };

  void gather_sites(const std::vector<Chain>& lines) {
    std::vector<std::pair<Point2, End>> ends;
    for (End line = 0; line < lines.size(); ++line) {
      ends.emplace_back(lines[line].front(), 2 * line);
      ends.emplace_back(lines[line].back(), 2 * line + 1);
    }
    free_ends_ = ends.size();
    std::sort(ends.begin(), ends.end(), [](const auto& a, const auto& b) {
      return std::tie(a.first.x, a.first.y, a.second) < std::tie(b.first.x, b.first.y, b.second);
    });
    for (const auto& [at, end] : ends) {
      if (sites_.empty() || sites_.back().at != at) sites_.push_back({at, {}, {}});
      (is_finish(end) ? sites_.back().finishes : sites_.back().begins).ends.push_back(end);
    }
  }

  /// Where ends are dense it begins with a short reach: the pairs that it joins are out of the way
  /// when the reach grows, so that candidates stay few.
  void match_up_to(double limit_mm, Kinds kinds) {
    double reach_mm = limit_mm;
    while (reach_mm > kFirstReachMm && is_dense(reach_mm)) reach_mm /= kReachFactor;
    for (; reach_mm < limit_mm; reach_mm *= kReachFactor) match(candidates_within(reach_mm, kinds));
    match(candidates_within(limit_mm, kinds));
  }

  void match(std::vector<Candidate> candidates) {
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& x, const Candidate& y) {
      return std::tie(x.cost_mm, x.a, x.b, x.clash) < std::tie(y.cost_mm, y.a, y.b, y.clash);
    });
    for (const Candidate& c : candidates) {
      Site& a = sites_[c.a];
      Site& b = sites_[c.b];
      join(a.begins, c.clash ? b.begins : b.finishes);
      join(a.finishes, c.clash ? b.finishes : b.begins);
    }
    std::erase_if(sites_,
                  [](const Site& s) { return s.begins.free() == 0 && s.finishes.free() == 0; });
  }

  /// Joins as many ends of two lists as both have; they may be one and the same.
  void join(EndList& a, EndList& b) {
    const std::size_t needed = &a == &b ? 2 : 1;
    while (a.free() >= needed && b.free() >= needed) {
      const End x = a.take(), y = b.take();
      mates_[x] = y;
      mates_[y] = x;
      free_ends_ -= 2;
    }
  }

  /// Calls visit(a, b) for all sites a <= b that may be within the reach, until it returns false.
  template <typename Visit>
  void visit_pairs(double reach_mm, Visit&& visit) const {
    // Cells as wide as the reach: partners are in the same or in a neighbouring one.
    const double cell_mm = std::max(reach_mm, kFirstReachMm);
    const auto cell_of = [&](std::uint32_t site) {
      const Point2 at = sites_[site].at;
      return Cell{static_cast<std::int64_t>(std::floor(at.y / cell_mm)),
                  static_cast<std::int64_t>(std::floor(at.x / cell_mm)), site};
    };
    std::vector<Cell> cells;
    for (std::uint32_t s = 0; s < sites_.size(); ++s) cells.push_back(cell_of(s));
    std::sort(cells.begin(), cells.end());
    for (const Cell& own : cells)
      for (std::int64_t row = own.row - 1; row <= own.row + 1; ++row) {
        const Cell from{row, own.column - 1, 0};
        for (auto cell = std::lower_bound(cells.begin(), cells.end(), from);
             cell != cells.end() && cell->row == row && cell->column <= own.column + 1; ++cell)
          if (cell->site >= own.site && !visit(own.site, cell->site)) return;
      }
  }

  [[nodiscard]] bool is_dense(double reach_mm) const {
    const std::size_t limit = kPairsPerSite * sites_.size();
    std::size_t pairs = 0;
    visit_pairs(reach_mm, [&](std::uint32_t, std::uint32_t) { return ++pairs <= limit; });
    return pairs > limit;
  }

  [[nodiscard]] std::vector<Candidate> candidates_within(double reach_mm, Kinds kinds) const {
    std::vector<Candidate> candidates;
    visit_pairs(reach_mm, [&](std::uint32_t a, std::uint32_t b) {
      const double apart_mm = distance(sites_[a].at, sites_[b].at);
      if (apart_mm > reach_mm) return true;
      if (kinds.directed && can_join(a, b)) candidates.push_back({apart_mm, a, b, false});
      if (kinds.clashing && can_clash(a, b))
        candidates.push_back({apart_mm + crack_mm_, a, b, true});
      return true;
    });
    return candidates;
  }

  [[nodiscard]] bool can_join(std::uint32_t a, std::uint32_t b) const {
    const Site &x = sites_[a], &y = sites_[b];
    return (x.begins.free() > 0 && y.finishes.free() > 0) ||
           (x.finishes.free() > 0 && y.begins.free() > 0);
  }
  [[nodiscard]] bool can_clash(std::uint32_t a, std::uint32_t b) const {
    const Site &x = sites_[a], &y = sites_[b];
    const std::size_t needed = a == b ? 2 : 1;
    return (x.begins.free() >= needed && y.begins.free() >= needed) ||
           (x.finishes.free() >= needed && y.finishes.free() >= needed);
  }

  double crack_mm_;
  std::vector<End> mates_;
  std::vector<Site> sites_;  // that have free ends, by coordinates
  std::size_t free_ends_ = 0;
};

double length_mm(const Chain& line) {
  double length = 0;
  for (std::size_t i = 1; i < line.size(); ++i) length += distance(line[i - 1], line[i]);
  return length;
}

/// Open lines joined end to end, before it is decided whether they make a ring.
struct Round {
  Ring points;
  std::vector<std::pair<double, Point2>> gaps;  // width in mm, and where
  std::size_t lines = 0;
  std::size_t turned = 0;
  double along_mm = 0;    // length of the lines that are run in their direction
  double against_mm = 0;  // and of the others
};

/// Goes round from the beginning of a line over mates until it is back.
Round go_round(const std::vector<Chain>& open, const EndMatching& matching, End first) {
  Round round;
  End entry = first;
  do {
    const Chain& line = open[entry / 2];
    if (is_finish(entry)) {
      round.points.insert(round.points.end(), line.rbegin(), line.rend());
      round.against_mm += length_mm(line);
      ++round.turned;
    } else {
      round.points.insert(round.points.end(), line.begin(), line.end());
      round.along_mm += length_mm(line);
    }
    ++round.lines;
    const Point2 exit = round.points.back();
    entry = matching.mate(other_end(entry));
    const Chain& next = open[entry / 2];
    round.gaps.emplace_back(distance(exit, is_finish(entry) ? next.back() : next.front()), exit);
  } while (entry != first);
  return round;
}

/// The direction of a ring is that of the greater part of its lines.
void direct(Round& round) {
  const bool turn = round.against_mm == round.along_mm ? signed_area_mm2(round.points) < 0
                                                       : round.against_mm > round.along_mm;
  if (!turn) return;
  std::reverse(round.points.begin(), round.points.end());
  round.turned = round.lines - round.turned;
}

/// Notes a round in the report and says whether it makes a ring.
bool accept(const Round& round, double crack_mm, Closing& closing) {
  const double real_mm = round.along_mm + round.against_mm;
  double invented_mm = 0;
  for (const auto& [width_mm, at] : round.gaps) {
    if (width_mm <= crack_mm) continue;
    invented_mm += width_mm;
    if (width_mm > closing.widest_open_mm) {
      closing.widest_open_mm = width_mm;
      closing.widest_open_at = at;
    }
  }
  if (invented_mm > kMaxInventedShare * (real_mm + invented_mm)) {
    closing.dropped += round.lines;
    closing.longest_dropped_mm = std::max(closing.longest_dropped_mm, real_mm);
    return false;
  }
  for (const auto& [width_mm, at] : round.gaps) {
    if (width_mm > crack_mm) {
      ++closing.gaps;
      closing.widest_gap_mm = std::max(closing.widest_gap_mm, width_mm);
    } else if (width_mm > 0) {
      ++closing.cracks;
      closing.widest_crack_mm = std::max(closing.widest_crack_mm, width_mm);
    }
  }
  closing.turned += round.turned;
  return true;
}

}  // namespace

Closing close_gaps(const std::vector<Chain>& open, double crack_mm, std::vector<Ring>& rings) {
  Closing closing;
  const EndMatching matching(open, crack_mm);
  std::vector<bool> used(open.size());
  for (End line = 0; line < open.size(); ++line) {
    if (used[line]) continue;
    Round round = go_round(open, matching, 2 * line);
    for (End entry = 2 * line; !used[entry / 2]; entry = matching.mate(other_end(entry)))
      used[entry / 2] = true;
    direct(round);
    if (accept(round, crack_mm, closing)) rings.push_back(std::move(round.points));
  }
  return closing;
}

}  // namespace routebench::slicing
