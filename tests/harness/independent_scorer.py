"""Scores a file of G-code, written without a look at routebench's own reader and judge.

    independent_scorer.py FILE [--filament MM] [--retract-over MM]

Prints a JSON object: the extruded length, travel between strokes, strokes,
travels of at least --retract-over, times that filament was really pulled
back, and the volume of the filament that was pushed while moving. It knows
absolute coordinates and both ways to count E, which is all that PrusaSlicer,
Slic3r and CuraEngine need; what it does not know it refuses.
"""

from __future__ import annotations

import argparse
import json
import math
import re
from collections.abc import Iterator
from pathlib import Path

JOIN_MM = 0.01
"""Strokes that are no further apart are one."""

_WORD = re.compile(r"([A-Z])\s*(-?[0-9.]+)")
_IGNORED = frozenset({21, 90, 28, 4})


def commands(text: str) -> Iterator[tuple[str, dict[str, float]]]:
    """Every command with its words."""
    for line in text.splitlines():
        code = line.split(";")[0].strip().upper()
        words = _WORD.findall(code)
        if words:
            (letter, number), *rest = words
            yield f"{letter}{int(float(number))}", {k: float(v) for k, v in rest}


def score(text: str, filament_mm: float, retract_over_mm: float) -> dict[str, float]:
    """All figures of one file."""
    x = y = z = e = 0.0
    relative_e = False
    pulls = 0
    pull_open = False  # filament has been pulled back since the last bead
    filament = extruded = travel = 0.0
    strokes = long_travels = 0
    last: tuple[float, float, float] | None = None  # where the last bead ended

    for name, words in commands(text):
        if name == "M82":
            relative_e = False
        elif name == "M83":
            relative_e = True
        elif name == "G92":
            e = words.get("E", e)
            if set(words) & {"X", "Y", "Z"}:
                raise SystemExit("G92 of an axis: unknown here")
        elif name in ("G0", "G1"):
            to_x, to_y, to_z = words.get("X", x), words.get("Y", y), words.get("Z", z)
            push = 0.0
            if "E" in words:
                push = words["E"] if relative_e else words["E"] - e
                e = words["E"]
            length = math.hypot(to_x - x, to_y - y)
            if push > 0 and length > 0:
                gap = 0.0
                if last is not None:
                    gap = math.hypot(x - last[0], y - last[1])
                    if gap > JOIN_MM or z != last[2]:
                        travel += gap
                if last is None or gap > JOIN_MM or z != last[2]:
                    strokes += 1
                if last is not None and gap >= retract_over_mm:
                    long_travels += 1
                if pull_open and last is not None:
                    pulls += 1
                pull_open = False
                extruded += length
                filament += push
                last = (to_x, to_y, to_z)
            elif push < 0:
                pull_open = True
            x, y, z = to_x, to_y, to_z
        elif name[0] == "G" and int(name[1:]) not in _IGNORED:
            raise SystemExit(f"{name}: unknown here")
    return {
        "extrude_mm": extruded,
        "travel_mm": travel,
        "strokes": strokes,
        "retractions": long_travels,
        "file_retractions": pulls,
        "filament_mm3": filament * math.pi / 4 * filament_mm**2,
    }


def main() -> None:
    """Reads the arguments, prints the figures."""
    parser = argparse.ArgumentParser()
    parser.add_argument("file", type=Path)
    parser.add_argument("--filament", type=float, default=1.75)
    parser.add_argument("--retract-over", type=float, default=2.0)
    given = parser.parse_args()
    text = given.file.read_text(encoding="utf-8", errors="replace")
    print(json.dumps(score(text, given.filament, given.retract_over), indent=1))


if __name__ == "__main__":
    main()
