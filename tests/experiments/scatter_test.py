"""Travel against planning time shows every valid cell once."""

from __future__ import annotations

import unittest

from routebench_plots import scatter
from routebench_plots.sheet import Sheet
from support import PlotTestCase, note, visible_axes
from synthetic import Database

Point = tuple[float, float]


class ScatterTest(PlotTestCase):
    """One figure."""

    def draw(self, cells: dict[tuple[str, str], Point | None]) -> Sheet:
        """Cells by model and contender: CPU time and travel, None: failed."""
        made = Database(self.folder / "r.sqlite")
        setting = made.setting()
        models = {m: made.model(m) for m in sorted({m for m, _ in cells})}
        names = sorted({c for _, c in cells})
        contenders = {c: made.contender(c) for c in names}
        for (model, contender), point in cells.items():
            made.cell(
                models[model],
                contenders[contender],
                setting,
                None
                if point is None
                else {"plan_cpu_ns": point[0], "travel_mm": point[1]},
                "valid" if point else "failed",
            )
        results = self.open(made.close())
        return scatter.draw(
            results,
            results.settings[0],
            self.metric(results, "plan_cpu_ns"),
            self.metric(results, "travel_mm"),
            "Title",
        )

    def points(self, sheet: Sheet, large: bool) -> list[list[Point]]:
        """What the markers of a size stand at, contender by contender."""
        axes = visible_axes(sheet)[0]
        return [
            list(zip(*line.get_data()))
            for line in axes.lines
            if (line.get_markersize() > 5) == large
        ]

    def test_markers_are_cells_and_medians(self) -> None:
        sheet = self.draw(
            {
                ("m", "a"): (10, 1),
                ("n", "a"): (30, 5),
                ("o", "a"): (20, 6),
                ("m", "b"): (40, 2),
                ("n", "b"): (50, 8),
                ("o", "b"): (90, 9),
            }
        )
        self.assertEqual(
            self.points(sheet, large=False),
            [[(10, 1), (30, 5), (20, 6)], [(40, 2), (50, 8), (90, 9)]],
        )
        self.assertEqual(
            self.points(sheet, large=True), [[(20, 5)], [(50, 8)]]
        )
        self.assertEqual(visible_axes(sheet)[0].get_xscale(), "linear")
        self.assertIn("6 of 6 cells shown", note(sheet))

    def test_medians_are_over_shared_models_alone(self) -> None:
        """Who fails on the large model gains nothing by that."""
        sheet = self.draw(
            {
                ("large", "a"): (90, 90),
                ("small", "a"): (10, 10),
                ("large", "b"): None,
                ("small", "b"): (12, 12),
            }
        )
        self.assertEqual(
            self.points(sheet, large=True), [[(10, 10)], [(12, 12)]]
        )
        self.assertIn("share (1)", note(sheet))
        self.assertIn("1 failed", note(sheet))

    def test_no_shared_model_no_medians(self) -> None:
        sheet = self.draw(
            {
                ("m", "a"): (1, 1),
                ("m", "b"): None,
                ("n", "a"): None,
                ("n", "b"): (1, 1),
            }
        )
        self.assertEqual(self.points(sheet, large=True), [])
        self.assertIn("no model is shared", note(sheet))

    def test_legend_names_who_is_shown(self) -> None:
        sheet = self.draw({("m", "a"): (1, 1), ("m", "b"): None})
        labels = [t.get_text() for t in sheet.figure.legends[0].get_texts()]
        self.assertEqual(labels, ["a"])

    def test_wide_ranges_are_logarithmic(self) -> None:
        sheet = self.draw({("m", "a"): (10, 1), ("n", "a"): (20, 5000)})
        axes = visible_axes(sheet)[0]
        self.assertEqual(axes.get_xscale(), "linear")
        self.assertEqual(axes.get_yscale(), "log")
        self.assert_laid_out(sheet)

    def test_zero_has_a_place_on_a_logarithmic_axis(self) -> None:
        sheet = self.draw(
            {("m", "a"): (10, 0), ("n", "a"): (20, 1), ("o", "a"): (20, 900)}
        )
        axes = visible_axes(sheet)[0]
        self.assertEqual(axes.get_yscale(), "symlog")
        low, high = axes.get_ylim()
        self.assertTrue(low < 0 < 900 < high)
        self.assertIn((10, 0), self.points(sheet, large=False)[0])
        self.assert_laid_out(sheet)

    def test_nothing_to_show(self) -> None:
        sheet = self.draw({("m", "a"): None})
        self.assertEqual(visible_axes(sheet)[0].lines[:], [])
        self.assertIn("0 of 1 cells shown; 1 left out: 1 failed", note(sheet))
        self.assert_laid_out(sheet)


if __name__ == "__main__":
    unittest.main()
