"""What the axes of all figures have in common: names and numbers."""

from __future__ import annotations

from matplotlib.axis import Axis
from matplotlib.ticker import FuncFormatter, MaxNLocator

from .quantities import Scale, direction, format_number, with_unit
from .results import Metric
from .style import TEXT_SIZE
from .text import text_width, wrapped


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
