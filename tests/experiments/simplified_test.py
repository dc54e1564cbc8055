"""What simplifying saves is told against the model as it came."""

from __future__ import annotations

import unittest

from routebench_plots import simplified, summary
from support import PlotTestCase
from synthetic import Database


def report(deviation_mm: float | None) -> dict[str, object]:
    """A model's report as the runner writes it."""
    found = None if deviation_mm is None else {"deviation_mm": deviation_mm}
    return {"mesh": {"simplification": found}, "outline_vertices": 77}


class SimplifiedTest(PlotTestCase):
    """A part as it came and twice simplified, and another one that is as it came."""

    def page(self, with_original: bool = True) -> str:
        made = Database(self.folder / "r.sqlite")
        setting = made.setting()
        contenders = [made.contender(name) for name in ("fast", "slow")]
        models = [("part?size=9&simplify=0.01", 10, 0.5), ("part?size=9&simplify=0.1", 100, 0.031)]
        if with_original:
            models.append(("part?size=9", 1000, None))
        models.append(("other", 50, None))
        for spec, triangles, deviation_mm in models:
            model = made.model(spec, triangles=triangles, report=report(deviation_mm))
            made.cell(model, contenders[0], setting, {"plan_cpu_ns": 1e6 * triangles})
            made.cell(model, contenders[1], setting, None, "failed", "it did")
        return summary.to_markdown(summary.summary(self.open(made.close())), "e")

    def rows(self, page: str) -> list[list[str]]:
        """The cells of the table's rows."""
        section = page.partition("## Simplified models")[2].partition("\n## ")[0]
        lines = [line for line in section.splitlines() if line.startswith("|")]
        return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[2:]]

    def test_times_are_told_against_the_model_as_it_came(self) -> None:
        rows = self.rows(self.page())
        self.assertEqual(
            rows,
            [
                ["part?size=9", "1\u202f000", "as it came", "77", "1 s", "n/a"],
                ["part?size=9&simplify=0.1", "100", "0.031 mm", "77", "100 ms (0.1)", "n/a"],
                ["part?size=9&simplify=0.01", "10", "0.5 mm", "77", "10 ms (0.01)", "n/a"],
            ],
        )

    def test_without_the_model_as_it_came_there_is_no_ratio(self) -> None:
        rows = self.rows(self.page(with_original=False))
        self.assertEqual([row[4] for row in rows], ["100 ms", "10 ms"])

    def test_nothing_is_said_where_nothing_was_simplified(self) -> None:
        made = Database(self.folder / "plain.sqlite")
        model = made.model("part", report=report(None))
        made.cell(model, made.contender("c"), made.setting(), {"plan_cpu_ns": 1})
        self.assertEqual(simplified.simplified_markdown(self.open(made.close())), [])

    def test_origins_are_told_by_all_but_the_share(self) -> None:
        for label, origin in (
            ("a", "a"),
            ("a?simplify=0.1", "a"),
            ("a?simplify=0.1&size=5", "a?size=5"),
            ("a?size=5&simplify=0.1&triangles=9", "a?size=5&triangles=9"),
        ):
            self.assertEqual(simplified.as_it_came(label), origin)


if __name__ == "__main__":
    unittest.main()
