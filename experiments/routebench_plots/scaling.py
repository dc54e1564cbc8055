"""How planning time grows with the size of what is planned."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, NullLocator

from .axis import axis_label, format_ticks
from .distributions import student_quantile
from .inference import CONFIDENCE
from .quantities import Scale, scale_for
from .results import Item, Metric, Results
from .sheet import LegendEntry, Sheet
from .style import Look, looks
from .tally import Tally

SIZE = "extrude_mm"
TIME = "plan_cpu_ns"
FEWEST_MODELS = 4
LEAST_RANGE = 10.0
"""Largest over smallest size below which an exponent says nothing."""

WIDTH = 5.2
HEIGHT = 3.4


@dataclass(frozen=True)
class Fit:
    """time = factor * size ** exponent, by least squares of logarithms."""

    exponent: float
    half_width: float
    """Of the exponent's 95 % interval; NaN for two points."""
    factor: float
    points: int


def fit(points: Sequence[tuple[float, float]]) -> Fit | None:
    """The power law through positive points; None if they have one size."""
    logs = [(math.log(x), math.log(y)) for x, y in points if x > 0 and y > 0]
    n = len(logs)
    if n < 2:
        return None
    mean_x = math.fsum(x for x, _ in logs) / n
    mean_y = math.fsum(y for _, y in logs) / n
    spread = math.fsum((x - mean_x) ** 2 for x, _ in logs)
    if spread <= 0:
        return None
    slope = math.fsum((x - mean_x) * (y - mean_y) for x, y in logs) / spread
    base = mean_y - slope * mean_x
    errors = math.fsum((y - base - slope * x) ** 2 for x, y in logs)
    half = math.nan
    if n > 2:
        freedom = n - 2
        quantile = student_quantile((1 + CONFIDENCE) / 2, freedom)
        half = quantile * math.sqrt(errors / freedom / spread)
    return Fit(slope, half, math.exp(base), n)


def fits(
    results: Results, setting: Item, size: Metric, time: Metric
) -> dict[int, tuple[list[tuple[float, float]], Fit]]:
    """Points and fit of every contender that was given a range of sizes."""
    found = {}
    for contender in results.contenders:
        points = []
        for model in results.models:
            slot = results.slot(setting, model, contender)
            x, y = results.value(slot, size), results.value(slot, time)
            if x is not None and y is not None:
                points.append((x.median, y.median))
        sizes = [x for x, y in points if x > 0 and y > 0]
        if (
            len(sizes) < FEWEST_MODELS
            or max(sizes) < LEAST_RANGE * min(sizes)
        ):
            continue
        law = fit(points)
        if law is not None:
            found[contender.row_id] = (sorted(points), law)
    return found


def draw(
    results: Results, setting: Item, size: Metric, time: Metric, title: str
) -> Sheet:
    """Markers, and the power law of each contender."""
    found = fits(results, setting, size, time)
    all_points = [p for points, _ in found.values() for p in points]
    x_scale = scale_for(size, (x for x, _ in all_points))
    y_scale = scale_for(time, (y for _, y in all_points))
    contender_looks = looks(results.contenders)
    tally = Tally()
    for contender in results.contenders:
        for model in results.models:
            slot = results.slot(setting, model, contender)
            tally.add(
                slot, None if contender.row_id in found else "of too few sizes"
            )
    sheet = Sheet(
        width=WIDTH,
        body_height=HEIGHT,
        title=title,
        notes=[
            "Lines are power laws by least squares of the logarithms; the "
            "exponents' 95 % intervals take the models as a sample.",
            tally.sentence(),
        ],
        legend=[
            LegendEntry(
                marker_handle(contender_looks[contender.row_id]),
                f"{contender.label}: {exponent_text(law)}",
            )
            for contender in results.contenders
            if contender.row_id in found
            for law in [found[contender.row_id][1]]
        ],
    )
    axes = sheet.panels(1, 1)[0][0]
    for contender in results.contenders:
        if contender.row_id in found:
            points, law = found[contender.row_id]
            look = contender_looks[contender.row_id]
            draw_law(axes, points, law, look, x_scale, y_scale)
    set_up_axes(axes, size, x_scale, time, y_scale)
    return sheet


def set_up_axes(
    axes: Axes, size: Metric, x_scale: Scale, time: Metric, y_scale: Scale
) -> None:
    """Logarithmic axes of size and time with their labels."""
    axes.grid(True)
    for axis, set_scale in (
        (axes.xaxis, axes.set_xscale),
        (axes.yaxis, axes.set_yscale),
    ):
        set_scale("log")
        axis.set_major_locator(LogLocator(subs=(1.0,)))
        axis.set_minor_locator(NullLocator())
        format_ticks(axis)
    axes.set_xlabel(axis_label(size, x_scale, WIDTH - 0.8))
    axes.set_ylabel(axis_label(time, y_scale, HEIGHT - 0.5))


def exponent_text(law: Fit) -> str:
    """The exponent with its interval."""
    if math.isnan(law.half_width):
        return f"exponent {law.exponent:.2f}"
    return f"exponent {law.exponent:.2f} ± {law.half_width:.2f}"


def marker_handle(look: Look) -> Line2D:
    """A contender's marker, for a legend."""
    return Line2D(
        [],
        [],
        color=look.colour,
        marker=look.marker,
        markersize=5,
        markerfacecolor=look.colour,
        markeredgecolor="white",
        markeredgewidth=0.4,
    )


def draw_law(
    axes: Axes,
    points: Sequence[tuple[float, float]],
    law: Fit,
    look: Look,
    x_scale: Scale,
    y_scale: Scale,
) -> None:
    """A contender's points, and its law between the outermost of them."""
    axes.plot(
        [x_scale(x) for x, _ in points],
        [y_scale(y) for _, y in points],
        linestyle="none",
        marker=look.marker,
        markersize=5,
        markerfacecolor=look.colour,
        markeredgecolor="white",
        markeredgewidth=0.4,
        zorder=3,
    )
    ends = [points[0][0], points[-1][0]]
    axes.plot(
        [x_scale(x) for x in ends],
        [y_scale(law.factor * x**law.exponent) for x in ends],
        color=look.colour,
        linewidth=1,
        zorder=2,
    )
