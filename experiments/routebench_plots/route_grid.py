"""Where the pictures of a layer's routes stand, all in the same scale."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from .shapes import Points
from .sheet import MARGIN, even_columns
from .style import PAGE_HEIGHT, PAGE_WIDTH, TEXT_SIZE
from .text import text_height, wrap

GAP = 0.14
"""Inches between panels."""
_LEAST_PANEL_WIDTH, _MOST_PANEL_WIDTH = 1.3, 4.5
_LEAST_PANEL_HEIGHT = 0.5
_FIRST_HEIGHT, _MORE_HEIGHT = 3.5, 0.5
_STRAY_SHARE = 0.5
"""How far strokes outside the layer widen the view, of its size."""
_BORDER_SHARE = 0.03


@dataclass(frozen=True)
class View:
    """The part of the layer that all panels show, mm."""

    low: Points
    high: Points

    @property
    def size(self) -> Points:
        """Width and height."""
        return self.high - self.low


@dataclass(frozen=True)
class Grid:
    """Sizes of the panels, inches, and inches for a millimetre."""

    columns: int
    rows: int
    panel_width: float
    panel_height: float
    title_height: float
    scale: float

    @property
    def width(self) -> float:
        """Of all columns."""
        return self.columns * (self.panel_width + GAP) - GAP

    @property
    def height(self) -> float:
        """Of all rows with their titles."""
        return self.rows * (self.panel_height + self.title_height + GAP)


def view_of(material: Iterable[Points], strokes: Iterable[Points]) -> View:
    """Shows all material, and strokes outside it as far as sensible.

    A route that runs metres away from the part would shrink the part to a
    dot; such strokes leave the picture instead.
    """
    shape = list(material)
    drawn = list(strokes)
    points = np.vstack(shape or drawn or [np.zeros((1, 2))])
    low, high = points.min(axis=0), points.max(axis=0)
    reach = _STRAY_SHARE * max(float((high - low).max()), 1.0)
    if drawn:
        stray = np.vstack(drawn)
        low = np.maximum(np.minimum(low, stray.min(axis=0)), low - reach)
        high = np.minimum(np.maximum(high, stray.max(axis=0)), high + reach)
    border = _BORDER_SHARE * max(float((high - low).max()), 1.0)
    return View(low - border, high + border)


def grid_for(view: View, titles: Sequence[Sequence[str]]) -> Grid:
    """The number of columns that gives the largest pictures.

    A few pictures get less of the page than many, and so rather stand
    side by side.
    """
    page = min(PAGE_HEIGHT, _FIRST_HEIGHT + _MORE_HEIGHT * len(titles))
    columns = {1} | {
        even_columns(len(titles), most)
        for most in range(1, len(titles) + 1)
        if _panel_width(most) >= _LEAST_PANEL_WIDTH
    }
    return max(
        (_grid(view, titles, n, page) for n in sorted(columns)),
        key=lambda grid: (grid.scale, grid.columns),
    )


def _grid(
    view: View, titles: Sequence[Sequence[str]], columns: int, page: float
) -> Grid:
    """Panels in so many columns, on a page of that height if they can."""
    panel_width = _panel_width(columns)
    title_height = max(
        text_height(
            sum(len(wrap(s, panel_width, TEXT_SIZE, "bold")) for s in title),
            TEXT_SIZE,
        )
        for title in titles
    )
    rows = -(-len(titles) // columns)
    room = max(page / rows - title_height - GAP, _LEAST_PANEL_HEIGHT)
    width, height = view.size
    scale = min(panel_width / width, room / height)
    return Grid(
        columns=columns,
        rows=rows,
        panel_width=panel_width,
        panel_height=max(scale * height, _LEAST_PANEL_HEIGHT),
        title_height=title_height,
        scale=scale,
    )


def _panel_width(columns: int) -> float:
    inner = PAGE_WIDTH - 2 * MARGIN
    return min((inner - (columns - 1) * GAP) / columns, _MOST_PANEL_WIDTH)
