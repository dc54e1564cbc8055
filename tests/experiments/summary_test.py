"""Contenders are compared on the models that both do, and no others."""

from __future__ import annotations

import unittest

from routebench_plots.errors import PlotError
from routebench_plots.summary import Part, summary, to_latex, to_markdown
from support import PlotTestCase
from synthetic import Database


class SummaryTest(PlotTestCase):
    """Three models; "brave" is valid on all of them."""

    def setUp(self) -> None:
        super().setUp()
        made = Database(self.folder / "r.sqlite")
        setting = made.setting("density=1")
        travels = {
            "brave": (9.0, 19.0, 39.0),
            "choosy": (4.0, 9.0, None),
            "mixed": (19.0, 9.0, 39.0),
            "hopeless": (None, None, None),
        }
        models = [made.model(name) for name in ("easy", "medium", "h|ard")]
        for name, values in travels.items():
            contender = made.contender(name)
            for model, travel in zip(models, values):
                if travel is None:
                    made.cell(
                        model,
                        contender,
                        setting,
                        {"travel_mm": 0.0},
                        "off_task",
                        "covered 0.5 < 0.95",
                    )
                else:
                    made.cell(
                        model, contender, setting, {"travel_mm": travel}
                    )
        self.results = self.open(made.close())

    def part(self, baseline: str | None = None) -> Part:
        """The only setting's comparison."""
        (part,) = summary(self.results, baseline).parts
        return part

    def test_baseline_is_valid_on_most_models(self) -> None:
        self.assertEqual(self.part().baseline, "brave")
        self.assertEqual(self.part("choosy").baseline, "choosy")
        with self.assertRaisesRegex(PlotError, "no contender 'chosy'"):
            self.part("chosy")

    def test_ratios_are_over_shared_models(self) -> None:
        lines = {line.contender: line for line in self.part().lines}
        choosy = lines["choosy"].comparisons[0]
        assert choosy is not None
        # (4 + 1) / (9 + 1) and (9 + 1) / (19 + 1)
        self.assertAlmostEqual(choosy.ratio, 0.5)
        self.assertEqual((choosy.worse, choosy.shared), (0, 2))
        mixed = lines["mixed"].comparisons[0]
        assert mixed is not None
        self.assertAlmostEqual(mixed.ratio, 1.0)
        self.assertEqual((mixed.worse, mixed.shared), (1, 3))
        self.assertIsNone(lines["hopeless"].comparisons[0])
        self.assertEqual([lines[n].valid for n in lines], [2, 3, 3, 0])

    def test_least_travel_first_and_the_rest_last(self) -> None:
        self.assertEqual(
            [line.contender for line in self.part().lines],
            ["choosy", "brave", "mixed", "hopeless"],
        )

    def test_markdown_names_every_cell_that_is_not_valid(self) -> None:
        page = to_markdown(summary(self.results), "it")
        self.assertEqual(page.count("off task, covered 0.5 \\< 0.95"), 2)
        self.assertIn("- hopeless on every model, such as easy: off", page)
        self.assertIn("| brave (baseline) | 3 of 3 | 1 (0 of 3) |", page)
        self.assertIn("choosy on h\\|ard", page)

    def test_how_sure_it_is(self) -> None:
        """Four contenders, six pairs, on at most three models: p cannot be small."""
        page = to_markdown(summary(self.results), "it")
        self.assertIn("### How sure that is", page)
        self.assertIn("| choosy | 2 | 0.5 [0.5, 0.5] | 0 of 2 | 1 | no difference shown |", page)
        self.assertIn("With 3 pairs on so few models p is never below 0.75", page)
        self.assertNotIn("| hopeless | 0 |", page)

    def test_latex_has_the_same_ratios(self) -> None:
        table = to_latex(summary(self.results))
        self.assertIn(r"{}choosy & 0.5 [0.5, 0.5] & 0.5 & 0 of 2 & 1 \\", table)
        self.assertIn(r"{}hopeless & -- & -- & -- & -- \\", table)
        self.assertIn(r"\toprule", table)
        self.assertEqual(table.count(r"\begin{tabular}"), table.count(r"\end{tabular}"))


if __name__ == "__main__":
    unittest.main()
