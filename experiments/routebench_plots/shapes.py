"""Reads a layer's material and its route as the database keeps them."""

from __future__ import annotations

import json
import math
import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .errors import PlotError

Points = NDArray[np.float64]
"""Rows of x and y, mm."""


@dataclass(frozen=True)
class Stroke:
    """Material laid along a line without a stop."""

    kind: str
    width_mm: float
    points: Points


def read_multipolygon(text: str, where: str) -> list[list[Points]]:
    """The polygons of a WKT MULTIPOLYGON or POLYGON, each outer ring first.

    A third coordinate is dropped. `where` begins the message of the
    PlotError that anything else raises.
    """
    head = re.match(
        r"\s*(MULTIPOLYGON|POLYGON)\s*(Z|M|ZM)?\s*(EMPTY\s*$|\()",
        text,
        re.IGNORECASE,
    )
    if head is None:
        raise PlotError(f"{where}: not a MULTIPOLYGON: {text[:40]!r}")
    if head[3].upper().startswith("EMPTY"):
        return []
    body = text[head.end(3) - 1 :].strip()
    if head[1].upper() == "POLYGON":
        body = f"({body})"
    # Nested lists are what JSON has, too: (((1 2 3, ...)), ...).
    listed = re.sub(
        r"[^(),\[\]]+",
        lambda match: (
            f"[{','.join(match[0].split())}]" if match[0].strip() else ""
        ),
        body,
    )
    try:
        polygons = json.loads(listed.replace("(", "[").replace(")", "]"))
        return [
            [_points(ring, least=3) for ring in polygon]
            for polygon in polygons
        ]
    except (TypeError, ValueError, IndexError, RecursionError) as error:
        raise PlotError(f"{where}: broken MULTIPOLYGON: {error}") from error


def read_strokes(text: str, where: str) -> list[Stroke]:
    """The strokes of a route, in their order.

    `where` begins the message of the PlotError that broken input raises.
    """
    try:
        return [
            Stroke(
                kind=str(stroke["kind"]),
                width_mm=_width(stroke["width_mm"]),
                points=_points(stroke["points"], least=2),
            )
            for stroke in json.loads(text)
        ]
    except (TypeError, ValueError, KeyError, RecursionError) as error:
        raise PlotError(f"{where}: broken strokes: {error!r}") from error


def travels(strokes: list[Stroke], join_mm: float) -> list[Points]:
    """The moves between strokes that are longer than `join_mm`."""
    moves = []
    for before, after in zip(strokes, strokes[1:]):
        start, end = before.points[-1], after.points[0]
        if math.dist(start, end) > join_mm:
            moves.append(np.array([start, end]))
    return moves


def _points(rows: object, least: int) -> Points:
    points = np.asarray(rows, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] < 2 or len(points) < least:
        raise ValueError(f"expected at least {least} points of x and y")
    if not np.isfinite(points).all():
        raise ValueError("a coordinate is not a number")
    return points[:, :2]


def _width(value: object) -> float:
    width = float(value)  # type: ignore[arg-type]
    if not (math.isfinite(width) and width > 0):
        raise ValueError(f"width {value} is not positive")
    return width
