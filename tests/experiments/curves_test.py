"""Curves are the layers' scores over z."""

from __future__ import annotations

import math
import unittest
from collections.abc import Sequence

from matplotlib.axes import Axes

from routebench_plots import curves
from routebench_plots.sheet import Sheet
from support import PlotTestCase, note, visible_axes
from synthetic import Database


def curve(axes: Axes, place: int = 0) -> tuple[list[float], list[float]]:
    """Heights and values of a curve."""
    line = [ln for ln in axes.lines if ln.get_marker() != "None"][place]
    return list(line.get_xdata()), list(line.get_ydata())


class CurvesTest(PlotTestCase):
    """One model's figure."""

    def setUp(self) -> None:
        super().setUp()
        self.made = Database(self.folder / "r.sqlite")
        self.setting = self.made.setting()
        self.model = self.made.model("m")

    def cell(
        self,
        name: str,
        travel: Sequence[float | None],
        repaired: Sequence[int] = (),
        outcome: str = "valid",
    ) -> None:
        """A contender with these layers."""
        cell = self.made.cell(
            self.model,
            self.made.contender(name),
            self.setting,
            outcome=outcome,
        )
        rows = [{"travel_mm": t, "retractions": 0.0} for t in travel]
        self.made.layers(cell, rows, repaired)

    def draw(self) -> Sheet:
        """Travel above retractions."""
        results = self.open(self.made.close())
        return curves.draw(
            results,
            results.settings[0],
            results.models[0],
            [self.metric(results, n) for n in ("travel_mm", "retractions")],
            "Title",
        )

    def test_points_are_layers(self) -> None:
        self.cell("a", [3.0, 0.0, 4.0])
        travel, retractions = visible_axes(self.draw())
        heights, values = curve(travel)
        self.assertEqual([round(z, 6) for z in heights], [0.1, 0.3, 0.5])
        self.assertEqual(values, [3, 0, 4])
        self.assertEqual(curve(retractions)[1], [0, 0, 0])
        low, high = retractions.get_ylim()
        self.assertTrue(low < 0 < high, "the line of zeros must be seen")
        self.assertEqual(
            " ".join(travel.get_ylabel().split()),
            "Travel per layer [mm] (lower is better)",
        )

    def test_absent_layers_are_gaps(self) -> None:
        self.cell("a", [3.0, None, 4.0])
        values = curve(visible_axes(self.draw())[0])[1]
        self.assertTrue(math.isnan(values[1]))
        self.assertEqual([values[0], values[2]], [3, 4])

    def test_one_layer_is_a_marker(self) -> None:
        self.cell("a", [3.0])
        sheet = self.draw()
        self.assertEqual(curve(visible_axes(sheet)[0])[1], [3])
        self.assert_laid_out(sheet)

    def test_invalid_cells_are_left_out_by_name(self) -> None:
        self.cell("a", [3.0, 4.0])
        self.cell("b", [1.0, 1.0], outcome="off_task")
        sheet = self.draw()
        travel = visible_axes(sheet)[0]
        self.assertEqual(curve(travel)[1], [3, 4])
        self.assertEqual(len(travel.lines), 1)
        self.assertIn(
            "1 of 2 cells shown; 1 left out: 1 off task", note(sheet)
        )
        labels = [t.get_text() for t in sheet.figure.legends[0].get_texts()]
        self.assertEqual(labels, ["a"])

    def test_repaired_layers_are_marked(self) -> None:
        self.cell("a", [3.0, 4.0, 5.0], repaired=[1])
        sheet = self.draw()
        self.assertIn("1 layer repaired before planning: shaded", note(sheet))
        marks = [
            ln
            for ln in visible_axes(sheet)[0].lines
            if len(set(ln.get_xdata())) == 1
        ]
        self.assertAlmostEqual(marks[0].get_xdata()[0], 0.3)

    def test_nothing_valid(self) -> None:
        self.cell("a", [], outcome="crashed")
        sheet = self.draw()
        self.assertIn("0 of 1 cells shown", note(sheet))
        self.assert_laid_out(sheet)

    def test_the_layouts_last_bits_are_rounded_away(self) -> None:
        """They differ from run to run, and with them the files' bytes."""
        self.cell("a", [3.0, 4.0])
        sheet = self.draw()
        sheet.save(self.folder, "x", ["svg"])
        for axes in visible_axes(sheet):
            for number in axes.get_position(original=True).extents:
                self.assertEqual(number, round(number, 6))

    def test_further_seeds_are_counted(self) -> None:
        contender = self.made.contender("a")
        for seed, travel in ((1, 5.0), (2, 6.0)):
            cell = self.made.cell(
                self.model, contender, self.setting, seed=seed
            )
            self.made.layers(cell, [{"travel_mm": travel}])
        sheet = self.draw()
        self.assertEqual(curve(visible_axes(sheet)[0])[1], [5])
        self.assertIn("1 further seeds", note(sheet))


if __name__ == "__main__":
    unittest.main()
