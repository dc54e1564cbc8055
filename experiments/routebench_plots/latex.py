"""LaTeX without surprises: any text, as a table has it."""

from __future__ import annotations

from .quantities import THIN_SPACE
from .text import word_pieces

_LATEX = {
    "\\": r"\textbackslash{}",
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
    "|": r"\textbar{}",
    "µ": r"$\mu$",
    "²": "$^2$",
    "³": "$^3$",
    "×": r"$\times$",
    "↓": r"$\downarrow$",
    "↑": r"$\uparrow$",
    "–": "--",
    "\u2212": "$-$",
    THIN_SPACE: r"\,",
    **{char: f"\\{char}" for char in "&%$#_{}"},
}


def latex_text(text: str) -> str:
    """Text in which no character is a command."""
    return "".join(_LATEX.get(char, char) for char in text)


def latex_name(text: str) -> str:
    """A name that may break after the punctuation of paths."""
    return r"\allowbreak{}".join(latex_text(piece) for piece in word_pieces(text))
