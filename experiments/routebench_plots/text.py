"""Text that fits: measured, and broken into lines."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from functools import lru_cache

from matplotlib.font_manager import FontProperties
from matplotlib.textpath import text_to_path

LINE_HEIGHT = 1.25
"""Distance of base lines, and so the height of a line, in font sizes."""

POINTS_PER_INCH = 72.0

_PIECE = re.compile(r"[^/?&,;:_=\-]+[/?&,;:_=\-]*|[/?&,;:_=\-]+")


@lru_cache(maxsize=4096)
def text_width(text: str, size: float, weight: str = "normal") -> float:
    """Width in inches of one line of text in a font of `size` points."""
    font = FontProperties(weight=weight, size=size)
    points, _, _ = text_to_path.get_text_width_height_descent(
        text, font, ismath=False
    )
    return float(points) / POINTS_PER_INCH


def text_height(lines: int, size: float) -> float:
    """Height in inches of so many lines."""
    return lines * LINE_HEIGHT * size / POINTS_PER_INCH


def wrap(
    text: str, width: float, size: float, weight: str = "normal"
) -> list[str]:
    """Breaks text into lines of at most `width` inches.

    Lines break between words; a word that is longer than a line breaks
    after the punctuation of paths and parameters, or else anywhere.
    Nothing is left out.
    """

    def fits(line: str) -> bool:
        return text_width(line, size, weight) <= width

    lines = [""]
    for word in text.split():
        joined = f"{lines[-1]} {word}" if lines[-1] else word
        if fits(joined):
            lines[-1] = joined
            continue
        pieces = _pack([word], fits)
        if len(pieces) > 1:
            pieces = _pack(word_pieces(word), fits)
        if lines[-1]:
            lines.append("")
        lines[-1:] = pieces
    return lines


def word_pieces(word: str) -> list[str]:
    """The parts of a word after which a line may end."""
    return _PIECE.findall(word)


def wrapped(
    text: str, width: float, size: float, weight: str = "normal"
) -> str:
    """The lines of `wrap` as one string."""
    return "\n".join(wrap(text, width, size, weight))


def _pack(pieces: Sequence[str], fits: Callable[[str], bool]) -> list[str]:
    """Joins pieces to lines; a piece too long for one breaks anywhere."""
    lines = [""]
    for piece in pieces:
        if fits(lines[-1] + piece):
            lines[-1] += piece
        elif fits(piece):
            lines.append(piece)
        else:
            for char in piece:
                if lines[-1] and not fits(lines[-1] + char):
                    lines.append("")
                lines[-1] += char
    return lines
