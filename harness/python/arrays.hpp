#pragma once
/// Between our data and Python's: arrays that look into what C++ holds, and what comes back.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "routebench/geometry/types.hpp"
#include "routebench/planning/params.hpp"
#include "routebench/planning/planner.hpp"

namespace routebench::python {

/// Rows of numbers that belong to `owner`, which they keep alive; they cannot be written to.
/// Nothing is copied.
template <typename Number, typename Row>
pybind11::array view_of(const std::vector<Row>& rows, const pybind11::handle& owner) {
  constexpr std::size_t kColumns = sizeof(Row) / sizeof(Number);
  static_assert(sizeof(Row) == kColumns * sizeof(Number));
  pybind11::array_t<Number> array({rows.size(), kColumns},
                                  reinterpret_cast<const Number*>(rows.data()), owner);
  array.attr("setflags")(pybind11::arg("write") = false);
  return array;
}

/// Polygons as a tuple of routebench.planner.Polygon whose rings look into `owner`.
[[nodiscard]] pybind11::tuple tuple_of(const Polygons& polygons, const pybind11::handle& owner);

/// The same for polygons that nobody else holds.
[[nodiscard]] pybind11::tuple tuple_of(Polygons&& polygons);

/// From anything with `outer` and `holes`. Throws Error{kBadInput} naming the polygon that is none.
/// Coordinates are put on the grid.
[[nodiscard]] Polygons polygons_of(const pybind11::iterable& polygons);

/// From arrays and routebench.planner.Stroke; `width_mm` is for those without a width.
[[nodiscard]] std::vector<Stroke> strokes_of(const pybind11::iterable& strokes, double width_mm);

/// From a dict of numbers, truths and words. Throws Error{kBadInput} naming a value that is none.
[[nodiscard]] ParamSet params_of(const pybind11::dict& values);

/// A setting as a config would have it: true, 0.2, 3, slope, "1,2" for a pair.
[[nodiscard]] std::string setting_text(const std::string& key, const pybind11::handle& value);

}  // namespace routebench::python
