"""Counts what a figure shows and what it leaves out, and says why."""

from __future__ import annotations

from collections import Counter

from .results import NOT_RUN, VALID, Slot
from .style import outcome_look


class Tally:
    """Collects the cells of a figure."""

    def __init__(self) -> None:
        self._shown = 0
        self._left_out: Counter[str] = Counter()
        self._not_run = 0

    def add(self, slot: Slot, why_absent: str | None = None) -> None:
        """Counts a slot of which a figure can only show the valid cells.

        With `why_absent` even these are left out, for that reason.
        """
        self.add_invalid(slot)
        if why_absent is None:
            self.show(len(slot.valid))
        else:
            self.leave_out(len(slot.valid), why_absent)

    def add_invalid(self, slot: Slot) -> None:
        """Counts all of a slot but its valid cells."""
        for outcome, count in slot.outcomes.items():
            if outcome == NOT_RUN:
                self._not_run += count
            elif outcome != VALID:
                self.leave_out(count, outcome_look(outcome).words)

    def show(self, cells: int) -> None:
        """Counts cells that the figure shows."""
        self._shown += cells

    def leave_out(self, cells: int, why: str) -> None:
        """Counts cells that the figure does not show."""
        if cells:
            self._left_out[why] += cells

    def sentence(self) -> str:
        """What a reader has to know before reading the figure."""
        left_out = self._left_out.total()
        words = f"{self._shown} of {self._shown + left_out} cells shown"
        if left_out:
            reasons = ", ".join(
                f"{count} {why}"
                for why, count in sorted(self._left_out.items())
            )
            words += f"; {left_out} left out: {reasons}"
        words += "."
        if self._not_run:
            words += f" {self._not_run} not run."
        return words
