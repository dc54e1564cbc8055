"""routebench for Python: slice models, plan routes with any planner, judge them, read results.

>>> import routebench
>>> model = routebench.slice_model("shape:gear", density=0.3)
>>> plan = routebench.plan(model, shell="greedy_shell", fill="rectilinear")
>>> score = routebench.score(plan)
>>> score.outcome, score.totals["travel_mm"]

Lengths are millimetres. Arrays look into what the library holds and cannot be written to; copy one
to change it. Errors are ``routebench.Error`` with the one line that the program would print.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from . import planner
from .results import read_results

try:
    from ._routebench import (
        Error,
        Mesh,
        Plan,
        SlicedModel,
        __version__,
        _metrics_json,
        _planners_json,
        load_mesh,
        nearest_first,
        offset,
        plan,
        slice_model,
    )
except ImportError as _error:
    # Planners and results do not need it: the library may be built for another Python.
    _unloadable = str(_error)

    def __getattr__(name: str) -> Any:
        if name in __all__:
            raise ImportError(
                f"routebench.{name} needs the compiled part of routebench, which cannot be loaded "
                f"here: {_unloadable}"
            )
        raise AttributeError(f"module 'routebench' has no attribute '{name}'")


__all__ = [
    "Error",
    "Mesh",
    "Plan",
    "Score",
    "SlicedModel",
    "__version__",
    "load_mesh",
    "mesh_report",
    "metrics",
    "nearest_first",
    "offset",
    "plan",
    "planner",
    "planners",
    "read_results",
    "score",
    "slice_model",
    "task_of",
]


@dataclass(frozen=True)
class Score:
    """What the judge says of a plan."""

    outcome: str
    """"valid", or "off_task" if it does not do the task."""
    reason: str
    """Every limit that is missed, with the figure; empty if valid."""
    totals: dict[str, float | None]
    """Metrics of the whole; None where one does not apply."""
    per_layer: list[dict[str, Any]] = field(repr=False)
    """Metrics of each layer, with ``layer`` (its index), ``z_mm`` and ``repaired``."""


def score(plan: Plan, *, jobs: int = 1, **printer: Any) -> Score:
    """Judges a plan. Further arguments are keys of the printer, such as retract_over_mm=1."""
    document = json.loads(plan._score_json(jobs, **printer))
    return Score(
        document["outcome"], document["reason"], document["totals"], document["per_layer"]
    )


def planners(plugins: Sequence[str] = ()) -> dict[str, dict[str, Any]]:
    """The planners that there are, by name: role, summary, source, origin and parameters."""
    document = json.loads(_planners_json([str(plugin) for plugin in plugins]))
    return {planner["name"]: planner for planner in document["planners"]}


def metrics() -> dict[str, dict[str, str]]:
    """What is measured, by name: label, unit, which direction is better, and the meaning."""
    return {metric["name"]: metric for metric in json.loads(_metrics_json())}


def mesh_report(mesh: Mesh) -> dict[str, Any]:
    """What was found in a mesh: triangles, bounds, open edges and the like."""
    return json.loads(mesh._report_json())


def task_of(model: SlicedModel) -> dict[str, Any]:
    """Every key of the task that a model was sliced for, with its value."""
    return json.loads(model._task_json())
