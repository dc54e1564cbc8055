"""A figure as it stands in a paper: title, panels, legend, notes.

Title, legend and notes get the room that their text takes; the panels get
a rectangle of known size between them. So nothing is cut off and nothing
lies over data, however long the names are.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_pdf import FigureCanvasPdf
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.layout_engine import PlaceHolderLayoutEngine
from matplotlib.legend import Legend
from matplotlib.transforms import Bbox

from .style import DPI, MUTED, SMALL_SIZE, TEXT_SIZE, TITLE_SIZE
from .text import POINTS_PER_INCH, text_height, text_width, wrap, wrapped

MARGIN = 0.08
_GAP = 0.1
MOST_PIXELS = 32_000
"""In a row or column of a PNG: Agg draws nothing that lies beyond 2^15 pixels."""
_HANDLE = 2.2
"""Width of a legend's handle, in font sizes; _HANDLE_ROOM with its gaps."""
_HANDLE_ROOM = 4.4

_METADATA: dict[str, dict[str, str | None]] = {
    "png": {"Software": None},
    "svg": {"Date": None, "Creator": "routebench"},
    "pdf": {"CreationDate": None, "Creator": "routebench"},
}
FORMATS = tuple(_METADATA)

_PRINT: dict[str, Callable[..., None]] = {
    "png": lambda figure, stream, metadata: FigureCanvasAgg(figure).print_png(
        stream, metadata=metadata
    ),
    "svg": lambda figure, stream, metadata: FigureCanvasSVG(figure).print_svg(
        stream, metadata=metadata
    ),
    "pdf": lambda figure, stream, metadata: FigureCanvasPdf(figure).print_pdf(
        stream, metadata=metadata
    ),
}


@dataclass(frozen=True)
class LegendEntry:
    """A handle and what it stands for."""

    handle: Artist
    label: str


@dataclass(frozen=True)
class Rect:
    """A place on a sheet: inches from its lower left corner."""

    left: float
    bottom: float
    width: float
    height: float


class Sheet:
    """A figure whose panels fill `body`, a rectangle of known size."""

    def __init__(
        self,
        width: float,
        body_height: float,
        title: str,
        notes: Sequence[str] = (),
        legend: Sequence[LegendEntry] = (),
    ) -> None:
        self.width = width
        self.height = 1.0  # until it is known what is above and below the body
        self.figure = Figure(figsize=(width, self.height), dpi=self._dpi())
        FigureCanvasAgg(self.figure)
        inner = width - 2 * MARGIN
        title_lines = wrap(title, inner, TITLE_SIZE, "bold")
        note_lines = [
            line for note in notes for line in wrap(note, inner, SMALL_SIZE)
        ]
        drawn_legend = self._add_legend(legend, inner) if legend else None

        bottom = MARGIN + text_height(len(note_lines), SMALL_SIZE)
        legend_bottom = bottom + _GAP
        if drawn_legend is not None:
            bottom = legend_bottom + self._height_of(drawn_legend)
        bottom += _GAP
        title_bottom = bottom + body_height + _GAP
        height = (
            title_bottom + text_height(len(title_lines), TITLE_SIZE) + MARGIN
        )
        self.height = height
        self.body = Rect(MARGIN, bottom, inner, body_height)
        self.figure.set_size_inches(width, height)
        self.figure.dpi = self._dpi()

        left = MARGIN / width
        self.figure.text(
            left,
            title_bottom / height,
            "\n".join(title_lines),
            size=TITLE_SIZE,
            weight="bold",
            va="bottom",
        )
        self.figure.text(
            left,
            MARGIN / height,
            "\n".join(note_lines),
            size=SMALL_SIZE,
            color=MUTED,
            va="bottom",
        )
        if drawn_legend is not None:
            drawn_legend.set_bbox_to_anchor(
                (left, legend_bottom / height),
                transform=self.figure.transFigure,
            )

    def panels(
        self,
        rows: int,
        columns: int,
        height_ratios: Sequence[float] | None = None,
        share_y: bool = False,
    ) -> list[list[Axes]]:
        """Axes that fill the body, laid out so that their labels fit."""
        self.figure.set_layout_engine(
            "constrained",
            rect=(
                self.body.left / self.width,
                self.body.bottom / self.height,
                self.body.width / self.width,
                self.body.height / self.height,
            ),
            w_pad=0.03,
            h_pad=0.08,
        )
        axes = self.figure.subplots(
            rows,
            columns,
            squeeze=False,
            sharey="row" if share_y else False,
            gridspec_kw={"height_ratios": height_ratios},
        )
        return [list(row) for row in axes]

    def row_by_row(self, count: int, columns: int) -> list[Axes]:
        """So many panels, their y axes shared in a row; places left over stay empty."""
        grid = self.panels(-(-count // columns), columns, share_y=True)
        axes = [one for row in grid for one in row]
        for one in axes[count:]:
            one.set_visible(False)
        return axes[:count]

    def axes_at(self, place: Rect) -> Axes:
        """Axes at a place given in inches from the lower left corner."""
        return self.figure.add_axes(
            (
                place.left / self.width,
                place.bottom / self.height,
                place.width / self.width,
                place.height / self.height,
            )
        )

    def save(self, folder: Path, stem: str, formats: Sequence[str]) -> None:
        """Writes one file for each format; equal figures, equal bytes."""
        for name in formats:
            (folder / f"{stem}.{name}").write_bytes(self.encoded(name))

    def encoded(self, name: str) -> bytes:
        """The figure as the content of a file in one of FORMATS."""
        self._settle()
        # Not savefig, which draws everything once more before it writes.
        stream = io.BytesIO()
        _PRINT[name](self.figure, stream, _METADATA[name])
        FigureCanvasAgg(self.figure)
        self.figure.dpi = self._dpi()
        return stream.getvalue()

    def _dpi(self) -> float:
        """Pixels an inch: fewer where there would be more than can be drawn."""
        return min(DPI, MOST_PIXELS / max(self.width, self.height))

    def _settle(self) -> None:
        """Lays out once for all formats.

        The solver behind the layout visits its variables in the order of
        their addresses, so the last bits of its result differ from run to
        run. They are rounded away.
        """
        engine = self.figure.get_layout_engine()
        if engine is None or isinstance(engine, PlaceHolderLayoutEngine):
            return
        engine.execute(self.figure)
        self.figure.set_layout_engine("none")
        for axes in self.figure.axes:
            corners = axes.get_position(original=True).get_points()
            axes.set_position(Bbox(corners.round(6)))

    def _add_legend(
        self, entries: Sequence[LegendEntry], width: float
    ) -> Legend:
        room = _HANDLE_ROOM * TEXT_SIZE / POINTS_PER_INCH
        label_width = min(width - room, 2.6)
        labels = [
            wrapped(entry.label, label_width, TEXT_SIZE) for entry in entries
        ]
        widest = max(
            text_width(line, TEXT_SIZE)
            for label in labels
            for line in label.split("\n")
        )
        columns = max(1, min(len(entries), int(width / (widest + room))))
        legend = self.figure.legend(
            [entry.handle for entry in entries],
            # A label that begins with an underscore would be left out.
            ["."] * len(entries),
            loc="lower left",
            bbox_to_anchor=(0, 0),
            ncols=columns,
            handlelength=_HANDLE,
            handleheight=1.0,
            handletextpad=0.6,
            columnspacing=1.4,
            borderpad=0,
            borderaxespad=0,
            labelspacing=0.35,
        )
        for shown, label in zip(legend.get_texts(), labels):
            shown.set_text(label)
        return legend

    def _height_of(self, artist: Artist) -> float:
        renderer = self.figure.canvas.get_renderer()
        extent = artist.get_window_extent(renderer)
        return float(extent.height / self.figure.dpi)


def even_columns(panels: int, most: int) -> int:
    """The fewest columns that need no more rows than `most` would."""
    rows = -(-panels // most)
    return -(-panels // rows)
