"""Contenders are told apart where they differ, and only there."""

from __future__ import annotations

import random
import unittest

from noise import noisy_times
from routebench_plots.comparison import Comparisons
from routebench_plots.results import Results
from support import PlotTestCase, by_label
from synthetic import Database

MODELS = 12


class ComparisonTest(PlotTestCase):
    """Experiments made up from a seed."""

    def timed(
        self, seed: int, factors: dict[str, float], repetitions: int, models: int = MODELS
    ) -> Results:
        """Contenders that take so many times as long, measured with noise."""
        path = self.folder / "r.sqlite"
        path.unlink(missing_ok=True)
        made = Database(path)
        rng = random.Random(seed)
        setting = made.setting()
        contenders = {name: made.contender(name) for name in factors}
        for number in range(models):
            model = made.model(f"m{number:02}")
            true_ns = 1e6 * 10 ** rng.uniform(0, 3)
            travel = rng.uniform(100, 9000)
            for name, factor in factors.items():
                cell = made.cell(model, contenders[name], setting, {"travel_mm": travel})
                made.times(cell, noisy_times(rng, true_ns * factor, repetitions))
        made.close()
        return Results(path)

    def claims(self, seed: int, factors: dict[str, float], repetitions: int) -> int:
        """How many pairs are told apart by their times."""
        with self.timed(seed, factors, repetitions) as results:
            pairs = Comparisons(results, results.settings[0], self.metric(results, "plan_cpu_ns"))
            return pairs.pairs - len(pairs.not_told_apart())

    def test_equal_programs_are_not_told_apart(self) -> None:
        """A/A: at least 95 of 100 tries, for two and for several contenders at once."""
        for names in (("a", "b"), ("a", "b", "c", "d", "e")):
            for repetitions in (1, 5):
                same = dict.fromkeys(names, 1.0)
                quiet = sum(self.claims(seed, same, repetitions) == 0 for seed in range(100))
                with self.subTest(names=names, repetitions=repetitions, quiet=quiet):
                    self.assertGreaterEqual(quiet, 95)

    def test_one_contender_split_in_two_is_no_difference(self) -> None:
        """A/A of one contender's own repetitions, halved at random."""
        quiet = 0
        for seed in range(100):
            rng = random.Random(seed)
            path = self.folder / "half.sqlite"
            path.unlink(missing_ok=True)
            made = Database(path)
            setting, halves = made.setting(), [made.contender("one"), made.contender("other")]
            for number in range(MODELS):
                model = made.model(f"m{number}")
                times = noisy_times(rng, 1e6 * 10 ** rng.uniform(0, 3), 10)
                rng.shuffle(times)
                for half, contender in enumerate(halves):
                    cell = made.cell(model, contender, setting)
                    made.times(cell, times[half::2])
            with Results(made.close()) as results:
                metric = self.metric(results, "plan_cpu_ns")
                one, other = results.contenders
                quiet += not Comparisons(results, results.settings[0], metric).differs(one, other)
        self.assertGreaterEqual(quiet, 95)

    def test_slower_programs_are_told_apart(self) -> None:
        """The reverse, or silence would pass: a third slower is found in 95 of 100 tries."""
        factors = {"a": 1.0, "b": 1.33}
        self.assertGreaterEqual(sum(self.claims(seed, factors, 5) for seed in range(100)), 95)

    def test_times_within_the_margin_are_equal(self) -> None:
        """Two percent on every model are certain, but no more than equal code differs by."""
        made = Database(self.folder / "r.sqlite")
        setting, a, b = made.setting(), made.contender("a"), made.contender("b")
        for number in range(MODELS):
            model = made.model(f"m{number}")
            for contender, time in ((a, 1_000_000), (b, 1_020_000)):
                made.times(made.cell(model, contender, setting), [time])
        results = self.open(made.close())
        pairs = Comparisons(results, results.settings[0], self.metric(results, "plan_cpu_ns"))
        one, other = results.contenders
        self.assertLess(pairs.p(one, other), 0.001)
        self.assertFalse(pairs.differs(one, other))

    def test_totals_are_compared_exactly(self) -> None:
        """No margin: the last digit on every model is a difference, equality is none."""
        made = Database(self.folder / "r.sqlite")
        setting = made.setting()
        a, b, c = (made.contender(name) for name in "abc")
        for number in range(MODELS):
            model = made.model(f"m{number}")
            for contender, travel in ((a, 100.0), (b, 100.0 + 1e-9), (c, 100.0)):
                made.cell(model, contender, setting, {"travel_mm": travel})
        results = self.open(made.close())
        pairs = Comparisons(results, results.settings[0], self.metric(results, "travel_mm"))
        one, other, third = results.contenders
        found = pairs.compare(other, one)
        assert found is not None
        self.assertTrue(found.differs)
        self.assertEqual((found.worse, found.shared), (MODELS, MODELS))
        self.assertFalse(pairs.differs(one, third))
        self.assertEqual(pairs.p(one, third), 1.0)

    def test_failures_are_left_out_of_pairs_and_ranks(self) -> None:
        made = Database(self.folder / "r.sqlite")
        setting = made.setting()
        contenders = {name: made.contender(name) for name in ("good", "fair", "rare", "never")}
        for number in range(8):
            model = made.model(f"m{number}")
            for place, (name, contender) in enumerate(contenders.items()):
                fails = name == "never" or (name == "rare" and number > 1)
                fails = fails or (name == "fair" and number == 0)
                made.cell(
                    model,
                    contender,
                    setting,
                    {"travel_mm": 10.0 + place},
                    "off_task" if fails else "valid",
                )
        results = self.open(made.close())
        pairs = Comparisons(results, results.settings[0], self.metric(results, "travel_mm"))
        item = {name: by_label(results.contenders, name) for name in contenders}
        self.assertEqual(len(pairs.shared(item["good"], item["fair"])), 7)
        self.assertEqual(len(pairs.shared(item["good"], item["rare"])), 2)
        self.assertIsNone(pairs.compare(item["never"], item["good"]))
        ranking = pairs.ranking()
        assert ranking is not None
        self.assertEqual({c.label for c in ranking.left_out}, {"rare", "never"})
        self.assertEqual(len(ranking.models), 7)
        ranks = dict(zip((c.label for c in ranking.contenders), ranking.test.mean_ranks))
        self.assertEqual(ranks, {"fair": 2.0, "good": 1.0})


if __name__ == "__main__":
    unittest.main()
