"""What an experiment shows, on one Markdown page.

Contenders are compared model by model with one of them, the baseline: only
models on which both are valid count, so nobody gains by failing on the hard
ones, and the page says on how many models each figure rests.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from . import scaling
from .errors import PlotError
from .quantities import in_sentence
from .results import VALID, Item, Metric, Results
from .style import ABSENT, outcome_look
from .tables import markdown_row, markdown_text

COMPARED = (
    "travel_mm",
    "retractions",
    "strokes",
    "print_time_s",
    "plan_cpu_ns",
)
"""Metrics of the comparison; all of them are better when lower."""

_SHIFT = 1.0
"""Added to both sides of a ratio: nothing at all is good, not infinitely so.

One millimetre, stroke, retraction, second or nanosecond.
"""


@dataclass(frozen=True)
class Comparison:
    """One metric of a contender against the baseline."""

    ratio: float
    """Geometric mean over the shared models."""
    worse: int
    shared: int


@dataclass(frozen=True)
class Line:
    """One contender under one setting."""

    contender: str
    valid: int
    models: int
    comparisons: list[Comparison | None]
    """One a metric; None where no model is shared."""


@dataclass(frozen=True)
class Miss:
    """A cell that is not valid."""

    contender: str
    model: str
    outcome: str
    reason: str


@dataclass(frozen=True)
class Part:
    """All about one setting."""

    setting: str
    baseline: str
    metrics: list[Metric]
    lines: list[Line]
    """The least travel first; contenders that share no model last."""
    misses: list[Miss]
    growth: list[tuple[str, scaling.Fit]]
    """Contenders with the power law of their planning time, if any."""


def summary(results: Results, baseline: str | None = None) -> list[Part]:
    """Every setting's comparison.

    Without a name the baseline of a setting is the contender that is valid
    on most models, of several the first by name.
    """
    names = [contender.label for contender in results.contenders]
    if baseline is not None and baseline not in names:
        raise PlotError(
            f"{results.database}: no contender '{baseline}'; it has "
            + ", ".join(names)
        )
    return [_part(results, setting, baseline) for setting in results.settings]


def to_markdown(parts: Sequence[Part], experiment: str) -> str:
    """The parts as a page."""
    lines = [
        f"# What {markdown_text(experiment)} shows",
        "",
        "Each figure is a contender's total over that of the baseline on the "
        "same model, as the geometric mean over the models on which both are "
        "valid; below 1 is better. In brackets: on how many of these models "
        "the contender is worse.",
    ]
    for part in parts:
        lines += ["", f"## {markdown_text(part.setting or 'All models')}", ""]
        lines += _table(part)
        if part.growth:
            lines += [
                "",
                "Planning CPU time grows with the extruded length to the "
                "power of (with 95 % interval, over models):",
                "",
            ]
            lines += [
                f"- {markdown_text(name)}: {scaling.exponent_text(law)}"
                f" ({law.points} models)"
                for name, law in part.growth
            ]
        if part.misses:
            lines += ["", "Not valid:", ""]
            lines += _missed(part)
    return "\n".join(lines) + "\n"


def _part(results: Results, setting: Item, baseline: str | None) -> Part:
    metrics = [
        metric
        for name in COMPARED
        if (metric := results.metric(name)) is not None
    ]
    base = (
        max(
            results.contenders,
            key=lambda c: _valid_models(results, setting, c),
        )
        if baseline is None
        else next(c for c in results.contenders if c.label == baseline)
    )
    lines = [
        Line(
            contender=contender.label,
            valid=_valid_models(results, setting, contender),
            models=len(results.models),
            comparisons=[
                _compare(results, setting, contender, base, metric)
                for metric in metrics
            ],
        )
        for contender in results.contenders
    ]
    lines.sort(key=_least_first)
    return Part(
        setting.label,
        base.label,
        metrics,
        lines,
        _misses(results, setting),
        _growth(results, setting),
    )


def _growth(
    results: Results, setting: Item
) -> list[tuple[str, scaling.Fit]]:
    size, time = results.metric(scaling.SIZE), results.metric(scaling.TIME)
    if size is None or time is None:
        return []
    found = scaling.fits(results, setting, size, time)
    return [
        (contender.label, found[contender.row_id][1])
        for contender in results.contenders
        if contender.row_id in found
    ]


def _valid_models(results: Results, setting: Item, contender: Item) -> int:
    """Models on which all of the contender's cells are valid."""
    return sum(
        set(results.slot(setting, model, contender).outcomes) == {VALID}
        for model in results.models
    )


def _compare(
    results: Results,
    setting: Item,
    contender: Item,
    base: Item,
    metric: Metric,
) -> Comparison | None:
    logs = []
    worse = 0
    for model in results.models:
        own, other = (
            results.value(results.slot(setting, model, item), metric)
            for item in (contender, base)
        )
        if own is None or other is None:
            continue
        logs.append(
            math.log((own.median + _SHIFT) / (other.median + _SHIFT))
        )
        worse += own.median > other.median
    if not logs:
        return None
    return Comparison(math.exp(math.fsum(logs) / len(logs)), worse, len(logs))


def _least_first(line: Line) -> tuple[bool, float]:
    first = line.comparisons[0] if line.comparisons else None
    return (first is None, 0.0 if first is None else first.ratio)


def _misses(results: Results, setting: Item) -> list[Miss]:
    return [
        Miss(
            contender.label,
            model.label,
            outcome_look(cell.outcome).words,
            cell.reason,
        )
        for contender in results.contenders
        for model in results.models
        for cell in results.slot(setting, model, contender).cells
        if cell.outcome != VALID
    ]


def _missed(part: Part) -> list[str]:
    """A line for each miss, or one for a contender that is valid nowhere."""
    nowhere = {line.contender for line in part.lines if line.valid == 0}
    lines = []
    told = set()
    for miss in part.misses:
        if miss.contender in told:
            continue
        place = markdown_text(miss.model)
        if miss.contender in nowhere:
            told.add(miss.contender)
            place = f"every model, such as {place}"
        reason = f", {markdown_text(miss.reason)}" if miss.reason else ""
        lines.append(
            f"- {markdown_text(miss.contender)} on {place}: "
            f"{miss.outcome}{reason}"
        )
    return lines


def _table(part: Part) -> list[str]:
    heads = ["contender", "valid on"]
    heads += [in_sentence(metric.label) for metric in part.metrics]
    rows = [markdown_row([markdown_text(head) for head in heads])]
    rows.append(markdown_row([":--", *("--:" for _ in heads[1:])]))
    for line in part.lines:
        name = markdown_text(line.contender)
        if line.contender == part.baseline:
            name += " (baseline)"
        cells = [name, f"{line.valid} of {line.models}"]
        cells += [_comparison(c) for c in line.comparisons]
        rows.append(markdown_row(cells))
    return rows


def _comparison(made: Comparison | None) -> str:
    if made is None:
        return ABSENT
    return f"{made.ratio:.3g} ({made.worse} of {made.shared})"
