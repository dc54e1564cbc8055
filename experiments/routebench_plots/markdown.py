"""Markdown without surprises: any text, and rows of tables."""

from __future__ import annotations

import re
from collections.abc import Sequence


def markdown_text(text: str) -> str:
    """Text in which no character is markup, on one line."""
    return re.sub(r"([\\`*_{}\[\]<>#|~])", r"\\\1", " ".join(text.split()))


def markdown_row(cells: Sequence[str]) -> str:
    """A row of a table, of cells that are Markdown already."""
    return f"| {' | '.join(cells)} |"


def markdown_table(heads: Sequence[str], rows: Sequence[Sequence[str]], left: int = 1) -> list[str]:
    """The lines of a table; the first `left` columns are set left, the others right.

    Heads and cells are Markdown already.
    """
    marks = [":--" if place < left else "--:" for place in range(len(heads))]
    return [markdown_row(cells) for cells in (heads, marks, *rows)]
