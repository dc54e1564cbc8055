"""The first figure: how every cell ended, so that nothing is hidden."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.patches import Rectangle

from .quantities import counted
from .results import NOT_RUN, VALID, Item, Results, Slot
from .sheet import MARGIN, Sheet
from .style import (
    OUTCOME_ORDER,
    PAGE_WIDTH,
    TEXT_SIZE,
    outcome_look,
)
from .text import text_height, text_width, wrap

_MODEL_WIDTH = 1.9
_CELL_WIDTHS = (0.85, 1.6)
_PAD = 0.06
_MOST_REASONS = 12


def draw(
    results: Results, setting: Item, models: Sequence[Item], title: str
) -> Sheet:
    """Models down, contenders across; a colour and a word in each place."""
    contenders = results.contenders
    model_lines = [wrap(m.label, _MODEL_WIDTH, TEXT_SIZE) for m in models]
    label_width = 2 * _PAD + max(
        text_width(line, TEXT_SIZE) for lines in model_lines for line in lines
    )
    cell_width = _cell_width(contenders, label_width)
    head_lines = [
        wrap(c.label, cell_width - 2 * _PAD, TEXT_SIZE) for c in contenders
    ]
    slots = [
        [results.slot(setting, model, contender) for contender in contenders]
        for model in models
    ]
    cell_texts = [
        [_cell_lines(slot, cell_width) for slot in row] for row in slots
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
        notes=_notes(slots, models, contenders, results.earlier_cells),
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
        for column, slot in enumerate(slots[row]):
            place = Rectangle(
                (label_width + column * cell_width, top), cell_width, height
            )
            _draw_cell(axes, place, slot, cell_texts[row][column])
        top += height
    return sheet


def _cell_width(contenders: Sequence[Item], label_width: float) -> float:
    """Fits the page if it can, and a contender's name if that is short."""
    least, most = _CELL_WIDTHS
    room = (PAGE_WIDTH - 2 * MARGIN - label_width) / len(contenders)
    wish = 2 * _PAD + max(text_width(c.label, TEXT_SIZE) for c in contenders)
    return min(max(least, min(room, wish)), most)


def _cell_lines(slot: Slot, cell_width: float) -> list[str]:
    counts = slot.outcomes
    several = counts.total() > 1
    return [
        line
        for outcome in _by_weight(slot)
        for line in wrap(
            outcome_look(outcome).words
            + (f" ×{counts[outcome]}" if several else ""),
            cell_width - 2 * _PAD,
            TEXT_SIZE,
        )
    ]


def _by_weight(slot: Slot) -> list[str]:
    """The slot's outcomes, the gravest first."""
    order = {outcome: place for place, outcome in enumerate(OUTCOME_ORDER)}
    return sorted(slot.outcomes, key=lambda o: (-order.get(o, len(order)), o))


def _draw_cell(
    axes: Axes, place: Rectangle, slot: Slot, lines: Sequence[str]
) -> None:
    gravest = _by_weight(slot)[0]
    look = outcome_look(gravest)
    place.set(facecolor=look.background, edgecolor="white", linewidth=1.5)
    if gravest == NOT_RUN:
        place.set(edgecolor="#C8C8C8", linewidth=0.5, linestyle=(0, (3, 2)))
    axes.add_patch(place)
    axes.text(
        place.get_x() + place.get_width() / 2,
        place.get_y() + place.get_height() / 2,
        "\n".join(lines),
        ha="center",
        va="center",
        color=look.ink,
    )


def _notes(
    slots: Sequence[Sequence[Slot]],
    models: Sequence[Item],
    contenders: Sequence[Item],
    earlier_cells: int,
) -> list[str]:
    """How many cells ended how, and why."""
    everything = [
        (model, contender, slot)
        for model, row in zip(models, slots)
        for contender, slot in zip(contenders, row)
    ]
    cells = [cell for _, _, slot in everything for cell in slot.cells]
    valid = sum(cell.outcome == VALID for cell in cells)
    missing = sum(not slot.cells for _, _, slot in everything)
    head = f"{valid} of {len(cells)} cells are valid; only these are ranked."
    if missing:
        head += f" {missing} not run."
    if earlier_cells:
        head += (
            f" Left out: {counted(earlier_cells, 'cell')} of earlier runs "
            "that the last one did not ask for."
        )
    reasons = [
        f"{model.label} × {contender.label}: "
        f"{outcome_look(cell.outcome).words}"
        + (f" (seed {cell.seed})" if len(slot.cells) > 1 else "")
        + (f": {cell.reason}" if cell.reason else "")
        for model, contender, slot in everything
        for cell in slot.cells
        if cell.outcome != VALID
    ]
    notes = [head, *reasons[:_MOST_REASONS]]
    if len(reasons) > _MOST_REASONS:
        notes.append(
            f"{counted(len(reasons) - _MOST_REASONS, 'more reason')}: see "
            "table.md."
        )
    return notes
