"""Layers and routes are read exactly, or refused."""

from __future__ import annotations

import json
import unittest

from routebench_plots.errors import PlotError
from routebench_plots.shapes import read_multipolygon, read_strokes, travels

SQUARE = "(0 0, 1 0, 1 1, 0 1, 0 0)"


class WktTest(unittest.TestCase):
    """What write_wkt writes, and what other tools write."""

    def rings(self, text: str) -> list[list[int]]:
        """Numbers of points of the rings of the polygons."""
        return [[len(r) for r in p] for p in read_multipolygon(text, "here")]

    def test_polygons_and_holes(self) -> None:
        triangle = "(2 2, 3 2, 2 3, 2 2)"
        text = f"MULTIPOLYGON (({SQUARE}, {triangle}), ({triangle}))"
        self.assertEqual(self.rings(text), [[5, 4], [4]])

    def test_z_is_dropped(self) -> None:
        text = "MULTIPOLYGON Z (((0 -1.5 7, 1e1 0 7, 0.25 1 7, 0 -1.5 7)))"
        points = read_multipolygon(text, "here")[0][0]
        self.assertEqual(
            points.tolist(), [[0, -1.5], [10, 0], [0.25, 1], [0, -1.5]]
        )

    def test_spelling(self) -> None:
        for text in (
            f"multipolygon(({SQUARE}))",
            f" POLYGON ({SQUARE}) ",
            f"POLYGON Z({SQUARE.replace(',', ' 3,').replace(')', ' 3)')})",
        ):
            self.assertEqual(self.rings(text), [[5]], text)

    def test_empty(self) -> None:
        self.assertEqual(self.rings("MULTIPOLYGON Z EMPTY"), [])

    def test_broken(self) -> None:
        for text in (
            "",
            "LINESTRING (0 0, 1 1)",
            "MULTIPOLYGON",
            f"MULTIPOLYGON (({SQUARE})",
            "MULTIPOLYGON (((0 0, 1 0)))",
            "MULTIPOLYGON (((0 0, 1, 1 1, 0 0)))",
            "MULTIPOLYGON (((0 0, nan 0, 1 1, 0 0)))",
            "MULTIPOLYGON (((0 0, x 0, 1 1, 0 0)))",
            "MULTIPOLYGON [[[0 0, 1 0, 1 1, 0 0]]]",
            "MULTIPOLYGON (" + "(" * 100000,
        ):
            with self.assertRaisesRegex(PlotError, "^here: ", msg=text[:60]):
                read_multipolygon(text, "here")


class StrokesTest(unittest.TestCase):
    """Routes as the database keeps them."""

    def test_strokes(self) -> None:
        text = json.dumps(
            [{"kind": "wall", "width_mm": 0.45, "points": [[0, 1], [2, 3]]}]
        )
        (stroke,) = read_strokes(text, "here")
        self.assertEqual(stroke.kind, "wall")
        self.assertEqual(stroke.width_mm, 0.45)
        self.assertEqual(stroke.points.tolist(), [[0, 1], [2, 3]])

    def test_broken(self) -> None:
        good = {"kind": "wall", "width_mm": 0.4, "points": [[0, 0], [1, 1]]}
        faults: tuple[dict[str, object], ...] = (
            {"points": [[0, 0]]},
            {"points": [[0, 0], [1]]},
            {"points": [[0, 0], [1, None]]},
            {"points": [[0, 0], [1, float("nan")]]},
            {"points": 3},
            {"width_mm": 0},
            {"width_mm": "wide"},
            {"width_mm": None},
        )
        for fault in faults:
            text = json.dumps([good | fault])
            with self.assertRaisesRegex(PlotError, "^here: ", msg=text):
                read_strokes(text, "here")
        for text in ("", "{", "7", "null", "[7]", '[{"kind": "wall"}]'):
            with self.assertRaisesRegex(PlotError, "^here: ", msg=text):
                read_strokes(text, "here")

    def test_travels_are_gaps_longer_than_the_join(self) -> None:
        text = json.dumps(
            [
                {"kind": "wall", "width_mm": 1, "points": points}
                for points in (
                    [[0, 0], [1, 0]],
                    [[1, 0.01], [1, 1]],
                    [[1, 1.02], [1, 2]],
                    [[5, 2], [6, 2]],
                )
            ]
        )
        moves = travels(read_strokes(text, "here"), 0.01)
        self.assertEqual(
            [move.tolist() for move in moves],
            [[[1, 1], [1, 1.02]], [[1, 2], [5, 2]]],
        )
        self.assertEqual(travels([], 0.01), [])


if __name__ == "__main__":
    unittest.main()
