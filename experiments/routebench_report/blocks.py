"""Blocks: routes, outlines and scores as bytes that a browser reads at once.

A block is a row of little-endian 32-bit numbers: first how many of what
there are, then one array after the other. Coordinates are whole multiples
of the quantum. Only their differences are kept, and of these first all
lowest bytes, then all second ones and so on: that packs to a quarter.
`web/blocks.js` reads what is written here.
"""

from __future__ import annotations

import base64
import json
import zlib
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from routebench_plots.errors import PlotError
from routebench_plots.shapes import Points, Stroke

QUANTUM_MM = 0.0001
"""What coordinates, heights and widths are whole multiples of."""

_FARTHEST_MM = (2**31 - 1) * QUANTUM_MM / 2
"""Differences of coordinates up to this fit into a number of a block."""


class TooFarError(PlotError):
    """A length that does not fit into a block."""


@dataclass(frozen=True)
class LayerStrokes:
    """The route of a layer."""

    index: int
    z_mm: float
    strokes: Sequence[Stroke]


@dataclass(frozen=True)
class LayerPolygons:
    """The material of a layer; each polygon's outer ring comes first."""

    index: int
    z_mm: float
    polygons: Sequence[Sequence[Points]]


@dataclass(frozen=True)
class LayerScores:
    """The metrics of a layer, NaN where one does not apply."""

    index: int
    z_mm: float
    values: Sequence[float]


def route_block(layers: Sequence[LayerStrokes]) -> bytes:
    """Routes of a cell's layers, lowest first.

    Counts: layers, strokes, points, bytes of the names of kinds. Arrays:
    layer indices, heights, strokes per layer, points per stroke, width and
    kind of each stroke, x, y, names of kinds as JSON.
    """
    strokes = [stroke for layer in layers for stroke in layer.strokes]
    kinds = sorted({stroke.kind for stroke in strokes})
    number = {kind: place for place, kind in enumerate(kinds)}
    names = json.dumps(kinds).encode()
    x, y = _coordinates([stroke.points for stroke in strokes])
    return _joined(
        [len(layers), len(strokes), x.size, len(names)],
        [layer.index for layer in layers],
        _quantised([layer.z_mm for layer in layers]),
        [len(layer.strokes) for layer in layers],
        [len(stroke.points) for stroke in strokes],
        _quantised([stroke.width_mm for stroke in strokes]),
        [number[stroke.kind] for stroke in strokes],
        _planes(x),
        _planes(y),
        names,
    )


def outline_block(layers: Sequence[LayerPolygons]) -> bytes:
    """The outlines of a model's layers, lowest first.

    Counts: layers, rings, points. Arrays: layer indices, heights, rings per
    layer, points per ring, x, y. By the even-odd rule inside is material.
    """
    rings = [
        [ring for polygon in layer.polygons for ring in polygon]
        for layer in layers
    ]
    flat = [ring for own in rings for ring in own]
    x, y = _coordinates(flat)
    return _joined(
        [len(layers), len(flat), x.size],
        [layer.index for layer in layers],
        _quantised([layer.z_mm for layer in layers]),
        [len(own) for own in rings],
        [len(ring) for ring in flat],
        _planes(x),
        _planes(y),
    )


def score_block(layers: Sequence[LayerScores], metrics: int) -> bytes:
    """The scores of a cell's layers, lowest first.

    Counts: layers, metrics. Arrays: layer indices, heights, then for each
    metric 32-bit floats, one a layer.
    """
    values = np.array([layer.values for layer in layers], dtype="<f4")
    return _joined(
        [len(layers), metrics],
        [layer.index for layer in layers],
        _quantised([layer.z_mm for layer in layers]),
        values.reshape(len(layers), metrics).T.tobytes(),
    )


def packed(block: bytes) -> str:
    """A block as text for a page: zlib, then base64."""
    return base64.b64encode(zlib.compress(block, 6)).decode("ascii")


def _joined(*parts: Sequence[int] | NDArray[np.int64] | bytes) -> bytes:
    pieces = []
    for part in parts:
        if isinstance(part, bytes):
            pieces.append(part + b"\0" * (-len(part) % 4))
        else:
            pieces.append(np.asarray(part, dtype="<i4").tobytes())
    return b"".join(pieces)


def _quantised(lengths_mm: Sequence[float] | Points) -> NDArray[np.int64]:
    values = np.asarray(lengths_mm, dtype=np.float64)
    if values.size and not np.abs(values).max() <= _FARTHEST_MM:
        raise TooFarError(
            f"a length or coordinate is beyond {_FARTHEST_MM / 1e3:.0f} m: "
            "too far for the route viewer"
        )
    return np.rint(values / QUANTUM_MM).astype(np.int64)


def _coordinates(
    lines: Sequence[Points],
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """All x, then all y."""
    points = np.concatenate(lines) if lines else np.empty((0, 2))
    quantised = _quantised(points)
    return quantised[:, 0], quantised[:, 1]


def _planes(values: NDArray[np.int64]) -> bytes:
    """Differences, the lowest bytes of all of them first."""
    differences = np.diff(values, prepend=0).astype("<i4")
    return differences.view(np.uint8).reshape(-1, 4).T.tobytes()
