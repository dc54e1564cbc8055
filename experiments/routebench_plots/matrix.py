"""A table drawn as a figure: models down, contenders across, something in each place."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from matplotlib.axes import Axes
from matplotlib.patches import Rectangle

from .results import Item
from .sheet import MARGIN, LegendEntry, Sheet
from .style import PAGE_WIDTH, TEXT_SIZE
from .text import text_height, text_width, wrap

_MODEL_WIDTH = 1.9
_CELL_WIDTHS = (0.85, 1.6)
_PAD = 0.06
MODELS_PER_PAGE = 30


def draw_matrix(
    models: Sequence[Item],
    contenders: Sequence[Item],
    words: Callable[[int, int], list[str]],
    fill: Callable[[Axes, Rectangle, int, int], str],
    title: str,
    notes: Sequence[str],
    legend: Sequence[LegendEntry] = (),
) -> Sheet:
    """Rows as high as their words need.

    `words` gives what stands in the place of a row and column; none of it is cut off. `fill` adds
    the place's rectangle to the axes and returns the colour of the words.
    """
    model_lines = [wrap(m.label, _MODEL_WIDTH, TEXT_SIZE) for m in models]
    label_width = 2 * _PAD + max(
        text_width(line, TEXT_SIZE) for lines in model_lines for line in lines
    )
    cell_width = _cell_width(contenders, label_width)
    head_lines = [wrap(c.label, cell_width - 2 * _PAD, TEXT_SIZE) for c in contenders]
    cell_texts = [
        [
            [
                line
                for text in words(row, column)
                for line in wrap(text, cell_width - 2 * _PAD, TEXT_SIZE)
            ]
            for column in range(len(contenders))
        ]
        for row in range(len(models))
    ]
    head = text_height(max(map(len, head_lines)), TEXT_SIZE) + 2 * _PAD
    heights = [
        2 * _PAD + text_height(max(len(lines), *map(len, texts)), TEXT_SIZE)
        for lines, texts in zip(model_lines, cell_texts)
    ]
    inner = label_width + cell_width * len(contenders)
    sheet = Sheet(
        width=max(PAGE_WIDTH / 2, inner + 2 * MARGIN),
        body_height=head + sum(heights),
        title=title,
        notes=notes,
        legend=legend,
    )
    axes = sheet.axes_at(sheet.body)
    axes.set(xlim=(0, sheet.body.width), ylim=(sheet.body.height, 0))
    axes.set_axis_off()

    for column, lines in enumerate(head_lines):
        axes.text(
            label_width + (column + 0.5) * cell_width,
            head - _PAD,
            "\n".join(lines),
            ha="center",
            va="bottom",
        )
    top = head
    for row, (lines, height) in enumerate(zip(model_lines, heights)):
        axes.text(
            label_width - _PAD,
            top + height / 2,
            "\n".join(lines),
            ha="right",
            va="center",
        )
        for column, text in enumerate(cell_texts[row]):
            left = label_width + column * cell_width
            place = Rectangle((left, top), cell_width, height, edgecolor="white", linewidth=1.5)
            ink = fill(axes, place, row, column)
            axes.text(
                left + cell_width / 2,
                top + height / 2,
                "\n".join(text),
                ha="center",
                va="center",
                color=ink,
            )
        top += height
    return sheet


def _cell_width(contenders: Sequence[Item], label_width: float) -> float:
    """Fits the page if it can, and a contender's name if that is short."""
    least, most = _CELL_WIDTHS
    room = (PAGE_WIDTH - 2 * MARGIN - label_width) / len(contenders)
    wish = 2 * _PAD + max(text_width(c.label, TEXT_SIZE) for c in contenders)
    return min(max(least, min(room, wish)), most)
