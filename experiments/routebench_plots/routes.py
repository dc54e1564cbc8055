"""Pictures of one layer's routes, all contenders side by side."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from matplotlib.axes import Axes

from .quantities import counted, format_number, in_sentence, quantity
from .results import NOT_RUN, VALID, Cell, Item, Results
from .route_grid import GAP, Grid, View, grid_for, view_of
from .route_panel import (
    BEAD_SHARE,
    draw_material,
    draw_route,
    legend_entries,
)
from .shapes import Stroke, read_multipolygon, read_strokes, travels
from .sheet import MARGIN, Rect, Sheet
from .style import (
    MUTED,
    SMALL_SIZE,
    STROKE_COLOURS,
    TEXT_SIZE,
    outcome_look,
)
from .tally import Tally
from .text import POINTS_PER_INCH, text_height, wrapped

_TITLE_METRICS = ("travel_mm", "retractions")
_ENTRY_METRIC = "entry_travel_mm"
_SCALE_BAR_HEIGHT = 0.26
_LEAST_WIDTH = 4.8
"""Of the sheet: room for the legend."""
_DEFAULT_JOIN_MM = 0.01


@dataclass(frozen=True)
class Picture:
    """What a panel shows; no strokes where no route was kept."""

    name: str
    figures: str
    outcome: str
    strokes: list[Stroke] | None

    @property
    def title(self) -> list[str]:
        """Name, figures, and the outcome if it is not the good one."""
        lines = [self.name]
        if self.figures:
            lines.append(self.figures)
        if self.strokes is not None and self.outcome != VALID:
            lines.append(outcome_look(self.outcome).words)
        return lines


def draw(
    results: Results, setting: Item, model: Item, layer_index: int, title: str
) -> Sheet:
    """A panel for each contender; empty ones name the outcome."""
    tally = Tally()
    pictures = [
        _picture(results, setting, model, contender, layer_index, tally)
        for contender in results.contenders
    ]
    polygons = read_multipolygon(
        results.layer_wkt(setting, model, layer_index),
        f"{results.database}: model {model.label}, layer {layer_index}",
    )
    strokes = [s for p in pictures for s in p.strokes or ()]
    view = view_of(
        (ring for polygon in polygons for ring in polygon),
        (stroke.points for stroke in strokes),
    )
    grid = grid_for(view, [picture.title for picture in pictures])
    join_mm = results.task_number(setting, "join_mm")
    sheet = Sheet(
        width=max(_LEAST_WIDTH, grid.width + 2 * MARGIN),
        body_height=grid.height + _SCALE_BAR_HEIGHT,
        title=title,
        notes=_notes(view, strokes, tally),
        legend=legend_entries(_kinds(strokes)),
    )
    for place, picture in enumerate(pictures):
        axes = _panel(sheet, grid, view, place)
        draw_material(axes, polygons)
        _draw_title(axes, picture, grid)
        if picture.strokes is None:
            _draw_absence(axes, picture)
            continue
        draw_route(
            axes,
            picture.strokes,
            travels(
                picture.strokes,
                _DEFAULT_JOIN_MM if join_mm is None else join_mm,
            ),
            grid.scale * POINTS_PER_INCH,
        )
    _draw_scale_bar(sheet, grid)
    return sheet


def _picture(
    results: Results,
    setting: Item,
    model: Item,
    contender: Item,
    layer_index: int,
    tally: Tally,
) -> Picture:
    """Reads a panel's content; of several seeds the first valid one."""
    slot = results.slot(setting, model, contender)
    ranked = sorted(slot.cells, key=lambda cell: cell.outcome != VALID)
    cell = ranked[0] if ranked else None
    text = results.route_json(cell, layer_index) if cell else None
    tally.leave_out(len(ranked[1:]), "further seeds")
    if cell is None:
        tally.add_invalid(slot)
    elif text is None:
        why = outcome_look(cell.outcome).words
        tally.leave_out(1, f"{why}, without a route of this layer")
    else:
        tally.show(1)
    return Picture(
        name=contender.label,
        figures=_figures(results, cell, layer_index) if cell else "",
        outcome=cell.outcome if cell else NOT_RUN,
        strokes=None
        if cell is None or text is None
        else read_strokes(
            text,
            f"{results.database}: route of cell {cell.cell_id}, "
            f"layer {layer_index}",
        ),
    )


def _figures(results: Results, cell: Cell, layer_index: int) -> str:
    """The layer's scores that a title names."""
    words = []
    for name in _TITLE_METRICS:
        metric = results.metric(name)
        if metric is None:
            continue
        value = results.layer_value(cell, layer_index, metric)
        if value is not None:
            number = quantity(value, metric.unit)
            words.append(f"{in_sentence(metric.label)} {number}")
    return ", ".join(words)


def _kinds(strokes: Sequence[Stroke]) -> list[str]:
    present = {stroke.kind for stroke in strokes}
    known = [kind for kind in STROKE_COLOURS if kind in present]
    return known + sorted(present - set(known))


def _panel(sheet: Sheet, grid: Grid, view: View, place: int) -> Axes:
    """Axes of exactly the grid's scale, the layer in their middle."""
    row, column = divmod(place, grid.columns)
    row_height = grid.panel_height + grid.title_height + GAP
    axes = sheet.axes_at(
        Rect(
            left=sheet.body.left + column * (grid.panel_width + GAP),
            bottom=sheet.body.bottom
            + _SCALE_BAR_HEIGHT
            + (grid.rows - 1 - row) * row_height,
            width=grid.panel_width,
            height=grid.panel_height,
        )
    )
    centre = (view.low + view.high) / 2
    reach = (
        grid.panel_width / grid.scale / 2,
        grid.panel_height / grid.scale / 2,
    )
    axes.set_xlim(centre[0] - reach[0], centre[0] + reach[0])
    axes.set_ylim(centre[1] - reach[1], centre[1] + reach[1])
    axes.set_axis_off()
    return axes


def _draw_title(axes: Axes, picture: Picture, grid: Grid) -> None:
    """The lines of the title from the panel upwards."""
    bottom = 2.0
    for place, text in reversed(list(enumerate(picture.title))):
        lines = wrapped(text, grid.panel_width, TEXT_SIZE, "bold")
        axes.annotate(
            lines,
            (0.5, 1),
            xycoords="axes fraction",
            xytext=(0, bottom),
            textcoords="offset points",
            ha="center",
            va="bottom",
            size=TEXT_SIZE,
            weight="bold" if place == 0 else "normal",
            style="italic" if place == 2 else "normal",
        )
        height = text_height(lines.count("\n") + 1, TEXT_SIZE)
        bottom += height * POINTS_PER_INCH


def _draw_absence(axes: Axes, picture: Picture) -> None:
    axes.annotate(
        "no route\n" + outcome_look(picture.outcome).words,
        (0.5, 0.5),
        xycoords="axes fraction",
        ha="center",
        va="center",
        size=SMALL_SIZE,
        style="italic",
        color=MUTED,
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 2},
    )


def _draw_scale_bar(sheet: Sheet, grid: Grid) -> None:
    """A length of one, two or five, at most half a panel wide."""
    most = grid.panel_width / grid.scale / 2
    decade = 10.0 ** math.floor(math.log10(most))
    length = max(n for n in (1, 2, 5) if n * decade <= most) * decade
    axes = sheet.axes_at(
        Rect(
            sheet.body.left,
            sheet.body.bottom,
            sheet.body.width,
            _SCALE_BAR_HEIGHT,
        )
    )
    axes.set(xlim=(0, sheet.body.width), ylim=(0, 1))
    axes.set_axis_off()
    right = 0.02 + length * grid.scale
    axes.plot(
        [0.02, right],
        [0.5, 0.5],
        color="black",
        linewidth=1.2,
        marker="|",
        markersize=5,
        clip_on=False,
    )
    axes.text(
        right + 0.08,
        0.5,
        f"{format_number(length)} mm",
        va="center",
        size=SMALL_SIZE,
    )


def _notes(view: View, strokes: Sequence[Stroke], tally: Tally) -> list[str]:
    notes = [
        "All panels have the same scale. Strokes are drawn at "
        f"{BEAD_SHARE:.0%} of their bead's width; the way from the layer "
        "below to the start counts as travel and is not drawn."
    ]
    stray = sum(
        bool(
            (stroke.points < view.low).any()
            or (stroke.points > view.high).any()
        )
        for stroke in strokes
    )
    if stray:
        notes.append(f"{counted(stray, 'stroke')} partly out of the picture.")
    notes.append(tally.sentence())
    return notes
