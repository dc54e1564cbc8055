"""Bars show the numbers of the database, and words where there are none."""

from __future__ import annotations

import unittest

from matplotlib.axes import Axes
from matplotlib.patches import Rectangle

from routebench_plots import bars
from routebench_plots.results import Results
from routebench_plots.sheet import Sheet
from support import PlotTestCase, note, visible_axes, words
from synthetic import Database, fill


def bar_widths(axes: Axes) -> dict[int, float]:
    """Lengths of a panel's bars by their places from the top."""
    return {
        round(bar.get_y() + bar.get_height() / 2): bar.get_width()
        for container in axes.containers
        for bar in container
        if isinstance(bar, Rectangle)
    }


class BarsTest(PlotTestCase):
    """One figure of one metric."""

    def draw(self, results: Results, metric: str) -> Sheet:
        """All models on one page."""
        return bars.draw(
            results,
            results.settings[0],
            self.metric(results, metric),
            results.models,
            "Title",
        )

    def experiment(self) -> tuple[Database, list[int], list[int], int]:
        """Two models, three contenders, no cells yet."""
        made = Database(self.folder / "results.sqlite")
        models = [made.model("first"), made.model("second")]
        contenders = [made.contender(name) for name in ("a", "b", "c")]
        return made, models, contenders, made.setting()

    def test_bars_are_the_totals(self) -> None:
        made, models, contenders, setting = self.experiment()
        for model in models:
            for place, contender in enumerate(contenders):
                travel = 100.0 * model + 10 * place
                made.cell(model, contender, setting, {"travel_mm": travel})
        results = self.open(made.close())
        panels = visible_axes(self.draw(results, "travel_mm"))
        self.assertEqual([a.get_title() for a in panels], ["first", "second"])
        self.assertEqual(bar_widths(panels[0]), {0: 100, 1: 110, 2: 120})
        self.assertEqual(bar_widths(panels[1]), {0: 200, 1: 210, 2: 220})
        self.assertEqual(
            [t.get_text() for t in panels[0].get_yticklabels()],
            ["a", "b", "c"],
        )

    def test_label_has_unit_and_direction(self) -> None:
        made, models, contenders, setting = self.experiment()
        made.cell(
            models[0],
            contenders[0],
            setting,
            {"travel_mm": 1.0, "covered": 0.97, "filament_mm3": 4.0},
        )
        results = self.open(made.close())
        for metric, label in (
            ("travel_mm", "Travel [mm] (lower is better)"),
            ("covered", "Covered (higher is better)"),
            ("filament_mm3", "Material [mm³]"),
        ):
            axes = visible_axes(self.draw(results, metric))[0]
            self.assertEqual(axes.get_xlabel(), label)

    def test_zero_is_a_value_and_the_best(self) -> None:
        made, models, contenders, setting = self.experiment()
        made.cell(models[0], contenders[0], setting, {"retractions": 0.0})
        made.cell(models[0], contenders[1], setting, {"retractions": 7.0})
        results = self.open(made.close())
        axes = visible_axes(self.draw(results, "retractions"))[0]
        self.assertEqual(bar_widths(axes), {0: 0, 1: 7})
        shown = {t.get_text(): t.get_weight() for t in axes.texts}
        self.assertEqual(shown["0"], "bold")
        self.assertEqual(shown["7"], "normal")

    def test_all_zero_has_an_axis(self) -> None:
        made, models, contenders, setting = self.experiment()
        made.cell(models[0], contenders[0], setting, {"retractions": 0.0})
        results = self.open(made.close())
        sheet = self.draw(results, "retractions")
        self.assertEqual(visible_axes(sheet)[0].get_xlim(), (0, 1))
        self.assert_laid_out(sheet)

    def test_absence_and_outcomes_are_words(self) -> None:
        made, models, contenders, setting = self.experiment()
        a, b, c = contenders
        made.cell(models[0], a, setting, {"travel_mm": 5.0})
        made.cell(models[0], b, setting, {"travel_mm": None})
        made.cell(
            models[0], c, setting, {"travel_mm": 1.0}, outcome="off_task"
        )
        made.cell(models[1], a, setting, outcome="timed_out")
        made.cell(models[1], b, setting, {"travel_mm": float("inf")})
        results = self.open(made.close())
        sheet = self.draw(results, "travel_mm")
        first, second = visible_axes(sheet)
        self.assertEqual(bar_widths(first), {0: 5})
        self.assertEqual(bar_widths(second), {})
        self.assertEqual(
            [t.get_text() for t in first.texts], ["5", "n/a", "off task"]
        )
        self.assertEqual(
            [t.get_text() for t in second.texts],
            ["timed out", "n/a", "not run"],
        )
        self.assertIn(
            "1 of 5 cells shown; 4 left out: 1 off task, 1 timed out, "
            "2 without a value. 1 not run.",
            note(sheet),
        )

    def test_invalid_cells_are_never_best(self) -> None:
        made, models, contenders, setting = self.experiment()
        made.cell(models[0], contenders[0], setting, {"travel_mm": 5.0})
        made.cell(
            models[0],
            contenders[1],
            setting,
            {"travel_mm": 1.0},
            outcome="off_task",
        )
        results = self.open(made.close())
        axes = visible_axes(self.draw(results, "travel_mm"))[0]
        bold = [t.get_text() for t in axes.texts if t.get_weight() == "bold"]
        self.assertEqual(bold, ["5"])

    def test_neither_direction_has_no_best(self) -> None:
        made, models, contenders, setting = self.experiment()
        made.cell(models[0], contenders[0], setting, {"deposit": 0.9})
        made.cell(models[0], contenders[1], setting, {"deposit": 1.1})
        results = self.open(made.close())
        axes = visible_axes(self.draw(results, "deposit"))[0]
        self.assertNotIn("bold", [t.get_weight() for t in axes.texts])

    def test_times_are_medians_with_their_range(self) -> None:
        made, models, contenders, setting = self.experiment()
        cell = made.cell(
            models[0], contenders[0], setting, {"plan_cpu_ns": 99.0}
        )
        made.times(cell, [9_000_000, 2_000_000, 3_000_000])
        results = self.open(made.close())
        sheet = self.draw(results, "plan_cpu_ns")
        axes = visible_axes(sheet)[0]
        self.assertIn("[ms]", axes.get_xlabel())
        self.assertEqual(bar_widths(axes), {0: 3})
        whiskers = axes.containers[1].lines[2][0].get_segments()[0]
        self.assertEqual([point[0] for point in whiskers], [2, 9])
        self.assertIn("medians of 3 repetitions", note(sheet))

    def test_seeds_are_summed_up_by_their_median(self) -> None:
        made, models, contenders, setting = self.experiment()
        for seed, travel in ((1, 10.0), (2, 30.0), (3, 11.0)):
            made.cell(
                models[0],
                contenders[0],
                setting,
                {"travel_mm": travel},
                seed=seed,
            )
        made.cell(models[0], contenders[0], setting, outcome="crashed", seed=4)
        results = self.open(made.close())
        sheet = self.draw(results, "travel_mm")
        axes = visible_axes(sheet)[0]
        self.assertEqual(bar_widths(axes), {0: 11})
        self.assertEqual(axes.texts[0].get_text(), "11 (3/4 valid)")
        self.assertIn("medians of 3 seeds", note(sheet))
        self.assertIn("1 crashed", note(sheet))

    def test_numbers_stay_in_their_panel(self) -> None:
        names = [f"contender {n}" for n in range(5)]
        path = fill(self.folder / "r.sqlite", ["m", "n", "o", "p"], names)
        results = self.open(path)
        for metric in ("travel_mm", "covered", "plan_cpu_ns"):
            sheet = self.draw(results, metric)
            sheet.figure.draw_without_rendering()
            for axes in visible_axes(sheet):
                for text in axes.texts:
                    self.assert_inside(
                        text.get_window_extent(), axes.bbox, text
                    )

    def test_looks_differ_and_do_not_depend_on_the_metric(self) -> None:
        names = [f"contender {n:02}" for n in range(12)]
        results = self.open(fill(self.folder / "r.sqlite", ["m"], names))
        seen = []
        for metric in ("travel_mm", "covered"):
            axes = visible_axes(self.draw(results, metric))[0]
            patches = [c[0] for c in axes.containers]
            seen.append([(p.get_facecolor(), p.get_hatch()) for p in patches])
        self.assertEqual(seen[0], seen[1])
        self.assertEqual(len(set(seen[0])), 12)

    def test_gate_is_named(self) -> None:
        results = self.open(fill(self.folder / "r.sqlite", ["m"], ["a"]))
        self.assertIn(
            "Valid means at least 0.95 here.",
            note(self.draw(results, "covered")),
        )
        self.assertIn(
            "at least 0.85 and at most 1.15",
            note(self.draw(results, "deposit")),
        )
        self.assertNotIn("Valid means", note(self.draw(results, "doubled")))

    def test_many_models_take_several_pages(self) -> None:
        models = [f"model {n:02}" for n in range(40)]
        path = fill(self.folder / "r.sqlite", models, ["a", "b"], layers=2)
        results = self.open(path)
        per_page = bars.layout_for(results).models_per_page
        self.assertTrue(1 < per_page < 40)
        sheet = bars.draw(
            results,
            results.settings[0],
            self.metric(results, "travel_mm"),
            results.models[:per_page],
            "Title",
        )
        self.assertEqual(len(visible_axes(sheet)), per_page)
        self.assertLess(sheet.height, 11)
        self.assertIn("model 00", words(sheet))


if __name__ == "__main__":
    unittest.main()
