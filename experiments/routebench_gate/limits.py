"""How much worse is a regression."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from routebench_plots.errors import PlotError
from routebench_plots.naming import nearest
from routebench_plots.results import Metric, Results

DEFAULT_TOLERANCE = 0.005
DEFAULT_TIME = 0.5
DEFAULT_METRICS = (
    "travel_mm",
    "retractions",
    "crossings",
    "strokes",
    "covered",
    "doubled",
    "print_time_s",
    "plan_cpu_ns",
)

_NOISY_UNITS = ("ns", "bytes")
_SHARES = ("area", "outline", "demand")
"""Totals of metrics that are shares of something."""


@dataclass(frozen=True)
class Limits:
    """By how much a metric may become worse.

    Relative to the old value; for shares of an area or outline the difference of the shares, for
    0.2 % instead of 0.1 % of a layer is not twice as bad a layer.
    """

    tolerance: float = DEFAULT_TOLERANCE
    time: float = DEFAULT_TIME
    """Of metrics with noise, in the median over the cells."""
    own: dict[str, float] = field(default_factory=dict)
    """Of single metrics, by name."""

    def of(self, metric: Metric) -> float:
        """The limit of a metric."""
        return self.own.get(metric.name, self.time if is_noisy(metric) else self.tolerance)


def is_noisy(metric: Metric) -> bool:
    """Whether equal programs measure different values: times, memory, and all of a process."""
    return metric.unit in _NOISY_UNITS or metric.total == "cell"


def is_share(metric: Metric) -> bool:
    """Whether values are compared by their difference."""
    return metric.total in _SHARES


def parse_share(text: str, option: str) -> float:
    """0.01 or 1%, not negative."""
    number = text.removesuffix("%").strip()
    try:
        value = float(number) / (100 if text.endswith("%") else 1)
    except ValueError:
        value = math.nan
    if not (math.isfinite(value) and value >= 0):
        raise PlotError(f"{option} {text}: give a share such as 0.01 or 1%")
    return value


def metrics_of(old: Results, new: Results, names: list[str] | None) -> list[Metric]:
    """The metrics to compare; without names, the usual ones that both results have."""
    shared = [m for m in new.metrics if old.metric(m.name) is not None]
    directed = [m for m in shared if m.better in ("lower", "higher")]
    if names is None:
        return [m for m in directed if m.name in DEFAULT_METRICS]
    if names == ["all"]:
        return directed
    chosen = []
    for name in names:
        metric = next((m for m in shared if m.name == name), None)
        if metric is None:
            raise PlotError(
                f"no metric '{name}' in both results{nearest(name, [m.name for m in shared])}"
            )
        if metric not in directed:
            raise PlotError(f"--metrics {name}: neither more nor less of it is better")
        chosen.append(metric)
    return chosen
