"""Bars of one metric: a panel for each model, a bar for each contender."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.patches import Rectangle

from .axis import axis_label, number_ticks
from .quantities import Scale, format_number, scale_for
from .results import TIMED_METRICS, Item, Metric, Results, Slot, Value
from .sheet import MARGIN, Sheet, even_columns
from .style import (
    ABSENT,
    MUTED,
    PAGE_HEIGHT,
    PAGE_WIDTH,
    SMALL_SIZE,
    TEXT_SIZE,
    Look,
    looks,
    outcome_look,
)
from .tally import Tally
from .text import POINTS_PER_INCH, text_height, text_width, wrap, wrapped

_LABEL_WIDTH = 1.9
_PANEL_WIDTHS = (1.6, 3.2)
_MOST_COLUMNS = 3
_LEAST_PITCH = 0.19
_LEAST_BARS = 0.45
"""Height of a panel's bars, however few there are."""
_BAR = 0.7
"""Thickness of a bar, in pitches."""
_AXIS_HEIGHT = 0.5
"""Below a panel, for the numbers and the name of its axis."""
_LABEL_GAP = 0.15
"""Between the names and the first panel."""
_TEXT_GAP = 0.04
"""Between the end of a bar and its number."""


@dataclass(frozen=True)
class Layout:
    """Sizes of the panels in inches, the same on all pages."""

    columns: int
    rows: int
    panel_width: float
    panel_height: float
    label_width: float

    def width(self, columns: int) -> float:
        """Of a page with so many columns of panels."""
        labels = self.label_width + _LABEL_GAP
        return 2 * MARGIN + labels + columns * self.panel_width

    @property
    def models_per_page(self) -> int:
        """How many panels there is room for."""
        return self.columns * self.rows


def layout_for(results: Results) -> Layout:
    """As many panels as the page and the names have room for."""
    lines = [
        wrap(contender.label, _LABEL_WIDTH, TEXT_SIZE)
        for contender in results.contenders
    ]
    label_width = max(text_width(s, TEXT_SIZE) for ls in lines for s in ls)
    least, most = _PANEL_WIDTHS
    room = PAGE_WIDTH - 2 * MARGIN - label_width - _LABEL_GAP
    columns = min(len(results.models), _MOST_COLUMNS, int(room / least))
    columns = even_columns(len(results.models), columns)
    panel_width = min(most, room / columns)
    pitch = max(
        _LEAST_PITCH, text_height(max(map(len, lines)), TEXT_SIZE) + 0.05
    )
    titles = max(
        len(wrap(model.label, panel_width, TEXT_SIZE))
        for model in results.models
    )
    height = max(_LEAST_BARS, pitch * len(results.contenders)) + (
        text_height(titles, TEXT_SIZE) + _AXIS_HEIGHT
    )
    return Layout(
        columns=columns,
        rows=max(1, int(PAGE_HEIGHT / height)),
        panel_width=panel_width,
        panel_height=height,
        label_width=label_width,
    )


def draw(
    results: Results,
    setting: Item,
    metric: Metric,
    models: Sequence[Item],
    title: str,
) -> Sheet:
    """One page of bars; `models` are at most the layout's models_per_page."""
    layout = layout_for(results)
    slots = {
        (model.row_id, contender.row_id): results.slot(
            setting, model, contender
        )
        for model in models
        for contender in results.contenders
    }
    values = {
        place: value
        for place, slot in slots.items()
        if (value := results.value(slot, metric)) is not None
    }
    # The same unit on all pages.
    scale = scale_for(
        metric, (value.high for value in results.all_values(setting, metric))
    )
    tally = Tally()
    for place, slot in slots.items():
        tally.add(slot, None if place in values else "without a value")

    columns = min(layout.columns, len(models))
    rows = -(-len(models) // columns)
    sheet = Sheet(
        width=layout.width(columns),
        body_height=rows * layout.panel_height,
        title=title,
        notes=_notes(results, setting, metric, values, tally),
    )
    for axes, model in zip(sheet.row_by_row(len(models), columns), models):
        _draw_panel(
            axes,
            results.contenders,
            [slots[model.row_id, c.row_id] for c in results.contenders],
            [values.get((model.row_id, c.row_id)) for c in results.contenders],
            metric,
            scale,
            layout.panel_width,
        )
        axes.set_title(
            wrapped(model.label, layout.panel_width - 0.1, TEXT_SIZE)
        )
    return sheet


def _draw_panel(
    axes: Axes,
    contenders: Sequence[Item],
    slots: Sequence[Slot],
    values: Sequence[Value | None],
    metric: Metric,
    scale: Scale,
    width: float,
) -> None:
    """Draws a model's bars, contenders from the top down."""
    contender_looks = looks(contenders)
    best = _best(metric, values)
    texts = [
        _bar_text(scale, slot, value) for slot, value in zip(slots, values)
    ]
    axes.set_xlim(*_limits(scale, values, texts, width))
    axes.set_ylim(len(contenders) - 0.5, -0.5)
    axes.grid(axis="x")
    axes.tick_params(axis="y", length=0, labelsize=TEXT_SIZE)
    axes.set_yticks(
        range(len(contenders)),
        [wrapped(c.label, _LABEL_WIDTH, TEXT_SIZE) for c in contenders],
    )
    number_ticks(axes.xaxis, most=4)
    axes.set_xlabel(axis_label(metric, scale, width - 0.1))
    for place, (contender, slot, value) in enumerate(
        zip(contenders, slots, values)
    ):
        if value is None:
            _draw_absence(axes, place, slot)
            continue
        _draw_bar(axes, place, value, scale, contender_looks[contender.row_id])
        axes.annotate(
            texts[place],
            (max(0.0, scale(value.high)), place),
            xytext=(_TEXT_GAP * POINTS_PER_INCH, 0),
            textcoords="offset points",
            va="center",
            size=SMALL_SIZE,
            weight="bold" if value.median == best else "normal",
        )


def _draw_bar(
    axes: Axes, place: int, value: Value, scale: Scale, look: Look
) -> None:
    axes.barh(
        place,
        scale(value.median),
        height=_BAR,
        color=look.colour,
        hatch=look.hatch,
        edgecolor="black",
        linewidth=0.5,
    )
    if value.low < value.high:
        axes.errorbar(
            scale(value.median),
            place,
            xerr=[
                [scale(value.median - value.low)],
                [scale(value.high - value.median)],
            ],
            fmt="none",
            ecolor="black",
            elinewidth=0.8,
            capsize=2,
        )


def _draw_absence(axes: Axes, place: int, slot: Slot) -> None:
    """An empty place, with the reason in words instead of a number."""
    if slot.valid:
        words = ABSENT
    else:
        words = ", ".join(
            outcome_look(outcome).words for outcome in sorted(slot.outcomes)
        )
        axes.add_patch(
            Rectangle(
                (0, place - _BAR / 2),
                1,
                _BAR,
                transform=axes.get_yaxis_transform(),
                facecolor="none",
                edgecolor="#C4C4C4",
                hatch="//////",
                linewidth=0,
            )
        )
    axes.annotate(
        words,
        (0, place),
        xycoords=axes.get_yaxis_transform(),
        xytext=(_TEXT_GAP * POINTS_PER_INCH, 0),
        textcoords="offset points",
        va="center",
        size=SMALL_SIZE,
        style="italic",
        color=MUTED,
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 1},
    )


def _bar_text(scale: Scale, slot: Slot, value: Value | None) -> str:
    if value is None:
        return ""
    text = format_number(scale(value.median))
    if len(slot.valid) < len(slot.cells):
        text += f" ({len(slot.valid)}/{len(slot.cells)} valid)"
    return text


def _best(metric: Metric, values: Sequence[Value | None]) -> float | None:
    """The best median of a panel, where one direction is better."""
    medians = [value.median for value in values if value is not None]
    if metric.better == "lower":
        return min(medians, default=None)
    if metric.better == "higher":
        return max(medians, default=None)
    return None


def _limits(
    scale: Scale,
    values: Sequence[Value | None],
    texts: Sequence[str],
    width: float,
) -> tuple[float, float]:
    """From zero on, so that every bar has room for its number."""
    low, high = 0.0, 0.0
    for value, text in zip(values, texts):
        if value is None:
            continue
        room = width - 0.1
        taken = text_width(text, SMALL_SIZE, "bold") + 2 * _TEXT_GAP
        share = max(0.25, 1 - taken / room)
        low = min(low, scale(value.low))
        high = max(high, scale(value.high) / share)
    return (low, high) if low < high else (0.0, 1.0)


def _notes(
    results: Results,
    setting: Item,
    metric: Metric,
    values: Mapping[tuple[int, int], Value],
    tally: Tally,
) -> list[str]:
    notes = [f"{metric.label}: {metric.meaning}."]
    if any(value.low < value.high for value in values.values()):
        notes[0] += f" {_range_note(metric, values)}"
    limits = [
        f"{words} {format_number(limit)}"
        for words, key in (("at least", "min"), ("at most", "max"))
        if (limit := results.task_number(setting, f"gate_{metric.name}_{key}"))
        is not None
    ]
    if limits:
        notes.append(f"Valid means {' and '.join(limits)} here.")
    notes.append(tally.sentence())
    return notes


def _range_note(
    metric: Metric, values: Mapping[tuple[int, int], Value]
) -> str:
    what = "repetitions" if metric.name in TIMED_METRICS else "seeds"
    counts = sorted({value.samples for value in values.values()})
    number = (
        f"{counts[0]}" if len(counts) == 1 else f"{counts[0]} to {counts[-1]}"
    )
    return (
        f"Bars are medians of {number} {what}, whiskers reach from the "
        "smallest to the largest."
    )
