"""Heat map: every total as a multiple of the best of its model."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.patches import Rectangle

from .comparison import SHIFT
from .matrix import draw_matrix
from .outcomes import fill_outcome, outcome_words
from .quantities import direction, format_number
from .results import Item, Metric, Results
from .sheet import LegendEntry, Sheet
from .style import ABSENT
from .tally import Tally

_STEPS = (
    (1.0, "the best", "#FFFFFF", "#000000"),
    (1.1, "up to 1.1", "#DCE9F5", "#000000"),
    (1.5, "up to 1.5", "#A9CCE8", "#000000"),
    (2.0, "up to 2", "#6CA6D6", "#000000"),
    (4.0, "up to 4", "#2F74B5", "#FFFFFF"),
    (float("inf"), "more", "#0B2F5B", "#FFFFFF"),
)
"""Ratio up to which, in words, colour, ink: one hue from light to dark, told apart in grey, too."""


def draw(
    results: Results, setting: Item, metric: Metric, models: Sequence[Item], title: str
) -> Sheet:
    """Models down, contenders across; for metrics of which less is better."""
    contenders = results.contenders
    slots = [
        [results.slot(setting, model, contender) for contender in contenders] for model in models
    ]
    values = [[results.value(slot, metric) for slot in row] for row in slots]
    tally = Tally()
    for slot_row, value_row in zip(slots, values):
        for slot, value in zip(slot_row, value_row):
            tally.add(slot, None if value else "without a value")

    def ratio(row: int, column: int) -> float | None:
        value = values[row][column]
        if value is None:
            return None
        best = min(v.median for v in values[row] if v is not None)
        return (value.median + SHIFT) / (best + SHIFT)

    def words(row: int, column: int) -> list[str]:
        found = ratio(row, column)
        if found is not None:
            return [ratio_text(found)]
        slot = slots[row][column]
        return [ABSENT] if slot.valid else outcome_words(slot)

    def fill(axes: Axes, place: Rectangle, row: int, column: int) -> str:
        found = ratio(row, column)
        if found is None:
            return fill_outcome(axes, place, slots[row][column])
        _, _, colour, ink = next(step for step in _STEPS if found <= step[0])
        # White on white would have no edge.
        place.set(facecolor=colour, edgecolor="#DDDDDD", linewidth=0.5)
        axes.add_patch(place)
        return ink

    return draw_matrix(
        models,
        contenders,
        words,
        fill,
        title,
        [
            f"{metric.label} ({direction(metric)}) as a multiple of the least among the valid "
            "cells of the same model; cells that are not valid name their outcome.",
            tally.sentence(),
        ],
        [
            LegendEntry(Rectangle((0, 0), 1, 1, facecolor=colour, edgecolor="#999999"), label)
            for _, label, colour, _ in _STEPS
        ],
    )


def ratio_text(ratio: float) -> str:
    """Three digits; never 1 for what is not the best."""
    if ratio == 1:
        return "1"
    if ratio < 1.005:
        return "> 1"
    return format_number(round(ratio, 2)) if ratio < 100 else format_number(round(ratio))
