"""Travel against planning time: what a shorter route costs."""

from __future__ import annotations

import statistics
from collections.abc import Mapping, Sequence

from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from .axis import axis_label, set_range
from .quantities import scale_for
from .results import Item, Metric, Results
from .sheet import LegendEntry, Sheet
from .style import MUTED, Look, looks
from .tally import Tally

_WIDTH = 5.2
_HEIGHT = 3.4
Points = Mapping[tuple[int, int], tuple[float, float]]
"""By model and contender."""


def draw(
    results: Results,
    setting: Item,
    x_metric: Metric,
    y_metric: Metric,
    title: str,
) -> Sheet:
    """A small marker for each cell, a large one for each median.

    A staircase joins the medians that no other beats on both metrics.
    """
    tally = Tally()
    points = _points(results, setting, x_metric, y_metric, tally)
    x_scale = scale_for(x_metric, (x for x, _ in points.values()))
    y_scale = scale_for(y_metric, (y for _, y in points.values()))
    points = {
        place: (x_scale(x), y_scale(y)) for place, (x, y) in points.items()
    }
    shared = _shared_models(results, points)
    medians = _medians(results, points, shared)
    front = pareto_front(medians, x_metric.better, y_metric.better)
    contender_looks = looks(results.contenders)
    sheet = Sheet(
        width=_WIDTH,
        body_height=_HEIGHT,
        title=title,
        notes=[
            _median_note(len(shared)),
            *_front_note(results, front),
            tally.sentence(),
        ],
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
            medians.get(contender.row_id),
            contender_looks[contender.row_id],
        )
    _draw_front(axes, [medians[row_id] for row_id in front])
    axes.grid(True)
    set_range(axes, "x", [x for x, _ in points.values()])
    set_range(axes, "y", [y for _, y in points.values()])
    axes.set_xlabel(axis_label(x_metric, x_scale, _WIDTH - 0.8))
    axes.set_ylabel(axis_label(y_metric, y_scale, _HEIGHT - 0.5))
    return sheet


def has_points(
    results: Results, setting: Item, x_metric: Metric, y_metric: Metric
) -> bool:
    """Whether any valid cell has both metrics."""
    return bool(_points(results, setting, x_metric, y_metric, Tally()))


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


def _medians(
    results: Results, points: Points, shared: Sequence[int]
) -> dict[int, tuple[float, float]]:
    """By contender, over the shared models."""
    medians = {}
    for contender in results.contenders:
        own = [
            points[model, contender.row_id]
            for model in shared
            if (model, contender.row_id) in points
        ]
        if own:
            medians[contender.row_id] = (
                statistics.median(x for x, _ in own),
                statistics.median(y for _, y in own),
            )
    return medians


def pareto_front(
    points: Mapping[int, tuple[float, float]], x_better: str, y_better: str
) -> list[int]:
    """Those that none is better than on one axis and as good on the other.

    By rising x. Empty where an axis has no better direction.
    """
    signs = {"lower": 1.0, "higher": -1.0}
    if x_better not in signs or y_better not in signs:
        return []
    costs = {
        key: (signs[x_better] * x, signs[y_better] * y)
        for key, (x, y) in points.items()
    }
    front = [
        key
        for key, (x, y) in costs.items()
        if not any(
            a <= x and b <= y and (a, b) != (x, y) for a, b in costs.values()
        )
    ]
    return sorted(front, key=lambda key: points[key])


def _front_note(results: Results, front: Sequence[int]) -> list[str]:
    if len(front) < 2:
        return []
    names = {c.row_id: c.label for c in results.contenders}
    return [
        "Dashed: the Pareto front of the medians, "
        + ", ".join(names[row_id] for row_id in front)
        + ". No contender is better than one of these on both axes."
    ]


def _draw_front(axes: Axes, front: Sequence[tuple[float, float]]) -> None:
    """What is reached with at most so much of x, so the stairs go down late."""
    if len(front) < 2:
        return
    axes.plot(
        [x for x, _ in front],
        [y for _, y in front],
        drawstyle="steps-post",
        linestyle=(0, (4, 2)),
        color=MUTED,
        linewidth=0.9,
        zorder=1,
        gid="pareto",
    )


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
    middle: tuple[float, float] | None,
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
    if middle is not None:
        median = _marker(look)
        median.set_data([middle[0]], [middle[1]])
        median.set_zorder(3)
        axes.add_line(median)
