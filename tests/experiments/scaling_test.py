"""Exponents are those of the law that made the points."""

from __future__ import annotations

import math
import unittest

from routebench_plots import scaling
from support import PlotTestCase, note, visible_axes
from synthetic import Database


class FitTest(unittest.TestCase):
    """The power law alone."""

    def test_an_exact_law_is_found_exactly(self) -> None:
        law = scaling.fit([(x, 3 * x**1.5) for x in (1.0, 4.0, 25.0, 100.0)])
        assert law is not None
        self.assertAlmostEqual(law.exponent, 1.5)
        self.assertAlmostEqual(law.factor, 3)
        self.assertAlmostEqual(law.half_width, 0, places=6)

    def test_the_interval_is_students(self) -> None:
        # Logarithms (0, 0), (1, 2), (2, 3): slope 1.5, residuals -1/6, 1/3,
        # -1/6, so its deviation is sqrt((1/6) / 1 / 2); times 12.706.
        law = scaling.fit([(math.exp(x), math.exp(y)) for x, y in ((0, 0), (1, 2), (2, 3))])
        assert law is not None
        self.assertAlmostEqual(law.exponent, 1.5)
        self.assertAlmostEqual(law.half_width, 12.7062047 * math.sqrt(1 / 12))

    def test_one_size_has_no_law(self) -> None:
        self.assertIsNone(scaling.fit([(2, 1), (2, 3)]))
        self.assertIsNone(scaling.fit([(0, 1), (2, 3)]))
        two = scaling.fit([(1, 1), (2, 4)])
        assert two is not None
        self.assertTrue(math.isnan(two.half_width))
        self.assertEqual(scaling.exponent_text(two), "exponent 2.00")


class FigureTest(PlotTestCase):
    """Two contenders with a law, one with too few models."""

    def test_only_contenders_with_enough_sizes_have_a_law(self) -> None:
        made = Database(self.folder / "r.sqlite")
        setting = made.setting()
        models = [made.model(f"m{i}") for i in range(5)]
        for name, power, count in (("linear", 1, 5), ("square", 2, 5), ("few", 1, 3)):
            contender = made.contender(name)
            for i, model in enumerate(models[:count]):
                size = 10.0**i
                made.cell(
                    model,
                    contender,
                    setting,
                    {"extrude_mm": size, "plan_cpu_ns": 5e3 * size**power},
                )
        results = self.open(made.close())
        setting_item = results.settings[0]
        size, time = (
            self.metric(results, "extrude_mm"),
            self.metric(results, "plan_cpu_ns"),
        )
        found = scaling.fits(results, setting_item, size, time)
        exponents = {
            c.label: found[c.row_id][1].exponent
            for c in results.contenders
            if c.row_id in found
        }
        self.assertEqual(set(exponents), {"linear", "square"})
        self.assertAlmostEqual(exponents["square"], 2)
        sheet = scaling.draw(results, setting_item, size, time, "Growth")
        self.assertIn("3 of too few sizes", note(sheet))
        axes = visible_axes(sheet)[0]
        self.assertEqual((axes.get_xscale(), axes.get_yscale()), ("log", "log"))


if __name__ == "__main__":
    unittest.main()
