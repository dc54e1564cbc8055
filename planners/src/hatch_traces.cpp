#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/planning/hatch.hpp"

namespace routebench {
namespace {

/// What has been traced so far, as samples in square cells.
class Traces {
 public:
  explicit Traces(double reach_mm) : reach_mm_(reach_mm) {}

  void begin_run() { ++run_; }
  /// The samples of the run that was begun last count no longer.
  void drop_run() { dropped_.insert(run_); }

  void add(Point2 p, double along_mm) {
    cells_[key(column(p.x), column(p.y))].push_back({p, along_mm, run_});
  }

  /// True if a trace passes near: another one, or this one at an earlier place.
  [[nodiscard]] bool near(Point2 p, double along_mm) const {
    for (std::int32_t dx = -1; dx <= 1; ++dx)
      for (std::int32_t dy = -1; dy <= 1; ++dy) {
        const auto cell = cells_.find(key(column(p.x) + dx, column(p.y) + dy));
        if (cell == cells_.end()) continue;
        for (const Sample& sample : cell->second) {
          if (sample.run == run_ && along_mm - sample.along_mm <= 2 * reach_mm_) continue;
          if (squared_distance(sample.point, p) <= reach_mm_ * reach_mm_ &&
              !dropped_.contains(sample.run))
            return true;
        }
      }
    return false;
  }

 private:
  struct Sample {
    Point2 point;
    double along_mm;
    std::size_t run;
  };

  [[nodiscard]] std::int32_t column(double mm) const {
    return static_cast<std::int32_t>(std::floor(mm / reach_mm_));
  }
  static std::uint64_t key(std::int32_t column, std::int32_t row) {
    return std::uint64_t{static_cast<std::uint32_t>(column)} << 32U |
           static_cast<std::uint32_t>(row);
  }

  double reach_mm_;
  std::size_t run_ = 0;
  std::set<std::size_t> dropped_;
  std::unordered_map<std::uint64_t, std::vector<Sample>> cells_;
};

/// Cuts the bare runs out of one stretch after the other.
class Tracer {
 public:
  Tracer(const Hatch& hatch, double reach_mm, double min_length_mm)
      : hatch_(hatch), reach_mm_(reach_mm), min_length_mm_(min_length_mm), traces_(reach_mm) {}

  void trace(const std::vector<Point2>& path) {
    visit(path.front(), true);
    for (std::size_t i = 1; i < path.size(); ++i) {
      const double edge_mm = distance(path[i - 1], path[i]);
      const int steps = static_cast<int>(edge_mm / (reach_mm_ / 2)) + 1;
      for (int k = 1; k <= steps; ++k) {
        along_mm_ += edge_mm / steps;
        const bool is_vertex = k == steps;
        visit(
            is_vertex ? path[i] : snap(lerp(path[i - 1], path[i], static_cast<double>(k) / steps)),
            is_vertex);
      }
    }
    end_run();
  }

  std::vector<std::vector<Point2>> take() { return std::move(found_); }

 private:
  void visit(Point2 p, bool is_vertex) {
    if (hatch_.passes_near(p, reach_mm_) || traces_.near(p, along_mm_)) return end_run();
    traces_.add(p, along_mm_);
    // Of the samples on an edge only the first and the last of the run are points of it.
    if (!run_.empty() && !last_is_vertex_) run_.pop_back();
    last_is_vertex_ = is_vertex || run_.empty();
    if (run_.empty() || run_.back() != p) run_.push_back(p);
  }

  void end_run() {
    if (!run_.empty()) {
      if (run_.size() >= 2 && length_mm(run_) >= min_length_mm_)
        found_.push_back(std::move(run_));
      else
        traces_.drop_run();
      run_.clear();
    }
    traces_.begin_run();
  }

  const Hatch& hatch_;
  double reach_mm_;
  double min_length_mm_;
  Traces traces_;
  std::vector<std::vector<Point2>> found_;
  std::vector<Point2> run_;
  bool last_is_vertex_ = false;
  double along_mm_ = 0;
};

}  // namespace

std::vector<std::vector<Point2>> bare_boundary(const Hatch& hatch,
                                               std::span<const Stretch> stretches,
                                               const std::vector<Joint>& joints, double reach_mm,
                                               double min_length_mm, const PlanContext& context) {
  std::set<std::pair<std::size_t, std::size_t>> used;
  for (const Joint& joint : joints) used.emplace(joint.from_end, joint.to_end);
  Tracer tracer(hatch, reach_mm, min_length_mm);
  for (const Stretch& stretch : stretches) {
    stop_if_asked(context);
    if (!used.contains({stretch.from_end, stretch.to_end})) tracer.trace(stretch.path);
  }
  return tracer.take();
}

}  // namespace routebench
