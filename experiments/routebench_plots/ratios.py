"""Bars with intervals: every contender against a baseline, over all models."""

from __future__ import annotations

import math
from collections.abc import Sequence

from matplotlib.axes import Axes

from .axis import ratio_ticks
from .comparison import Comparison, Comparisons
from .quantities import direction
from .results import Item, Metric, Results
from .sheet import MARGIN, Sheet, even_columns
from .style import PAGE_WIDTH, SMALL_SIZE, TEXT_SIZE, Look, looks
from .tally import Tally
from .text import POINTS_PER_INCH, text_height, text_width, wrap, wrapped

_LABEL_WIDTH = 1.9
_MOST_COLUMNS = 3
_LEAST_PANEL = 1.7
_PITCH = 0.24
_BAR = 0.62
_AROUND_PANEL = 0.75
"""Title, numbers and name of the axis."""
_BESIDE_PANEL = 0.2


def draw(
    results: Results,
    setting: Item,
    metrics: Sequence[Metric],
    baseline: Item,
    title: str,
) -> Sheet:
    """A panel for each metric: medians of the ratios, their intervals, and a dot for each model."""
    contenders = results.contenders
    names = [wrap(c.label, _LABEL_WIDTH, TEXT_SIZE) for c in contenders]
    label_width = max(text_width(line, TEXT_SIZE) for lines in names for line in lines)
    room = PAGE_WIDTH - 2 * MARGIN - label_width
    columns = even_columns(len(metrics), min(_MOST_COLUMNS, max(1, int(room / _LEAST_PANEL))))
    rows = -(-len(metrics) // columns)
    panel_width = room / columns
    mark = _mark(baseline, panel_width)
    pitch = max(
        _PITCH,
        text_height(max(map(len, names)), TEXT_SIZE) + 0.05,
        text_height(len(mark), SMALL_SIZE) + 0.08,
    )
    compared = [Comparisons(results, setting, metric) for metric in metrics]
    sheet = Sheet(
        width=PAGE_WIDTH,
        body_height=rows * (pitch * len(contenders) + _AROUND_PANEL),
        title=title,
        notes=_notes(results, setting, compared, baseline),
    )
    for axes, pairs in zip(sheet.row_by_row(len(metrics), columns), compared):
        _draw_panel(axes, contenders, pairs, baseline, panel_width)
        axes.set_yticks(range(len(contenders)), ["\n".join(lines) for lines in names])
    return sheet


def _draw_panel(
    axes: Axes,
    contenders: Sequence[Item],
    pairs: Comparisons,
    baseline: Item,
    width: float,
) -> None:
    contender_looks = looks(contenders)
    everything = [1.0]
    for place, contender in enumerate(contenders):
        made = pairs.compare(contender, baseline)
        if made is None:
            _write(axes, place, "no shared model")
        if made is None or contender == baseline:
            continue
        ratios = pairs.ratios(contender, baseline)
        everything += [*ratios, made.interval.low, made.interval.high]
        _draw_bar(axes, place, made, ratios, contender_looks[contender.row_id])
    axes.set_xscale("log")
    low, high = min(everything), max(everything)
    room = max(0.05 * math.log(high / low), 0.02)
    low, high = low * math.exp(-room), high * math.exp(room)
    axes.set_xlim(low, high)
    ratio_ticks(axes, low, high)
    axes.axvline(1, color="black", linewidth=0.8, zorder=1)
    _name_line(axes, contenders.index(baseline), _mark(baseline, width), width)
    axes.set_ylim(len(contenders) - 0.5, -0.5)
    axes.grid(axis="x")
    axes.tick_params(axis="y", length=0, labelsize=TEXT_SIZE)
    axes.set_title(wrapped(pairs.metric.label, width - _BESIDE_PANEL, TEXT_SIZE))
    axes.set_xlabel(
        wrapped(f"Ratio to baseline ({direction(pairs.metric)})", width - _BESIDE_PANEL, TEXT_SIZE)
    )


def _mark(baseline: Item, width: float) -> list[str]:
    """What stands on the line at 1."""
    return wrap(f"baseline: {baseline.label}", width - _BESIDE_PANEL, SMALL_SIZE)


def _name_line(axes: Axes, place: int, mark: Sequence[str], width: float) -> None:
    """Writes over the line at 1, in the row that has no bar, without leaving the panel."""
    low, high = (math.log(end) for end in axes.get_xlim())
    half = max(text_width(line, SMALL_SIZE) for line in mark) / 2 / (width - _BESIDE_PANEL)
    half = min(half, 0.5)
    axes.text(
        min(max(-low / (high - low), half), 1 - half),
        place,
        "\n".join(mark),
        transform=axes.get_yaxis_transform(),
        ha="center",
        va="center",
        size=SMALL_SIZE,
        style="italic",
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 1},
        zorder=2,
    )


def _draw_bar(
    axes: Axes, place: int, made: Comparison, ratios: Sequence[float], look: Look
) -> None:
    axes.barh(
        place,
        made.median - 1,
        left=1,
        height=_BAR,
        color=look.colour,
        hatch=look.hatch,
        edgecolor="black",
        linewidth=0.5,
    )
    axes.plot(
        ratios,
        [place + _BAR / 2 + 0.1] * len(ratios),
        linestyle="none",
        marker="|",
        markersize=3,
        color="black",
        markeredgewidth=0.6,
    )
    if made.interval.low < made.interval.high:
        axes.errorbar(
            made.median,
            place,
            xerr=[[made.median - made.interval.low], [made.interval.high - made.median]],
            fmt="none",
            ecolor="black",
            elinewidth=0.9,
            capsize=2.5,
        )


def _write(axes: Axes, place: int, words: str) -> None:
    axes.annotate(
        words,
        (0, place),
        xycoords=axes.get_yaxis_transform(),
        xytext=(0.04 * POINTS_PER_INCH, 0),
        textcoords="offset points",
        va="center",
        size=SMALL_SIZE,
        style="italic",
    )


def _notes(
    results: Results, setting: Item, compared: Sequence[Comparisons], baseline: Item
) -> list[str]:
    tally = Tally()
    for model in results.models:
        base = results.slot(setting, model, baseline)
        for contender in results.contenders:
            slot = results.slot(setting, model, contender)
            shown = bool(slot.valid and base.valid)
            tally.add(slot, None if shown else "where the baseline is not valid")
    return [
        f"Baseline: {baseline.label}. A bar is the median over the models of the ratio of totals, "
        "the whiskers its 95 % interval (bootstrap over models, repetitions drawn anew for times; "
        "fewer than six models cannot carry 95 %), a tick one model.",
        tally.sentence(),
    ]
