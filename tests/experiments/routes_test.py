"""Pictures of routes show the strokes, the travels and the two ends."""

from __future__ import annotations

import math
import unittest
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection

from routebench_plots import routes
from routebench_plots.errors import PlotError
from routebench_plots.sheet import Sheet
from routebench_plots.style import STROKE_COLOURS, TRAVEL_COLOUR
from support import PlotTestCase, note, visible_axes, words
from synthetic import Database, plate_strokes

SQUARE = "MULTIPOLYGON Z (((0 0 1, 10 0 1, 10 10 1, 0 10 1, 0 0 1)))"
STROKES: list[dict[str, Any]] = [
    {"kind": "wall", "width_mm": 0.4, "points": [[0, 0], [10, 0], [0, 0]]},
    {"kind": "sparse", "width_mm": 0.4, "points": [[0, 0.005], [0, 5]]},
    {"kind": "dense", "width_mm": 0.4, "points": [[4, 5], [8, 9]]},
]


def collection(axes: Axes, label: str) -> LineCollection:
    """Strokes of a kind, or the travels."""
    return next(c for c in axes.collections if c.get_label() == label)


def marker(axes: Axes, shape: str) -> tuple[float, float]:
    """Where a route's end stands."""
    line = next(ln for ln in axes.lines if ln.get_marker() == shape)
    return float(line.get_xdata()[0]), float(line.get_ydata()[0])


class RoutesTest(PlotTestCase):
    """The figure of one layer."""

    def setUp(self) -> None:
        super().setUp()
        self.made = Database(self.folder / "r.sqlite")
        self.setting = self.made.setting()
        self.model = self.made.model("m")

    def cell(self, name: str, strokes: object, outcome: str = "valid") -> None:
        """A contender with this route in layer 0; None without."""
        cell = self.made.cell(
            self.model,
            self.made.contender(name),
            self.setting,
            outcome=outcome,
        )
        if strokes is not None:
            scores: dict[str, float | None]
            scores = {"travel_mm": 4.25, "retractions": 0.0}
            self.made.layers(cell, [scores])
            self.made.route(cell, 0, strokes)

    def draw(self, wkt: str = SQUARE) -> Sheet:
        """All contenders' layer 0."""
        self.made.shape(self.model, 0, wkt)
        results = self.open(self.made.close())
        return routes.draw(
            results, results.settings[0], results.models[0], 0, "Title"
        )

    def panels(self, sheet: Sheet) -> list[Axes]:
        """All axes but that of the scale bar."""
        return visible_axes(sheet)[:-1]

    def test_strokes_travels_and_ends(self) -> None:
        self.cell("a", STROKES)
        sheet = self.draw()
        axes = self.panels(sheet)[0]
        for kind, colour in STROKE_COLOURS.items():
            drawn = collection(axes, kind)
            wanted = next(s for s in STROKES if s["kind"] == kind)
            np.testing.assert_array_equal(
                drawn.get_segments()[0], wanted["points"]
            )
            self.assertEqual(
                tuple(drawn.get_color()[0]),
                tuple(LineCollection([], colors=colour).get_color()[0]),
            )
        # The gap of 5 um is joined, not travelled.
        moves = collection(axes, "travel").get_segments()
        self.assertEqual([m.tolist() for m in moves], [[[0, 5], [4, 5]]])
        self.assertEqual(marker(axes, "o"), (0, 0))
        self.assertEqual(marker(axes, "s"), (8, 9))
        self.assertIn("travel 4.25 mm, retractions 0", words(sheet))
        self.assertEqual(TRAVEL_COLOUR, "#D55E00")

    def test_material_has_its_holes(self) -> None:
        self.cell("a", STROKES)
        with_hole = (
            "MULTIPOLYGON Z (((0 0 1, 9 0 1, 9 9 1, 0 9 1, 0 0 1), "
            "(3 3 1, 3 6 1, 6 6 1, 6 3 1, 3 3 1)))"
        )
        axes = self.panels(self.draw(with_hole))[0]
        path = axes.patches[0].get_path()
        self.assertEqual(len(path.to_polygons(closed_only=True)), 2)

    def test_all_panels_have_one_scale(self) -> None:
        for name in "abcde":
            self.cell(name, STROKES)
        sheet = self.draw()
        scales = set()
        for axes in self.panels(sheet):
            box = axes.get_window_extent()
            low, high = axes.get_xlim()
            bottom, top = axes.get_ylim()
            scales.add(round(box.width / (high - low), 6))
            scales.add(round(box.height / (top - bottom), 6))
            self.assertTrue(low <= 0 and high >= 10)
            self.assertTrue(bottom <= 0 and top >= 10)
        self.assertEqual(len(scales), 1)
        self.assert_laid_out(sheet)

    def test_four_panels_stand_two_by_two(self) -> None:
        for name in "abcd":
            self.cell(name, STROKES)
        corners = [a.get_window_extent().p0 for a in self.panels(self.draw())]
        self.assertEqual(len({round(x) for x, _ in corners}), 2)
        self.assertEqual(len({round(y) for _, y in corners}), 2)

    def test_scale_bar_is_true(self) -> None:
        self.cell("a", STROKES)
        sheet = self.draw()
        bar = visible_axes(sheet)[-1]
        left, right = bar.lines[0].get_xdata()
        length = float(bar.texts[0].get_text().split()[0])
        panel = self.panels(sheet)[0]
        low, high = panel.get_xlim()
        inches = panel.get_window_extent().width / sheet.figure.dpi
        self.assertAlmostEqual(right - left, length * inches / (high - low))

    def test_outcomes_are_named(self) -> None:
        self.cell("a", STROKES)
        self.cell("b", STROKES, outcome="off_task")
        self.cell("c", None, outcome="timed_out")
        sheet = self.draw()
        self.assertIn("no route timed out", words(sheet))
        self.assertIn("off task", words(sheet))
        self.assertIn("2 of 3 cells shown; 1 left out", note(sheet))
        self.assertEqual(len(self.panels(sheet)[2].collections), 0)
        self.assertEqual(len(self.panels(sheet)[2].patches), 1)

    def test_empty_layer_and_empty_route(self) -> None:
        self.cell("a", [])
        sheet = self.draw("MULTIPOLYGON Z EMPTY")
        self.assertEqual(self.panels(sheet)[0].patches[:], [])
        self.assert_laid_out(sheet)

    def test_strays_do_not_shrink_the_part(self) -> None:
        far = {"kind": "wall", "width_mm": 0.4, "points": [[5, 5], [9e4, 0]]}
        self.cell("a", [far])
        sheet = self.draw()
        low, high = self.panels(sheet)[0].get_xlim()
        self.assertLess(high - low, 40)
        self.assertIn("1 stroke partly out of the picture", note(sheet))

    def test_flat_and_tall_layers_fit(self) -> None:
        for name in "abc":
            self.cell(name, STROKES[:0])
        tall = "MULTIPOLYGON Z (((0 0 1, 1 0 1, 1 900 1, 0 900 1, 0 0 1)))"
        sheet = self.draw(tall)
        self.assertLess(sheet.height, 12)
        self.assert_laid_out(sheet)

    def test_large_routes_are_pixels_in_vector_files(self) -> None:
        points = [
            [5 + 4 * math.cos(t / 50), 5 + 4 * math.sin(t / 77)]
            for t in range(30000)
        ]
        self.cell("a", [{"kind": "wall", "width_mm": 0.4, "points": points}])
        self.cell("b", STROKES)
        sheet = self.draw()
        large, small = self.panels(sheet)
        self.assertTrue(collection(large, "wall").get_rasterized())
        self.assertFalse(collection(small, "wall").get_rasterized())
        sheet.save(self.folder, "x", ["svg"])
        self.assertLess((self.folder / "x.svg").stat().st_size, 2_000_000)

    def test_broken_routes_are_refused_by_place(self) -> None:
        self.cell("a", [{"kind": "wall", "width_mm": 0.4, "points": [[1]]}])
        with self.assertRaisesRegex(PlotError, "cell 1, layer 0: broken"):
            self.draw()

    def test_unknown_kinds_are_drawn(self) -> None:
        brim = {"kind": "brim", "width_mm": 0.4, "points": [[1, 1], [2, 2]]}
        self.cell("a", [brim])
        sheet = self.draw()
        self.assertIn("brim strokes", words(sheet))
        self.assertEqual(
            len(collection(self.panels(sheet)[0], "brim").get_segments()), 1
        )

    def test_a_whole_plate(self) -> None:
        strokes = plate_strokes(1)
        self.cell("a", strokes)
        axes = self.panels(self.draw())[0]
        drawn = sum(
            len(collection(axes, kind).get_segments())
            for kind in STROKE_COLOURS
        )
        self.assertEqual(drawn, len(strokes))


if __name__ == "__main__":
    unittest.main()
