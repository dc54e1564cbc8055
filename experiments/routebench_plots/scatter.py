"""Travel against planning time: what a shorter route costs."""

from __future__ import annotations

import math
import statistics
from collections.abc import Mapping, Sequence

from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, NullLocator, SymmetricalLogLocator

from .axis import axis_label, format_ticks, number_ticks
from .quantities import scale_for
from .results import Item, Metric, Results
from .sheet import LegendEntry, Sheet
from .style import Look, looks
from .tally import Tally

_WIDTH = 5.2
_HEIGHT = 3.4
_LOG_FROM = 20.0
"""Largest over smallest value from which on an axis is logarithmic."""
_MANY_DECADES = 2.5
"""From here on, an axis has numbers at the powers of ten alone."""

Points = Mapping[tuple[int, int], tuple[float, float]]
"""By model and contender."""


def draw(
    results: Results,
    setting: Item,
    x_metric: Metric,
    y_metric: Metric,
    title: str,
) -> Sheet:
    """A small marker for each cell, a large one for each median."""
    tally = Tally()
    points = _points(results, setting, x_metric, y_metric, tally)
    x_scale = scale_for(x_metric, (x for x, _ in points.values()))
    y_scale = scale_for(y_metric, (y for _, y in points.values()))
    points = {
        place: (x_scale(x), y_scale(y)) for place, (x, y) in points.items()
    }
    shared = _shared_models(results, points)
    contender_looks = looks(results.contenders)
    sheet = Sheet(
        width=_WIDTH,
        body_height=_HEIGHT,
        title=title,
        notes=[_median_note(len(shared)), tally.sentence()],
        legend=[
            LegendEntry(_marker(contender_looks[c.row_id]), c.label)
            for c in results.contenders
            if any(c.row_id == contender for _, contender in points)
        ],
    )
    axes = sheet.panels(1, 1)[0][0]
    for contender in results.contenders:
        own = {
            model.row_id: points[model.row_id, contender.row_id]
            for model in results.models
            if (model.row_id, contender.row_id) in points
        }
        _draw_contender(
            axes,
            list(own.values()),
            [own[model] for model in shared if model in own],
            contender_looks[contender.row_id],
        )
    axes.grid(True)
    _set_axis(axes, "x", [x for x, _ in points.values()])
    _set_axis(axes, "y", [y for _, y in points.values()])
    axes.set_xlabel(axis_label(x_metric, x_scale, _WIDTH - 0.8))
    axes.set_ylabel(axis_label(y_metric, y_scale, _HEIGHT - 0.5))
    return sheet


def _points(
    results: Results,
    setting: Item,
    x_metric: Metric,
    y_metric: Metric,
    tally: Tally,
) -> Points:
    points = {}
    for model in results.models:
        for contender in results.contenders:
            slot = results.slot(setting, model, contender)
            x = results.value(slot, x_metric)
            y = results.value(slot, y_metric)
            if x is None or y is None:
                tally.add(slot, "without a value")
                continue
            tally.add(slot)
            points[model.row_id, contender.row_id] = (x.median, y.median)
    return points


def _shared_models(results: Results, points: Points) -> list[int]:
    """Models on which every contender that has any point has one.

    A median over other models would favour whoever fails on the large ones.
    """
    present = {contender for _, contender in points}
    return [
        model.row_id
        for model in results.models
        if present
        and all((model.row_id, contender) in points for contender in present)
    ]


def _median_note(shared: int) -> str:
    note = "A small marker is one model"
    if shared:
        note += (
            ", a large one the contender's median over the models that all "
            f"contenders shown here share ({shared})"
        )
    else:
        note += "; no model is shared by all contenders, so no medians"
    return note + ". Several seeds of a cell count as one, by their median."


def _marker(look: Look) -> Line2D:
    return Line2D(
        [],
        [],
        linestyle="none",
        marker=look.marker,
        markersize=7,
        markerfacecolor=look.colour,
        markeredgecolor="black",
        markeredgewidth=0.8,
    )


def _draw_contender(
    axes: Axes,
    points: Sequence[tuple[float, float]],
    shared: Sequence[tuple[float, float]],
    look: Look,
) -> None:
    if not points:
        return
    axes.plot(
        [x for x, _ in points],
        [y for _, y in points],
        linestyle="none",
        marker=look.marker,
        markersize=4,
        markerfacecolor=look.colour,
        markeredgecolor="white",
        markeredgewidth=0.4,
        alpha=0.75,
        zorder=2,
    )
    if shared:
        median = _marker(look)
        median.set_data(
            [statistics.median(x for x, _ in shared)],
            [statistics.median(y for _, y in shared)],
        )
        median.set_zorder(3)
        axes.add_line(median)


def _set_axis(axes: Axes, name: str, values: Sequence[float]) -> None:
    """Linear from zero, or logarithmic where values differ by much.

    Zeros, which a logarithm has no place for, get a linear stretch of
    their own below the smallest positive value.
    """
    axis = axes.xaxis if name == "x" else axes.yaxis
    set_scale = axes.set_xscale if name == "x" else axes.set_yscale
    set_limits = axes.set_xlim if name == "x" else axes.set_ylim
    positive = [value for value in values if value > 0]
    high = max(values, default=0.0)
    if not positive or high / min(positive) < _LOG_FROM:
        low = min(0.0, min(values, default=0.0))
        span = (high - low) or 1.0
        set_limits(low - 0.04 * span, high + 0.06 * span)
        number_ticks(axis, most=6)
    else:
        low = min(positive)
        decades = math.log10(high / low)
        subs = (1.0,) if decades > _MANY_DECADES else (1.0, 2.0, 5.0)
        if min(values) > 0:
            set_scale("log")
            set_limits(low / 1.6, high * 1.6)
            axis.set_major_locator(LogLocator(subs=subs))
        else:
            threshold = 10.0 ** math.floor(math.log10(low))
            set_scale("symlog", linthresh=threshold, linscale=0.5)
            set_limits(-0.4 * threshold, high * 1.6)
            axis.set_major_locator(
                SymmetricalLogLocator(base=10, linthresh=threshold, subs=subs)
            )
        axis.set_minor_locator(NullLocator())
        format_ticks(axis)
