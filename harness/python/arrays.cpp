#include "arrays.hpp"

#include <cmath>
#include <memory>
#include <utility>

#include "routebench/geometry/error.hpp"
#include "routebench/geometry/grid.hpp"

namespace routebench::python {

namespace py = pybind11;

namespace {

/// On its grid coordinates are exact up to here, and no printer reaches further.
constexpr double kFarthestMm = 1e6;

std::vector<Point2> points_of(const py::handle& given, const std::string& what) {
  const auto array = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(given);
  if (!array) PyErr_Clear();
  if (!array || array.ndim() != 2 || array.shape(1) != 2)
    throw Error(ErrorKind::kBadInput, what + " is no array of points, shape (n, 2)");
  std::vector<Point2> points;
  points.reserve(static_cast<std::size_t>(array.shape(0)));
  for (py::ssize_t i = 0; i < array.shape(0); ++i) {
    const Point2 p{array.at(i, 0), array.at(i, 1)};
    if (!(std::abs(p.x) <= kFarthestMm && std::abs(p.y) <= kFarthestMm))
      throw Error(ErrorKind::kBadInput, what + " has point " + std::to_string(i) + " at (" +
                                            std::to_string(p.x) + ", " + std::to_string(p.y) +
                                            "); coordinates must be finite and within a kilometre");
    points.push_back(snap(p));
  }
  return points;
}

py::object planner_module() { return py::module_::import("routebench.planner"); }

}  // namespace

py::tuple tuple_of(const Polygons& polygons, const py::handle& owner) {
  const py::object make = planner_module().attr("Polygon");
  py::tuple all(polygons.size());
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    py::tuple holes(polygons[i].holes.size());
    for (std::size_t k = 0; k < holes.size(); ++k)
      holes[k] = view_of<double>(polygons[i].holes[k], owner);
    all[i] = make(view_of<double>(polygons[i].outer, owner), holes);
  }
  return all;
}

py::tuple tuple_of(Polygons&& polygons) {
  auto held = std::make_unique<Polygons>(std::move(polygons));
  const Polygons& view = *held;
  const py::capsule owner(held.release(), [](void* p) { delete static_cast<Polygons*>(p); });
  return tuple_of(view, owner);
}

Polygons polygons_of(const py::iterable& polygons) {
  Polygons all;
  for (const py::handle polygon : polygons) {
    const std::string what = "polygon " + std::to_string(all.size());
    if (!py::hasattr(polygon, "outer") || !py::hasattr(polygon, "holes"))
      throw Error(ErrorKind::kBadInput, what + " has no rings `outer` and `holes`");
    Polygon one;
    one.outer = points_of(polygon.attr("outer"), what);
    for (const py::handle hole : polygon.attr("holes"))
      one.holes.push_back(
          points_of(hole, "hole " + std::to_string(one.holes.size()) + " of " + what));
    all.push_back(std::move(one));
  }
  return all;
}

std::vector<Stroke> strokes_of(const py::iterable& strokes, double width_mm) {
  std::vector<Stroke> all;
  for (const py::handle given : strokes) {
    const std::string what = "stroke " + std::to_string(all.size());
    Stroke stroke{{}, width_mm};
    if (py::hasattr(given, "points")) {
      stroke.points = points_of(given.attr("points"), what);
      const py::object width = given.attr("width_mm");
      if (!width.is_none()) stroke.width_mm = width.cast<double>();
    } else {
      stroke.points = points_of(given, what);
    }
    if (stroke.points.size() < 2)
      throw Error(ErrorKind::kBadInput, what + " has " + std::to_string(stroke.points.size()) +
                                            " points; it needs two or more");
    all.push_back(std::move(stroke));
  }
  return all;
}

ParamSet params_of(const py::dict& values) {
  ParamSet params;
  for (const auto& [key, value] : values) {
    const std::string name = py::str(key);
    if (py::isinstance<py::bool_>(value))
      params[name] = value.cast<bool>();
    else if (py::isinstance<py::int_>(value))
      params[name] = value.cast<std::int64_t>();
    else if (py::isinstance<py::float_>(value))
      params[name] = value.cast<double>();
    else if (py::isinstance<py::str>(value))
      params[name] = value.cast<std::string>();
    else
      throw Error(ErrorKind::kBadInput,
                  "parameter " + name + " is a " +
                      std::string(py::str(py::type::of(value).attr("__name__"))) +
                      "; it must be a number, a truth or a word");
  }
  return params;
}

std::string setting_text(const std::string& key, const py::handle& value) {
  if (py::isinstance<py::tuple>(value) || py::isinstance<py::list>(value)) {
    std::string text;
    for (const py::handle one : value) text += (text.empty() ? "" : ",") + setting_text(key, one);
    return text;
  }
  const ParamSet one = params_of(py::dict(py::arg(key.c_str()) = value));
  return to_string(one.at(key));
}

}  // namespace routebench::python
