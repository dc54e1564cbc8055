#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <limits>
#include <ostream>
#include <set>
#include <sstream>
#include <tuple>

#include "routebench/harness/metrics.hpp"
#include "routebench/harness/runner.hpp"

namespace routebench {
namespace {

/// Added to both sides of a travel ratio: no travel at all is good, but not infinitely so.
constexpr double kTravelShiftMm = 1;

/// What contenders are compared on: a model with a seed.
using Case = std::pair<std::string, std::uint64_t>;

/// NaN where there is none, which spreads to sums.
double total(const StoredCell& cell, std::string_view metric) {
  return cell.totals.at(metric_index(metric)).value_or(std::numeric_limits<double>::quiet_NaN());
}

/// The cells of one setting, by contender and case.
struct SettingCells {
  std::vector<std::string> contenders;  ///< in the order of the config
  std::vector<Case> cases;
  std::map<std::pair<std::string, Case>, const StoredCell*> cells;

  [[nodiscard]] const StoredCell* at(const std::string& contender, const Case& on) const {
    const auto found = cells.find({contender, on});
    return found == cells.end() ? nullptr : found->second;
  }
  [[nodiscard]] bool is_valid(const std::string& contender, const Case& on) const {
    const StoredCell* cell = at(contender, on);
    return cell != nullptr && cell->outcome == Outcome::kValid;
  }
  [[nodiscard]] std::size_t valid_cases(const std::string& contender) const {
    return static_cast<std::size_t>(std::count_if(
        cases.begin(), cases.end(), [&](const Case& on) { return is_valid(contender, on); }));
  }
};

template <typename T>
void add_once(std::vector<T>& list, const T& value) {
  if (std::find(list.begin(), list.end(), value) == list.end()) list.push_back(value);
}

std::vector<std::pair<std::string, SettingCells>> by_setting(const std::vector<StoredCell>& cells) {
  std::vector<std::pair<std::string, SettingCells>> settings;
  for (const StoredCell& cell : cells) {
    if (settings.empty() || settings.back().first != cell.setting)
      settings.emplace_back(cell.setting, SettingCells{});
    SettingCells& setting = settings.back().second;
    const Case on{cell.model, cell.seed};
    add_once(setting.contenders, cell.contender);
    add_once(setting.cases, on);
    setting.cells[{cell.contender, on}] = &cell;
  }
  return settings;
}

/// One contender in the table; the sums are over the common cases.
struct Rank {
  std::string contender;
  double travel_ratio = 1;  ///< geometric mean
  double travel_mm = 0;
  double retractions = 0;
  double plan_wall_ns = 0;
  std::size_t valid = 0;
};

struct Ranking {
  std::vector<Rank> ranks;               ///< best first
  std::vector<std::string> never_valid;  ///< contenders
  std::vector<Case> common;              ///< on which all ranked contenders are valid
};

Ranking ranking_of(const SettingCells& setting) {
  Ranking ranking;
  for (const std::string& contender : setting.contenders) {
    const std::size_t valid = setting.valid_cases(contender);
    if (valid == 0)
      ranking.never_valid.push_back(contender);
    else
      ranking.ranks.push_back({contender, 1, 0, 0, 0, valid});
  }
  for (const Case& on : setting.cases)
    if (!ranking.ranks.empty() &&
        std::all_of(ranking.ranks.begin(), ranking.ranks.end(),
                    [&](const Rank& rank) { return setting.is_valid(rank.contender, on); }))
      ranking.common.push_back(on);

  std::vector<double> log_sums(ranking.ranks.size(), 0);
  for (const Case& on : ranking.common) {
    const auto travel = [&](const Rank& rank) {
      return total(*setting.at(rank.contender, on), "travel_mm") + kTravelShiftMm;
    };
    double best = travel(ranking.ranks.front());
    for (const Rank& rank : ranking.ranks) best = std::min(best, travel(rank));
    for (std::size_t i = 0; i < ranking.ranks.size(); ++i) {
      Rank& rank = ranking.ranks[i];
      const StoredCell& cell = *setting.at(rank.contender, on);
      log_sums[i] += std::log(travel(rank) / best);
      rank.travel_mm += total(cell, "travel_mm");
      rank.retractions += total(cell, "retractions");
      rank.plan_wall_ns += total(cell, "plan_wall_ns");
    }
  }
  if (!ranking.common.empty())
    for (std::size_t i = 0; i < ranking.ranks.size(); ++i)
      ranking.ranks[i].travel_ratio =
          std::exp(log_sums[i] / static_cast<double>(ranking.common.size()));
  std::stable_sort(ranking.ranks.begin(), ranking.ranks.end(),
                   [](const Rank& a, const Rank& b) { return a.travel_ratio < b.travel_ratio; });
  return ranking;
}

std::string fixed(double value, int digits) {
  if (std::isnan(value)) return "-";
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits) << value;
  return text.str();
}

/// Letters of a text, for columns: a code point a letter.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xc0) != 0x80;
  }));
}

/// Rows of equal length; the second column is set left, the others right.
void write_table(std::ostream& out, const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width_of(row[i]));
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string padding(widths[i] - width_of(row[i]), ' ');
      line += "  " + (i == 1 ? row[i] + padding : padding + row[i]);
    }
    out << line << '\n';
  }
}

void write_setting(std::ostream& out, const std::string& label, const SettingCells& setting) {
  const Ranking ranking = ranking_of(setting);
  out << '\n';
  if (!label.empty()) out << label << '\n';
  const std::string cases = std::to_string(setting.cases.size());
  const bool seeds = std::any_of(setting.cases.begin(), setting.cases.end(), [&](const Case& on) {
    return on.second != setting.cases.front().second;
  });
  const std::string what = seeds ? "models x seeds" : "models";
  if (!ranking.ranks.empty() && ranking.common.empty()) {
    out << "no ranking: on none of the " << cases << ' ' << what << " are all contenders valid\n";
  } else if (!ranking.ranks.empty()) {
    std::vector<std::vector<std::string>> rows{
        {"", "contender", "travel ratio", "travel mm", "retractions", "plan ms", "valid"}};
    for (const Rank& rank : ranking.ranks)
      rows.push_back({std::to_string(rows.size()), rank.contender, fixed(rank.travel_ratio, 3),
                      fixed(rank.travel_mm, 1), fixed(rank.retractions, 0),
                      fixed(rank.plan_wall_ns / 1e6, 1), std::to_string(rank.valid) + "/" + cases});
    write_table(out, rows);
    out << "  over " << ranking.common.size() << " of " << cases << ' ' << what
        << "; the ratio is the geometric mean of travel to the least travel there\n";
  }
  for (const std::string& contender : ranking.never_valid)
    out << "  not ranked: " << contender << " has no valid cell\n";
}

void write_left_out(std::ostream& out, const std::vector<StoredCell>& cells) {
  const auto left_out = std::count_if(cells.begin(), cells.end(), [](const StoredCell& cell) {
    return cell.outcome != Outcome::kValid;
  });
  if (left_out == 0) return;
  out << "\nleft out: " << left_out << " of " << cells.size() << " cells\n";
  const bool seeds = std::any_of(cells.begin(), cells.end(), [&](const StoredCell& cell) {
    return cell.seed != cells.front().seed;
  });
  for (const StoredCell& cell : cells) {
    if (cell.outcome == Outcome::kValid) continue;
    out << "  " << cell.model << " · " << cell.contender;
    if (!cell.setting.empty()) out << " · " << cell.setting;
    if (seeds) out << " · seed " << cell.seed;
    out << ": " << to_string(cell.outcome);
    if (!cell.reason.empty()) out << " (" << cell.reason << ")";
    out << '\n';
  }
}

}  // namespace

bool all_valid(const std::vector<StoredCell>& cells) {
  return std::all_of(cells.begin(), cells.end(), [](const StoredCell& cell) {
    return cell.outcome == Outcome::kValid || cell.outcome == Outcome::kNotInstalled;
  });
}

void write_ranking(std::ostream& out, const std::vector<StoredCell>& cells) {
  out << cells.size() << (cells.size() == 1 ? " cell:" : " cells:");
  const char* separator = " ";
  for (const Outcome outcome : outcomes()) {
    const auto count = std::count_if(cells.begin(), cells.end(), [&](const StoredCell& cell) {
      return cell.outcome == outcome;
    });
    if (count == 0 && outcome != Outcome::kValid) continue;
    out << separator << count << ' ' << to_string(outcome);
    separator = ", ";
  }
  out << '\n';
  for (const auto& [label, setting] : by_setting(cells)) write_setting(out, label, setting);
  write_left_out(out, cells);
}

}  // namespace routebench
