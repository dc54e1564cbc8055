"""One layer with one route on it: material, strokes, travels, ends."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path

from .shapes import Points, Stroke
from .sheet import LegendEntry
from .style import (
    MATERIAL_COLOUR,
    OTHER_STROKE_COLOUR,
    STROKE_COLOURS,
    TRAVEL_COLOUR,
)

BEAD_SHARE = 0.6
"""Drawn width of a stroke, of the bead's: neighbours stay apart."""
_LINE_POINTS = (0.15, 1.8)
_MANY_TRAVELS = 300
_RASTER_FROM = 20000
"""Points from which on lines are pixels in vector files."""
_DASHES = (0, (2.5, 1.2))


def draw_material(axes: Axes, polygons: Sequence[Sequence[Points]]) -> None:
    """The layer's polygons, holes left open."""
    rings = [ring for polygon in polygons for ring in polygon]
    if not rings:
        return
    axes.add_patch(
        PathPatch(
            Path.make_compound_path(*map(_closed, rings)),
            facecolor=MATERIAL_COLOUR,
            edgecolor="#9A9A9A",
            linewidth=0.4,
            zorder=1,
        )
    )


def draw_route(
    axes: Axes,
    strokes: Sequence[Stroke],
    moves: Sequence[Points],
    points_per_mm: float,
) -> None:
    """Strokes by kind, travels over them, and the two ends of the route.

    Cost: linear in points; one collection a kind, whatever the number.
    """
    raster = sum(len(stroke.points) for stroke in strokes) >= _RASTER_FROM
    for kind in sorted({stroke.kind for stroke in strokes}):
        own = [stroke for stroke in strokes if stroke.kind == kind]
        axes.add_collection(
            LineCollection(
                [stroke.points for stroke in own],
                colors=_stroke_colour(kind),
                linewidths=[
                    _line_width(stroke.width_mm * points_per_mm)
                    for stroke in own
                ],
                capstyle="round",
                joinstyle="round",
                label=kind,
                zorder=2,
                rasterized=raster,
            ),
            autolim=False,
        )
    axes.add_collection(
        LineCollection(
            list(moves),
            colors=TRAVEL_COLOUR,
            linewidths=0.8 if len(moves) < _MANY_TRAVELS else 0.45,
            linestyles=[_DASHES],
            label="travel",
            zorder=3,
            rasterized=raster,
        ),
        autolim=False,
    )
    if strokes:
        for marker, point in (
            (_start_marker(), strokes[0].points[0]),
            (_end_marker(), strokes[-1].points[-1]),
        ):
            marker.set_data([point[0]], [point[1]])
            marker.set(zorder=4, clip_on=False)
            axes.add_line(marker)


def legend_entries(kinds: Sequence[str]) -> list[LegendEntry]:
    """What the colours and marks of the panels mean."""
    return [
        LegendEntry(
            Patch(facecolor=MATERIAL_COLOUR, edgecolor="#9A9A9A", lw=0.4),
            "material",
        ),
        *(
            LegendEntry(
                Line2D([], [], color=_stroke_colour(kind), linewidth=1.8),
                f"{kind} strokes",
            )
            for kind in kinds
        ),
        LegendEntry(
            Line2D(
                [], [], color=TRAVEL_COLOUR, linewidth=0.9, linestyle=_DASHES
            ),
            "travel",
        ),
        LegendEntry(_start_marker(), "start"),
        LegendEntry(_end_marker(), "end"),
    ]


def _closed(ring: Points) -> Path:
    return Path(np.vstack([ring, ring[:1]]), closed=True)


def _stroke_colour(kind: str) -> str:
    return STROKE_COLOURS.get(kind, OTHER_STROKE_COLOUR)


def _line_width(bead_points: float) -> float:
    least, most = _LINE_POINTS
    return min(max(least, BEAD_SHARE * bead_points), most)


def _start_marker() -> Line2D:
    return _end_of_route("o", "white")


def _end_marker() -> Line2D:
    return _end_of_route("s", "black")


def _end_of_route(marker: str, colour: str) -> Line2D:
    return Line2D(
        [],
        [],
        linestyle="none",
        marker=marker,
        markersize=4.5,
        markerfacecolor=colour,
        markeredgecolor="black",
        markeredgewidth=0.9,
    )
