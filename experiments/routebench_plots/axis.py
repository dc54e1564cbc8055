"""What the axes of all figures have in common: names and numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.ticker import (
    FixedLocator,
    FuncFormatter,
    LogLocator,
    MaxNLocator,
    NullLocator,
    SymmetricalLogLocator,
)

from .quantities import Scale, direction, format_number, with_unit
from .results import Metric
from .style import TEXT_SIZE
from .text import text_width, wrapped

_LOG_FROM = 20.0
"""Largest over smallest value from which on an axis is logarithmic."""
_MANY_DECADES = 2.5
"""From here on, an axis has numbers at the powers of ten alone."""


def axis_label(
    metric: Metric, scale: Scale, length: float, suffix: str = ""
) -> str:
    """Label, unit and direction, broken to fit an axis of that length."""
    label = with_unit(f"{metric.label}{suffix}", scale.unit)
    words = direction(metric)
    if not words:
        return wrapped(label, length, TEXT_SIZE)
    line = f"{label} ({words})"
    if text_width(line, TEXT_SIZE) <= length:
        return line
    return f"{wrapped(label, length, TEXT_SIZE)}\n({words})"


def number_ticks(axis: Axis, most: int) -> None:
    """At most so many round numbers along a linear axis."""
    axis.set_major_locator(MaxNLocator(nbins=most, steps=[1, 2, 5, 10]))
    format_ticks(axis)


def format_ticks(axis: Axis) -> None:
    """Numbers as the rest of a figure has them."""
    axis.set_major_formatter(
        FuncFormatter(lambda value, _: format_number(value))
    )


def set_range(
    axes: Axes, name: str, values: Sequence[float], log_from: float = _LOG_FROM
) -> None:
    """Linear from zero, or logarithmic where values differ by much.

    Zeros, which a logarithm has no place for, get a linear stretch of
    their own below the smallest positive value.
    """
    axis = axes.xaxis if name == "x" else axes.yaxis
    set_scale = axes.set_xscale if name == "x" else axes.set_yscale
    set_limits = axes.set_xlim if name == "x" else axes.set_ylim
    positive = [value for value in values if value > 0]
    high = max(values, default=0.0)
    if not positive or high / min(positive) < log_from:
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


def ratio_ticks(axes: Axes, low: float, high: float) -> None:
    """At most five round numbers that do not run into each other."""
    if high / low < 4:
        axes.xaxis.set_major_locator(MaxNLocator(nbins=4, steps=[1, 2, 5, 10]))
    else:
        decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
        round_ones = [s * 10.0**d for d in decades for s in (1.0, 2.0, 5.0)]
        ticks = [tick for tick in round_ones if low <= tick <= high]
        if len(ticks) > 5:
            tens = [t for t in ticks if math.isclose(math.log10(t), round(math.log10(t)))]
            ticks = tens[:: -(-len(tens) // 5)] if len(tens) > 1 else ticks[::2]
        axes.xaxis.set_major_locator(FixedLocator(ticks))
    axes.xaxis.set_minor_locator(NullLocator())
    format_ticks(axes.xaxis)
