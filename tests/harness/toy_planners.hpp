#pragma once
/// Planners whose routes tell what they were asked, for tests of what goes on around planners.

#include <memory>
#include <stdexcept>

#include "routebench/geometry/error.hpp"
#include "routebench/planning/registry.hpp"

namespace routebench::test {

/// Walls: each outer ring once, from its first corner.
class OnceRound : public Planner {
 public:
  struct Params {
    void bind(ParamBinder&) {}
  };
  static PlannerInfo info() { return {"once_round", PlannerRole::kShell, "each outer ring", ""}; }
  explicit OnceRound(const Params&) {}
  [[nodiscard]] Route plan(const Layer& layer, const PlanContext& context) const override {
    Route route;
    for (const Polygon& polygon : layer.polygons) {
      Stroke stroke{polygon.outer, context.line_width_mm};
      stroke.points.push_back(stroke.points.front());
      route.strokes.push_back(std::move(stroke));
    }
    return route;
  }
};

/// Fill: from where the nozzle is to the first corner of each polygon, as wide as the density asked
/// for; `lift` is added to y so that a parameter shows.
class Leash : public Planner {
 public:
  struct Params {
    double lift_mm = 0;
    void bind(ParamBinder& bind) { bind("lift_mm", lift_mm, {-10, 10}, "mm", "added to y"); }
  };
  static PlannerInfo info() { return {"leash", PlannerRole::kFill, "nozzle to corners", "nobody"}; }
  explicit Leash(const Params& params) : params_(params) {}
  [[nodiscard]] Route plan(const Layer& layer, const PlanContext& context) const override {
    Route route;
    Point2 at = context.start;
    for (const Polygon& polygon : layer.polygons) {
      const Point2 to{polygon.outer.front().x, polygon.outer.front().y + params_.lift_mm};
      route.strokes.push_back({{at, to}, context.density});
      at = to;
    }
    return route;
  }

 private:
  Params params_;
};

/// Fill: one stroke whose end tells the seed (its low 19 bits).
class SeedTeller : public Planner {
 public:
  struct Params {
    void bind(ParamBinder&) {}
  };
  static PlannerInfo info() { return {"seed_teller", PlannerRole::kFill, "tells its seed", ""}; }
  explicit SeedTeller(const Params&) {}
  [[nodiscard]] Route plan(const Layer&, const PlanContext& context) const override {
    const auto told = static_cast<double>(context.seed & 0x7FFFF);
    return {{{{{0, 0}, {told, 1}}, context.line_width_mm}}};
  }
};

/// Fill: does one thing wrong.
class Wrongdoer : public Planner {
 public:
  enum class Wrong {
    kOnePoint,
    kNotFinite,
    kFarAway,
    kNoWidth,
    kError,
    kException,
    kNumber,
    kStop
  };
  struct Params {
    Wrong wrong = Wrong::kOnePoint;
    void bind(ParamBinder& bind) {
      bind("wrong", wrong,
           {{"one_point", Wrong::kOnePoint},
            {"not_finite", Wrong::kNotFinite},
            {"far_away", Wrong::kFarAway},
            {"no_width", Wrong::kNoWidth},
            {"error", Wrong::kError},
            {"exception", Wrong::kException},
            {"number", Wrong::kNumber},
            {"stop", Wrong::kStop}},
           "what to do wrong");
    }
  };
  static PlannerInfo info() { return {"wrongdoer", PlannerRole::kFill, "does wrong", ""}; }
  explicit Wrongdoer(const Params& params) : params_(params) {}
  [[nodiscard]] Route plan(const Layer&, const PlanContext&) const override {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    switch (params_.wrong) {
      case Wrong::kOnePoint:
        return {{{{{0, 0}}, 0.4}}};
      case Wrong::kNotFinite:
        return {{{{{0, 0}, {1, nan}}, 0.4}}};
      case Wrong::kFarAway:
        return {{{{{0, 0}, {1e300, 0}}, 0.4}}};
      case Wrong::kNoWidth:
        return {{{{{0, 0}, {1, 0}}, 0.4}, {{{0, 0}, {1, 0}}, nan}}};
      case Wrong::kError:
        throw Error(ErrorKind::kInternal, "lost my way");
      case Wrong::kException:
        throw std::out_of_range("lost my list");
      case Wrong::kNumber:
        throw 42;
      case Wrong::kStop:
        throw Error(ErrorKind::kStopped, "stopped as asked");
    }
    return {};
  }

 private:
  Params params_;
};

inline Registry toy_registry() {
  Registry registry;
  registry.add<OnceRound>();
  registry.add<Leash>();
  registry.add<SeedTeller>();
  registry.add<Wrongdoer>();
  return registry;
}

}  // namespace routebench::test
