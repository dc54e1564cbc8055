"""What the viewer's data loses on the way: nothing but what lies below the quantum."""

from __future__ import annotations

import base64
import json
import math
import random
import unittest
import zlib

import numpy as np
from numpy.typing import NDArray

from routebench_plots.errors import PlotError
from routebench_plots.shapes import Stroke
from routebench_report.blocks import (
    QUANTUM_MM,
    LayerPolygons,
    LayerScores,
    LayerStrokes,
    outline_block,
    packed,
    route_block,
    score_block,
)

_ROUNDING = QUANTUM_MM / 2 + 1e-9


class Reader:
    """Reads a block as its description says, apart from how it is written."""

    def __init__(self, block: bytes) -> None:
        self.block = block
        self.at = 0

    def integers(self, count: int) -> list[int]:
        return [
            int.from_bytes(self.take(4), "little", signed=True)
            for _ in range(count)
        ]

    def coordinates(self, count: int) -> list[float]:
        planes = [self.take(count) for _ in range(4)]
        values = []
        total = 0
        for four in zip(*planes):
            total += int.from_bytes(bytes(four), "little", signed=True)
            values.append(total * QUANTUM_MM)
        return values

    def take(self, count: int) -> bytes:
        piece = self.block[self.at : self.at + count]
        assert len(piece) == count
        self.at += count
        return piece


def random_points(rng: random.Random, count: int) -> NDArray[np.float64]:
    """Points on a bed, some of them far from the one before."""
    return np.array(
        [[rng.uniform(-250, 250), rng.uniform(-250, 250)] for _ in range(count)]
    )


class RouteBlockTest(unittest.TestCase):
    """Routes there and back."""

    def check(self, layers: list[LayerStrokes]) -> None:
        reader = Reader(route_block(layers))
        count, strokes, points, names = reader.integers(4)
        self.assertEqual(reader.integers(count), [layer.index for layer in layers])
        for found, layer in zip(reader.integers(count), layers):
            self.assertAlmostEqual(found * QUANTUM_MM, layer.z_mm, delta=_ROUNDING)
        self.assertEqual(
            reader.integers(count), [len(layer.strokes) for layer in layers]
        )
        flat = [stroke for layer in layers for stroke in layer.strokes]
        self.assertEqual(strokes, len(flat))
        self.assertEqual(
            reader.integers(strokes), [len(stroke.points) for stroke in flat]
        )
        for found, stroke in zip(reader.integers(strokes), flat):
            self.assertAlmostEqual(
                found * QUANTUM_MM, stroke.width_mm, delta=_ROUNDING
            )
        kinds = reader.integers(strokes)
        for axis in (0, 1):
            wanted = [p[axis] for stroke in flat for p in stroke.points]
            found_axis = reader.coordinates(points)
            self.assertEqual(len(found_axis), len(wanted))
            # Rounding never adds up along a route.
            for one, other in zip(found_axis, wanted):
                self.assertAlmostEqual(one, other, delta=_ROUNDING)
        known = json.loads(reader.take(names))
        self.assertEqual(
            [known[kind] for kind in kinds], [stroke.kind for stroke in flat]
        )
        self.assertEqual(len(reader.block) % 4, 0)
        self.assertLess(len(reader.block) - reader.at, 4)

    def test_random_routes(self) -> None:
        rng = random.Random(7)
        for _ in range(30):
            layers = []
            for index in sorted(rng.sample(range(500), rng.randint(1, 6))):
                strokes = [
                    Stroke(
                        rng.choice(["wall", "dense", "sparse", "Ümlaut <b>"]),
                        rng.uniform(0.05, 2),
                        random_points(rng, rng.randint(2, 40)),
                    )
                    for _ in range(rng.randint(0, 8))
                ]
                layers.append(LayerStrokes(index, 0.1 + 0.2 * index, strokes))
            self.check(layers)

    def test_nothing_at_all(self) -> None:
        self.check([])
        self.check([LayerStrokes(3, 0.7, [])])

    def test_ends_of_the_range(self) -> None:
        far = np.array([[-1e5, 1e5], [1e5, -1e5], [0.00004, -0.00006]])
        self.check([LayerStrokes(0, 0.1, [Stroke("wall", 0.45, far)])])

    def test_refuses_what_does_not_fit(self) -> None:
        far = np.array([[0.0, 0.0], [2e5, 0.0]])
        with self.assertRaisesRegex(PlotError, "too far for the route viewer"):
            route_block([LayerStrokes(0, 0.1, [Stroke("wall", 0.45, far)])])
        with self.assertRaises(PlotError):
            route_block(
                [LayerStrokes(0, math.nan, [Stroke("wall", 0.45, far / 1e5)])]
            )


class OtherBlocksTest(unittest.TestCase):
    """Outlines and scores there and back."""

    def test_outlines(self) -> None:
        rng = random.Random(8)
        layers = [
            LayerPolygons(
                index,
                0.2 * index,
                [
                    [random_points(rng, rng.randint(3, 9)) for _ in range(rings)]
                    for rings in (1, 3)
                ],
            )
            for index in (0, 4, 5)
        ]
        layers.append(LayerPolygons(9, 2.0, []))
        reader = Reader(outline_block(layers))
        count, rings, points = reader.integers(3)
        self.assertEqual(reader.integers(count), [0, 4, 5, 9])
        reader.integers(count)
        self.assertEqual(reader.integers(count), [4, 4, 4, 0])
        flat = [r for layer in layers for polygon in layer.polygons for r in polygon]
        self.assertEqual(reader.integers(rings), [len(ring) for ring in flat])
        everything = np.concatenate(flat)
        for axis in (0, 1):
            error = np.abs(np.array(reader.coordinates(points)) - everything[:, axis])
            self.assertLessEqual(error.max(), _ROUNDING)

    def test_scores(self) -> None:
        layers = [
            LayerScores(2, 0.5, [1.25, math.nan, -3e9]),
            LayerScores(7, 1.5, [0.0, 1e-9, math.nan]),
        ]
        reader = Reader(score_block(layers, 3))
        self.assertEqual(reader.integers(2), [2, 3])
        self.assertEqual(reader.integers(2), [2, 7])
        reader.integers(2)
        found = np.frombuffer(reader.take(24), "<f4").reshape(3, 2)
        wanted = np.array([layer.values for layer in layers], "f4").T
        np.testing.assert_array_equal(found, wanted)

    def test_packing_is_zlib_and_base64(self) -> None:
        block = bytes(range(256)) * 9
        self.assertEqual(zlib.decompress(base64.b64decode(packed(block))), block)


if __name__ == "__main__":
    unittest.main()
