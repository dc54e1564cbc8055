"""The first figure: how every cell ended, so that nothing is hidden."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.patches import Rectangle

from .matrix import draw_matrix
from .quantities import counted
from .results import NOT_RUN, VALID, Item, Results, Slot
from .sheet import Sheet
from .style import OUTCOME_ORDER, outcome_look

_MOST_REASONS = 12


def draw(
    results: Results, setting: Item, models: Sequence[Item], title: str
) -> Sheet:
    """Models down, contenders across; a colour and a word in each place."""
    contenders = results.contenders
    slots = [
        [results.slot(setting, model, contender) for contender in contenders]
        for model in models
    ]

    def fill(axes: Axes, place: Rectangle, row: int, column: int) -> str:
        return fill_outcome(axes, place, slots[row][column])

    return draw_matrix(
        models,
        contenders,
        lambda row, column: outcome_words(slots[row][column]),
        fill,
        title,
        _notes(slots, models, contenders, results.earlier_cells),
    )


def outcome_words(slot: Slot) -> list[str]:
    """A line for each outcome of a slot, the gravest first."""
    counts = slot.outcomes
    several = counts.total() > 1
    return [
        outcome_look(outcome).words
        + (f" ×{counts[outcome]}" if several else "")
        for outcome in _by_weight(slot)
    ]


def fill_outcome(axes: Axes, place: Rectangle, slot: Slot) -> str:
    """Draws a slot's place in its outcome's colour; returns that of words on it."""
    gravest = _by_weight(slot)[0]
    look = outcome_look(gravest)
    place.set(facecolor=look.background)
    if gravest == NOT_RUN:
        place.set(edgecolor="#C8C8C8", linewidth=0.5, linestyle=(0, (3, 2)))
    axes.add_patch(place)
    if look.hatch:
        # In a patch of its own, for a hatch has the colour of the edge.
        axes.add_patch(
            Rectangle(
                place.get_xy(),
                place.get_width(),
                place.get_height(),
                facecolor="none",
                edgecolor="#C8C8C8",
                hatch=look.hatch,
                linewidth=0,
            )
        )
    return look.ink


def _by_weight(slot: Slot) -> list[str]:
    """The slot's outcomes, the gravest first."""
    order = {outcome: place for place, outcome in enumerate(OUTCOME_ORDER)}
    return sorted(slot.outcomes, key=lambda o: (-order.get(o, len(order)), o))


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
