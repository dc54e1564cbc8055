"""The figures over all models show what the numbers say: profiles, ranks, heat maps, fronts."""

from __future__ import annotations

import unittest

from routebench_plots import heat, profiles, ranks, ratios
from routebench_plots.results import Item, Results
from routebench_plots.scatter import pareto_front
from routebench_plots.sheet import FORMATS
from support import PlotTestCase, note, visible_axes, words
from synthetic import Database

TRAVELS = {
    "best": (10.0, 10.0, 10.0, 10.0),
    "good": (21.0, 12.0, 11.0, None),
    "poor": (43.0, 98.0, 32.0, 54.0),
    "gone": (None, None, None, None),
}


class OverviewTest(PlotTestCase):
    """Four models; "good" fails on the last, "gone" everywhere."""

    def setUp(self) -> None:
        super().setUp()
        made = Database(self.folder / "r.sqlite")
        setting = made.setting()
        models = [made.model(f"m{number}") for number in range(4)]
        for name, row in TRAVELS.items():
            contender = made.contender(name)
            for model, travel in zip(models, row):
                outcome = "valid" if travel else "off_task"
                if name == "gone":
                    outcome = "not_installed"
                scores = None if travel is None else {"travel_mm": travel}
                made.cell(model, contender, setting, scores, outcome)
        self.results: Results = self.open(made.close())
        self.setting: Item = self.results.settings[0]
        self.travel = self.metric(self.results, "travel_mm")

    def item(self, name: str) -> Item:
        """A contender."""
        return next(c for c in self.results.contenders if c.label == name)

    def test_profiles_are_stairs_up_to_what_is_solved(self) -> None:
        sheet = profiles.draw(self.results, self.setting, [self.travel], "Title")
        (axes,) = visible_axes(sheet)
        lines = dict(zip((c.label for c in self.results.contenders), axes.lines))
        self.assertEqual(lines["best"].get_ydata()[0], 1.0)
        self.assertEqual(lines["good"].get_ydata()[-1], 0.75)
        self.assertEqual(lines["poor"].get_ydata()[-1], 1.0)
        self.assertEqual(set(lines["gone"].get_ydata()), {0.0})
        # (21 + 1) / (10 + 1), where two of the three models are reached already.
        good = dict(zip(*lines["good"].get_data()))
        self.assertEqual(good[2.0], 0.75)
        self.assertIn("11 of 16 cells", note(sheet))
        self.assertIn("4 not installed, 1 off task", note(sheet))
        self.assert_laid_out(sheet)

    def test_ranks_leave_out_who_is_rarely_valid(self) -> None:
        found = ranks.rankings(self.results, self.setting, [self.travel])
        (_, ranking) = found[0]
        self.assertEqual([c.label for c in ranking.contenders], ["best", "good", "poor"])
        self.assertEqual(ranking.test.mean_ranks, [1.0, 2.0, 3.0])
        sheet = ranks.draw(self.results, self.setting, found, "Title")
        shown = words(sheet)
        for text in ("best (1.00)", "good (2.00)", "poor (3.00)", "Friedman over 3 models"):
            self.assertIn(text, shown)
        self.assertNotIn("gone", shown)
        self.assertIn("9 of 16 cells shown", note(sheet))
        self.assertIn("2 on models that some contender does not do", note(sheet))
        self.assert_laid_out(sheet)

    def test_heat_is_the_ratio_to_the_best(self) -> None:
        sheet = heat.draw(self.results, self.setting, self.travel, self.results.models, "Title")
        shown = words(sheet)
        for text in ("| 1 |", "| 2 |", "| 4 |", "| 9 |", "| 1.09 |", "off task", "not installed"):
            self.assertIn(text, f"| {shown} |")
        self.assertIn("11 of 16 cells shown", note(sheet))
        self.assert_laid_out(sheet)

    def test_what_is_not_installed_is_hatched(self) -> None:
        sheet = heat.draw(self.results, self.setting, self.travel, self.results.models, "Title")
        (axes,) = visible_axes(sheet)
        self.assertEqual(sum(bool(p.get_hatch()) for p in axes.patches), 4)

    def test_heat_never_says_one_for_what_is_not_the_best(self) -> None:
        self.assertEqual(heat.ratio_text(1.0), "1")
        self.assertEqual(heat.ratio_text(1.0000001), "> 1")
        self.assertEqual(heat.ratio_text(1.006), "1.01")
        self.assertEqual(heat.ratio_text(1234.4), "1\u202f234")

    def test_the_line_at_one_is_named(self) -> None:
        """Wherever it lies, the name stands over it and inside the panel."""
        sheet = ratios.draw(
            self.results, self.setting, self.results.metrics[:6], self.item("good"), "Title"
        )
        renderer = sheet.figure.canvas.get_renderer()
        for axes in visible_axes(sheet):
            (mark,) = (text for text in axes.texts if text.get_text().startswith("baseline:"))
            self.assertEqual(" ".join(mark.get_text().split()), "baseline: good")
            box, panel = mark.get_window_extent(renderer), axes.get_window_extent(renderer)
            line = axes.transData.transform((1, 0))[0]
            self.assertLessEqual(box.x0 - 1, line)
            self.assertLessEqual(line, box.x1 + 1)
            self.assertGreaterEqual(box.x0, panel.x0 - 1)
            self.assertLessEqual(box.x1, panel.x1 + 1)

    def test_bars_without_a_shared_model_say_so(self) -> None:
        sheet = ratios.draw(
            self.results, self.setting, [self.travel], self.item("good"), "Title"
        )
        self.assertIn("no shared model", words(sheet))
        self.assertIn("where the baseline is not valid", note(sheet))
        self.assert_laid_out(sheet)

    def test_a_figure_in_memory_is_the_file(self) -> None:
        """For those who put figures into a page of their own."""
        sheet = profiles.draw(self.results, self.setting, [self.travel], "Title")
        size = tuple(sheet.figure.get_size_inches())
        for name in FORMATS:
            content = sheet.encoded(name)
            sheet.save(self.folder, "figure", [name])
            self.assertEqual((self.folder / f"figure.{name}").read_bytes(), content)
            self.assertEqual(sheet.encoded(name), content)
        self.assertEqual(tuple(sheet.figure.get_size_inches()), size)


class ParetoTest(unittest.TestCase):
    """Fronts of points."""

    POINTS = {1: (1.0, 9.0), 2: (2.0, 5.0), 3: (3.0, 5.0), 4: (4.0, 1.0), 5: (5.0, 8.0)}

    def test_none_is_beaten_by_another(self) -> None:
        self.assertEqual(pareto_front(self.POINTS, "lower", "lower"), [1, 2, 4])
        self.assertEqual(pareto_front(self.POINTS, "lower", "higher"), [1])
        self.assertEqual(pareto_front(self.POINTS, "higher", "higher"), [1, 5])
        self.assertEqual(pareto_front(self.POINTS, "neither", "lower"), [])

    def test_equals_are_both_on_it(self) -> None:
        self.assertEqual(pareto_front({1: (1, 1), 2: (1, 1)}, "lower", "lower"), [1, 2])


if __name__ == "__main__":
    unittest.main()
