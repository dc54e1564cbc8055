"""How figures look: one place for fonts, colours, hatches and markers."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import matplotlib

from .results import Item

DPI = 200
PAGE_WIDTH = 7.2
"""Inches; two columns of a journal."""
PAGE_HEIGHT = 9.0
"""Inches that the panels of one figure fill at most, if they can."""

TITLE_SIZE = 9.0
TEXT_SIZE = 7.5
SMALL_SIZE = 6.5

RC: dict[str, object] = {
    "font.family": "DejaVu Sans",
    "font.size": TEXT_SIZE,
    "axes.titlesize": TEXT_SIZE,
    "axes.labelsize": TEXT_SIZE,
    "xtick.labelsize": SMALL_SIZE,
    "ytick.labelsize": SMALL_SIZE,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "grid.color": "#e2e2e2",
    "grid.linewidth": 0.5,
    "hatch.linewidth": 0.4,
    "lines.linewidth": 1.0,
    "legend.frameon": False,
    "legend.fontsize": TEXT_SIZE,
    # Names may hold a dollar sign without being formulas.
    "text.parse_math": False,
    # The same input makes the same bytes.
    "svg.hashsalt": "routebench",
    "pdf.fonttype": 42,
    # Routes of many thousand points would overflow the renderer's cells.
    "agg.path.chunksize": 20000,
}

# Okabe and Ito's colours, which differ for colour-blind eyes too; yellow is
# too faint for lines, and vermillion means travel in the route pictures.
_COLOURS = (
    "#0072B2",
    "#E69F00",
    "#009E73",
    "#CC79A7",
    "#56B4E9",
    "#8C510A",
    "#4D4D4D",
)
_HATCHES = ("", "////", "....", "xxxx", "----", "\\\\\\\\", "||||", "++++")
_MARKERS = ("o", "s", "^", "D", "v", "P", "X", "<", ">", "p")
_DASHES: tuple[tuple[float, ...], ...] = (
    (),
    (4, 1.5),
    (1, 1),
    (5, 1, 1, 1),
    (7, 2, 2, 2),
)

TRAVEL_COLOUR = "#D55E00"
MATERIAL_COLOUR = "#EBEBEB"
STROKE_COLOURS = {"wall": "#0072B2", "dense": "#333333", "sparse": "#009E73"}
OTHER_STROKE_COLOUR = "#CC79A7"

MUTED = "#5A5A5A"
ABSENT = "n/a"


@dataclass(frozen=True)
class Look:
    """How a contender looks in every figure; unlike every other one."""

    colour: str
    hatch: str
    marker: str
    dashes: tuple[float, ...]


@dataclass(frozen=True)
class OutcomeLook:
    """How an outcome is written and coloured."""

    words: str
    background: str
    ink: str


_OUTCOMES = {
    "valid": OutcomeLook("valid", "#CDE7DF", "#000000"),
    "off_task": OutcomeLook("off task", "#F7DD9C", "#000000"),
    "failed": OutcomeLook("failed", "#F2B38C", "#000000"),
    "crashed": OutcomeLook("crashed", "#B5450C", "#FFFFFF"),
    "timed_out": OutcomeLook("timed out", "#BFB3DC", "#000000"),
    "out_of_memory": OutcomeLook("out of memory", "#5E4B9A", "#FFFFFF"),
    "not_installed": OutcomeLook("not installed", "#E8E8E8", "#000000"),
    "not_run": OutcomeLook("not run", "#FFFFFF", MUTED),
}
OUTCOME_ORDER = tuple(_OUTCOMES)


@contextmanager
def applied() -> Iterator[None]:
    """In here figures look as RC says, whatever the user's settings say."""
    with warnings.catch_warnings(), matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(RC)
        # A name in a script that the font lacks is no error.
        warnings.filterwarnings("ignore", message="Glyph .* missing")
        yield


def outcome_look(outcome: str) -> OutcomeLook:
    """The look of an outcome; grey for one that is not known here."""
    unknown = OutcomeLook(outcome.replace("_", " "), "#D0D0D0", "#000000")
    return _OUTCOMES.get(outcome, unknown)


def looks(contenders: Sequence[Item]) -> dict[int, Look]:
    """A look for each contender by its place among the sorted names.

    The lists have lengths without a common factor, so that colour and
    hatch, marker or dashes together repeat late.
    """
    return {
        item.row_id: Look(
            colour=_COLOURS[place % len(_COLOURS)],
            hatch=_HATCHES[place % len(_HATCHES)],
            marker=_MARKERS[place % len(_MARKERS)],
            dashes=_DASHES[place % len(_DASHES)],
        )
        for place, item in enumerate(contenders)
    }
