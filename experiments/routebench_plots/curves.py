"""Curves over the height of one model: which layers are the dear ones."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from .axis import axis_label, number_ticks
from .quantities import counted, scale_for
from .results import Item, LayerRows, Metric, Results
from .sheet import LegendEntry, Sheet
from .style import PAGE_WIDTH, Look, looks
from .tally import Tally

_PANEL_HEIGHT = 1.9
_MARKERS = 12
"""About so many markers stand on a curve."""
_REPAIRED_COLOUR = "#F3C9B5"


def draw(
    results: Results,
    setting: Item,
    model: Item,
    metrics: Sequence[Metric],
    title: str,
) -> Sheet:
    """A panel for each metric, a curve for each contender."""
    tally = Tally()
    rows: dict[int, LayerRows] = {}
    for contender in results.contenders:
        slot = results.slot(setting, model, contender)
        found = (
            results.layer_rows(slot.valid[0], metrics) if slot.valid else None
        )
        if found is None or not found.z_mm:
            tally.add(slot, "without layers")
            continue
        rows[contender.row_id] = found
        tally.add_invalid(slot)
        tally.show(1)
        tally.leave_out(len(slot.valid) - 1, "further seeds")

    contender_looks = looks(results.contenders)
    repaired = sorted(
        {
            z
            for found in rows.values()
            for z, mended in zip(found.z_mm, found.repaired)
            if mended
        }
    )
    notes = ["Each point is one layer at its height z."]
    if repaired:
        notes.append(
            f"{counted(len(repaired), 'layer')} repaired before planning: "
            "shaded."
        )
    sheet = Sheet(
        width=PAGE_WIDTH,
        body_height=_PANEL_HEIGHT * len(metrics) + 0.3,
        title=title,
        notes=[*notes, tally.sentence()],
        legend=[
            LegendEntry(
                curve(contender_looks[contender.row_id]), contender.label
            )
            for contender in results.contenders
            if contender.row_id in rows
        ],
    )
    panels = [row[0] for row in sheet.panels(len(metrics), 1)]
    for axes, metric in zip(panels, metrics):
        _draw_metric(axes, results.contenders, rows, metric)
        for z in repaired:
            axes.axvline(z, color=_REPAIRED_COLOUR, linewidth=1.5, zorder=0)
        axes.sharex(panels[0])
        axes.label_outer()
    number_ticks(panels[-1].xaxis, most=10)
    panels[-1].set_xlabel("Height z [mm]")
    return sheet


def _draw_metric(
    axes: Axes,
    contenders: Sequence[Item],
    rows: dict[int, LayerRows],
    metric: Metric,
) -> None:
    curves = {
        row_id: found.columns[metric.name]
        for row_id, found in rows.items()
        if metric.name in found.columns
    }
    values = [v for column in curves.values() for v in column if v == v]
    scale = scale_for(metric, values)
    contender_looks = looks(contenders)
    for place, contender in enumerate(contenders):
        if contender.row_id not in curves:
            continue
        heights = rows[contender.row_id].z_mm
        line = curve(contender_looks[contender.row_id])
        line.set_data(heights, [scale(v) for v in curves[contender.row_id]])
        step = max(1, len(heights) // _MARKERS)
        # Markers of curves that coincide stand side by side.
        shift = place * step // len(contenders)
        line.set_markevery((min(shift, len(heights) - 1), step))
        axes.add_line(line)
    axes.autoscale_view()
    low, high = min(values, default=0.0), max(values, default=0.0)
    low, high = scale(min(low, 0.0)), scale(high)
    span = (high - low) or 1.0
    axes.set_ylim(low - 0.04 * span, high + 0.06 * span)
    axes.grid(True)
    number_ticks(axes.yaxis, most=5)
    axes.set_ylabel(
        axis_label(metric, scale, _PANEL_HEIGHT - 0.3, " per layer")
    )


def curve(look: Look) -> Line2D:
    """An empty line with the contender's colour, dashes and markers."""
    return Line2D(
        [],
        [],
        color=look.colour,
        linestyle=(0, look.dashes) if look.dashes else "-",
        linewidth=1.1,
        marker=look.marker,
        markersize=3.5,
        markeredgecolor="white",
        markeredgewidth=0.3,
    )
