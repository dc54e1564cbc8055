"""A sweep of the retraction policy is recognised, drawn, and its flips are found."""

from __future__ import annotations

import sqlite3
import unittest

from routebench_plots import ratios, sweep
from routebench_plots.figures import chosen_metrics, figures
from routebench_plots.results import Results
from routebench_plots.sheet import Sheet
from routebench_plots.summary import summary, to_markdown
from support import LONG_NAME, PlotTestCase, note, visible_axes, words
from synthetic import TASK, Database

Totals = dict[tuple[str, float], dict[str, float]]
"""Retractions by policy and limit, then by contender."""

CROSSING: Totals = {
    ("length", 1.0): {"a": 10, "b": 20},
    ("length", 2.0): {"a": 10, "b": 10},
    ("length", 9.0): {"a": 9, "b": 4},
    ("manhattan", 1.0): {"a": 30, "b": 20},
    ("manhattan", 2.0): {"a": 20, "b": 10},
    ("manhattan", 9.0): {"a": 9, "b": 4},
}


class SweepTest(PlotTestCase):
    """Two models, of which one is half of the totals."""

    def make(self, totals: Totals, other: dict[str, object] | None = None) -> Results:
        """`other`: what the last setting has besides in its printer."""
        made = Database(self.folder / "r.sqlite")
        names = sorted({name for row in totals.values() for name in row})
        contenders = {name: made.contender(name) for name in names}
        models = [made.model("m"), made.model("n")]
        for place, ((policy, limit), row) in enumerate(totals.items()):
            printer: dict[str, object] = {"retract_policy": policy, "retract_over_mm": limit}
            if place == len(totals) - 1:
                printer |= other or {}
            setting = made.setting(
                f"retract_policy={policy}, retract_over_mm={limit:g}",
                {"travel_mm_s": 150, **printer},
            )
            for name, total in row.items():
                for model in models:
                    made.cell(
                        model,
                        contenders[name],
                        setting,
                        {"retractions": total / 2, "travel_mm": 5.0, "plan_cpu_ns": 7.0},
                    )
        return self.open(made.close())

    def find(self, results: Results) -> sweep.Sweep:
        """A sweep that must be there."""
        found = sweep.find(results)
        assert found is not None
        return found

    def draw(self, results: Results) -> Sheet:
        """The figure."""
        metric = self.metric(results, "retractions")
        return sweep.draw(results, metric, self.find(results), "Title")

    def test_is_recognised_by_its_keys(self) -> None:
        found = self.find(self.make(CROSSING))
        self.assertEqual((found.key, found.numeric), ("retract_over_mm", True))
        self.assertEqual(
            [group.label for group in found.groups],
            ["retract_policy=length", "retract_policy=manhattan"],
        )
        self.assertEqual([group.values for group in found.groups], [[1, 2, 9], [1, 2, 9]])

    def test_other_keys_make_it_no_sweep(self) -> None:
        self.assertIsNone(sweep.find(self.make(CROSSING, {"travel_mm_s": 99})))

    def test_other_tasks_make_it_no_sweep(self) -> None:
        made = Database(self.folder / "r.sqlite")
        model, contender = made.model("m"), made.contender("a")
        for limit in (1.0, 2.0):
            setting = made.setting(
                f"{limit}", {"retract_over_mm": limit}, {**TASK, "density": limit / 4}
            )
            made.cell(model, contender, setting, {"retractions": 1.0})
        self.assertIsNone(sweep.find(self.open(made.close())))

    def test_one_setting_is_no_sweep(self) -> None:
        self.assertIsNone(sweep.find(self.make({("length", 1.0): {"a": 1, "b": 2}})))

    def test_flips_skip_ties(self) -> None:
        """a leads at 1, ties at 2, trails at 9: one flip, between 1 and 9."""
        found = self.find(self.make(CROSSING))
        (flip,) = sweep.flips(found)
        self.assertEqual((flip.before, flip.after), (0, 2))
        self.assertEqual((flip.winner.label, flip.loser.label), ("b", "a"))
        self.assertEqual(
            sweep.flip_text(found, flip),
            "retract_policy=length: b overtakes a between retract_over_mm=1 and 9",
        )

    def test_flips_between_policies(self) -> None:
        found = self.find(self.make(CROSSING))
        (flip,) = sweep.flips_between_groups(found)
        self.assertEqual(flip[4], [1.0])

    def test_policies_alone(self) -> None:
        """Without numbers the policies stand along the axis."""
        results = self.make({key: row for key, row in CROSSING.items() if key[1] == 1.0})
        found = self.find(results)
        self.assertEqual((found.key, found.numeric), ("retract_policy", False))
        (flip,) = sweep.flips(found)
        self.assertEqual(flip.winner.label, "b")
        sheet = self.draw(results)
        self.assertIn("manhattan", words(sheet))
        self.assert_laid_out(sheet)

    def test_lines_are_totals_and_bands_are_flips(self) -> None:
        sheet = self.draw(self.make(CROSSING))
        length, manhattan = visible_axes(sheet)
        self.assertEqual(
            [
                list(zip(*line.get_data()))
                for line in length.lines
                if line.get_gid() != "flip"
            ],
            [[(1, 10), (2, 10), (9, 9)], [(1, 20), (2, 10), (9, 4)]],
        )
        (ring,) = [line for line in length.lines if line.get_gid() == "flip"]
        self.assertEqual(tuple(ring.get_xydata()[0]), (2, 10), "they tie there")
        (band,) = length.patches
        self.assertEqual(
            (band.get_xy()[:, 0].min(), band.get_xy()[:, 0].max()), (1, 9)
        )
        self.assertEqual(list(manhattan.patches), [])
        self.assertIn("b overtakes a between", note(sheet))
        self.assertIn("24 of 24 cells shown", note(sheet))
        self.assert_laid_out(sheet)

    def test_rings_stand_where_lines_meet(self) -> None:
        """Half-way on an axis of policies, for 1 to 3 meets 3 to 1."""
        sheet = self.draw(
            self.make({("length", 1.0): {"a": 4, "b": 6}, ("manhattan", 1.0): {"a": 6, "b": 4}})
        )
        (axes,) = visible_axes(sheet)
        (ring,) = [line for line in axes.lines if line.get_gid() == "flip"]
        self.assertEqual(tuple(ring.get_xydata()[0]), (0.5, 5.0))

    def test_long_names_fit(self) -> None:
        names = {f"{LONG_NAME} {n}": 10.0 * n + 5 for n in range(5)}
        rows = {key: names for key in CROSSING}
        sheet = self.draw(self.make(rows))
        self.assert_laid_out(sheet)
        self.assertIn("Nowhere along the axis", note(sheet))

    def test_a_contender_that_fails_is_left_out(self) -> None:
        results = self.make({key: {"a": 5, "b": 6} for key in CROSSING})
        made = self.folder / "r.sqlite"
        results.close()
        connection = sqlite3.connect(made)
        connection.execute("UPDATE cell SET outcome = 'failed' WHERE contender_id = 2")
        connection.commit()
        connection.close()
        results = self.open(made)
        found = self.find(results)
        self.assertEqual([c.label for c in found.contenders], ["a"])
        self.assertEqual([c.label for c in found.left_out], ["b"])
        sheet = self.draw(results)
        self.assertIn("12 of 24 cells shown; 12 left out: 12 failed", note(sheet))

    def test_the_summary_says_where_the_ranking_flips(self) -> None:
        page = to_markdown(summary(self.make(CROSSING)), "it")
        self.assertIn("## Retraction policy", page)
        self.assertIn(
            "- retract\\_policy=length: b overtakes a between retract\\_over\\_mm=1 and 9", page
        )
        self.assertIn("| a 10, b 20 |", page)

    def test_what_the_printer_cannot_change_is_drawn_once(self) -> None:
        results = self.make(CROSSING)
        metrics = chosen_metrics(results, ["travel_mm", "retractions", "plan_cpu_ns"])
        stems = [figure.stem for figure in figures(results, metrics)]
        for start, times in (
            ("retraction-sweep", 1),
            ("outcomes", 1),
            ("bars-travel_mm", 1),
            ("bars-plan_cpu_ns", 1),
            ("scatter", 1),
            # The last rows of both policies are equal.
            ("bars-retractions", 5),
        ):
            self.assertEqual(sum(s.startswith(start) for s in stems), times, start)


class FiguresTest(PlotTestCase):
    """The figures that compare over all models."""

    def test_ratios_and_their_intervals(self) -> None:
        made = Database(self.folder / "r.sqlite")
        setting, a, b = made.setting(), made.contender("a"), made.contender("b")
        for number in range(9):
            model = made.model(f"m{number}")
            made.cell(model, a, setting, {"travel_mm": 99.0})
            made.cell(model, b, setting, {"travel_mm": 49.0 + 50 * (number % 3)})
        results = self.open(made.close())
        metric = self.metric(results, "travel_mm")
        sheet = ratios.draw(
            results, results.settings[0], [metric], results.contenders[0], "Title"
        )
        (axes,) = visible_axes(sheet)
        (bar,) = axes.patches
        self.assertAlmostEqual(bar.get_x() + bar.get_width(), 1.0)
        self.assertIn("baseline", words(sheet))
        self.assertIn("18 of 18 cells shown", note(sheet))
        self.assert_laid_out(sheet)


if __name__ == "__main__":
    unittest.main()
