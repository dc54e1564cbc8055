"""How quantities are written: units, digits, direction."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from .results import Metric

THIN_SPACE = "\u202f"

_LADDERS: dict[str, tuple[tuple[float, str, float], ...]] = {
    "ns": ((1e3, "µs", 1e3), (1e6, "ms", 1e6), (1e9, "s", 1e9)),
    "bytes": ((2**10, "KiB", 2**10), (2**20, "MiB", 2**20)),
    "mm": ((1e5, "m", 1e3),),
    "mm3": ((1e5, "cm3", 1e3),),
}
"""From which value on a quantity is written in which larger unit, and how
many of the small ones that is."""

_DIRECTIONS = {"lower": "lower is better", "higher": "higher is better"}


@dataclass(frozen=True)
class Scale:
    """A unit to draw a metric in, and how many stored units it is."""

    unit: str
    factor: float

    def __call__(self, value: float) -> float:
        """The stored value in this unit."""
        return value / self.factor


def scale_for(metric: Metric, values: Iterable[float]) -> Scale:
    """The unit in which the largest of the values is easy to read."""
    largest = max((abs(value) for value in values), default=0.0)
    scale = Scale(metric.unit, 1.0)
    for start, unit, factor in _LADDERS.get(metric.unit, ()):
        if largest >= start:
            scale = Scale(unit, factor)
    return scale


def pretty_unit(unit: str) -> str:
    """The unit as print has it: mm3 becomes mm³."""
    return (
        unit.replace("mm2", "mm²").replace("mm3", "mm³").replace("cm3", "cm³")
    )


def with_unit(label: str, unit: str) -> str:
    """Label and unit, as an axis carries them."""
    return f"{label} [{pretty_unit(unit)}]" if unit else label


def direction(metric: Metric) -> str:
    """Which way is better, in words; empty where neither is."""
    return _DIRECTIONS.get(metric.better, "")


def format_number(value: float) -> str:
    """Four significant digits, all digits of whole numbers."""
    if value == 0:
        return "0"
    if abs(value) >= 1e9:
        digits = f"{value:.3g}"
    elif abs(value) >= 1000 or value == int(value):
        digits = f"{value:,.0f}".replace(",", THIN_SPACE)
    elif abs(value) >= 1e-4:
        places = max(0, 3 - math.floor(math.log10(abs(value))))
        digits = f"{value:.{places}f}".rstrip("0").rstrip(".")
    else:
        digits = f"{value:.3g}"
    return digits.replace("-", "\u2212")


def quantity(value: float, unit: str) -> str:
    """Number and unit, as a sentence carries them."""
    number = format_number(value)
    return f"{number} {pretty_unit(unit)}" if unit else number


def amount(value: float, metric: Metric) -> str:
    """A value in the unit in which it is easy to read."""
    scale = scale_for(metric, [value])
    return quantity(scale(value), scale.unit)


def counted(number: int, noun: str) -> str:
    """One layer, two layers."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def in_sentence(label: str) -> str:
    """A label in the middle of a sentence; CPU stays CPU."""
    if label[1:2].isupper():
        return label
    return label[:1].lower() + label[1:]
