"""Tables rank valid cells and name all the others."""

from __future__ import annotations

import re
import unittest

from routebench_plots.figures import chosen_metrics
from routebench_plots.tables import Table, tables, to_latex, to_markdown
from support import PlotTestCase
from synthetic import Database


class TablesTest(PlotTestCase):
    """One model with five contenders."""

    def setUp(self) -> None:
        super().setUp()
        made = Database(self.folder / "r.sqlite")
        model = made.model("50% of_a #model|x")
        setting = made.setting("density=0.2")
        for name, travel, covered in (
            ("slow", 30.0, 0.99),
            ("best", 0.0, 0.96),
            ("as_slow", 30.0, 0.99),
        ):
            made.cell(
                model,
                made.contender(name),
                setting,
                {"travel_mm": travel, "covered": covered, "deposit": 1.0},
            )
        made.cell(
            model,
            made.contender("cheat"),
            setting,
            {"travel_mm": 0.0, "covered": 0.5},
            "off_task",
            "covered 0.5 < 0.95",
        )
        made.cell(model, made.contender("null"), setting, {"covered": 0.97})
        self.results = self.open(made.close())

    def made(self) -> list[Table]:
        """Travel, coverage and deposit."""
        names = ["travel_mm", "covered", "deposit"]
        return tables(self.results, chosen_metrics(self.results, names))

    def test_ranks(self) -> None:
        (block,) = self.made()[0].blocks
        self.assertEqual(
            [(row.rank, row.contender) for row in block.rows],
            [
                (1, "best"),
                (2, "as_slow"),
                (2, "slow"),
                (None, "cheat"),
                (None, "null"),
            ],
        )

    def test_best_of_each_metric(self) -> None:
        rows = {row.contender: row for row in self.made()[0].blocks[0].rows}
        self.assertEqual(
            [n.best for n in rows["best"].numbers], [True, False, False]
        )
        self.assertEqual(
            [n.best for n in rows["slow"].numbers], [False, True, False]
        )
        self.assertEqual(
            [n.text for n in rows["best"].numbers], ["0", "0.96", "1"]
        )
        self.assertEqual([n.text for n in rows["cheat"].numbers], ["n/a"] * 3)
        self.assertEqual(
            [n.text for n in rows["null"].numbers], ["n/a", "0.97", "n/a"]
        )

    def test_markdown(self) -> None:
        page = to_markdown(self.made(), "Totals")
        rows = [ln for ln in page.splitlines() if ln.startswith("|")]
        cells = {len(re.split(r"(?<!\\)\|", row)) for row in rows}
        self.assertEqual(cells, {8})
        self.assertIn("## density=0.2", page)
        self.assertIn(r"### 50% of\_a \#model\|x", page)
        self.assertIn(r"off task: covered 0.5 \< 0.95", page)
        self.assertIn("| 1 | best | **0** | 0.96 | 1 | valid |", page)
        self.assertIn(r"Travel \[mm\] ↓", page)
        self.assertIn("Covered ↑", page)

    def test_latex(self) -> None:
        page = to_latex(self.made())
        self.assertIn(r"50\% of\_\allowbreak{}a \#model\textbar{}x", page)
        self.assertIn(r"1 & best & \textbf{0} & 0.96 & 1 & valid \\", page)
        for rule in (r"\toprule", r"\midrule", r"\bottomrule"):
            self.assertIn(rule, page)
        rows = [ln for ln in page.splitlines() if ln.endswith(r"\\")]
        cells = {
            len(re.split(r"(?<!\\)&", row))
            for row in rows
            if "multicolumn" not in row
        }
        self.assertEqual(cells, {6})
        bare = re.sub(r"\\[%#_&$]", "", page)
        self.assertNotRegex(bare.split("\n", 2)[2], r"[%#_]")


if __name__ == "__main__":
    unittest.main()
