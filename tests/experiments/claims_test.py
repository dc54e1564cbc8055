"""Claims are compared with the law that made the cells."""

from __future__ import annotations

import json
import unittest

from routebench_plots import claims, figures, summary
from support import PlotTestCase
from synthetic import Database


class ClaimsTest(PlotTestCase):
    """A linear and a quadratic contender, both claimed to be linear."""

    def made(self) -> Database:
        made = Database(self.folder / "r.sqlite")
        setting = made.setting()
        models = [made.model(f"m{i}") for i in range(5)]
        for name, power in (("linear", 1), ("square", 2)):
            contender = made.contender(name)
            for i, model in enumerate(models):
                size = 10.0**i
                # Not quite a law, so that there is an interval.
                time = 5e3 * size**power * (1.05 if i % 2 else 1)
                scores = {"extrude_mm": size, "plan_cpu_ns": time}
                made.cell(model, contender, setting, scores)
        config = {
            "claims": [
                {"contender": name, "size": "extrude_mm", "exponent": 1, "source": "a paper"}
                for name in ("linear", "square")
            ],
            "published": [
                {
                    "model": "m0",
                    "program": "Their slicer",
                    "metric": "plan_cpu_ns",
                    "value": 7e9,
                    "note": "another machine",
                    "source": "a paper",
                }
            ],
        }
        made.connection.execute("UPDATE run SET config_resolved_json = ?", (json.dumps(config),))
        return made

    def test_exponents_are_judged(self) -> None:
        results = self.open(self.made().close())
        linear, square = claims.judged_claims(results)
        self.assertEqual((linear.verdict, square.verdict), ("agrees", "grows faster"))
        assert linear.law is not None and square.law is not None
        self.assertAlmostEqual(linear.law.exponent, 1, delta=0.02)
        self.assertAlmostEqual(square.law.exponent, 2, delta=0.02)

    def test_the_summary_has_both_tables_and_the_figures_one(self) -> None:
        results = self.open(self.made().close())
        page = summary.to_markdown(summary.summary(results), "e")
        self.assertIn("## Claimed and measured growth", page)
        self.assertIn("grows faster", page)
        self.assertIn("Their slicer | 7 s", page)
        stems = [figure.stem for figure in figures.figures(results, [])]
        self.assertEqual([stem for stem in stems if stem.startswith("claims-")], ["claims-extrude_mm"])
        figure = next(f for f in figures.figures(results, []) if f.stem == "claims-extrude_mm")
        self.assertIn("claimed 1", " ".join(self.legend_words(figure.draw())))

    def test_nothing_is_said_where_nothing_is_claimed(self) -> None:
        made = Database(self.folder / "plain.sqlite")
        made.cell(made.model("m"), made.contender("c"), made.setting(), {"travel_mm": 1})
        results = self.open(made.close())
        self.assertEqual(claims.judged_claims(results), [])
        self.assertNotIn("Claimed", summary.to_markdown(summary.summary(results), "e"))

    @staticmethod
    def legend_words(sheet) -> list[str]:
        """What the legend says."""
        return [text.get_text() for text in sheet.figure.findobj(lambda a: hasattr(a, "get_text"))]


if __name__ == "__main__":
    unittest.main()
