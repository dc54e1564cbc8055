"""The gate fails for what became worse, and for nothing else."""

from __future__ import annotations

import contextlib
import io
import os
import random
import sqlite3
import subprocess
import sys
import tempfile
import unittest
from collections.abc import Callable
from pathlib import Path
from unittest import mock

from noise import noisy_times
from routebench_gate import cli
from support import PlotTestCase
from synthetic import TASK, Database

MODELS = 6
CONTENDERS = ("one", "other")

Change = Callable[[int, str, dict[str, float]], dict[str, float]]


def as_it_was(model: int, contender: str, scores: dict[str, float]) -> dict[str, float]:
    """Changes nothing."""
    return scores


class GateTest(PlotTestCase):
    """Two databases of one experiment."""

    def make(
        self,
        name: str,
        change: Change = as_it_was,
        slower: float = 1.0,
        seed: int = 0,
        outcomes: dict[tuple[int, str], str] | None = None,
        skip: tuple[int, str] | None = None,
        task: dict[str, object] | None = None,
    ) -> Path:
        """The experiment, with a change of some totals; times with noise."""
        path = self.folder / f"{name}.sqlite"
        path.unlink(missing_ok=True)
        made = Database(path)
        setting = made.setting(task=task)
        contenders = {c: made.contender(c) for c in CONTENDERS}
        rng = random.Random(f"{name} {seed}")
        for number in range(MODELS):
            model = made.model(f"m{number}")
            for contender in CONTENDERS:
                if (number, contender) == skip:
                    continue
                base = random.Random(f"{number} {contender}")
                scores = {
                    "travel_mm": base.uniform(100, 999),
                    "retractions": float(base.randint(10, 99)),
                    "covered": base.uniform(0.96, 0.99),
                    "print_time_s": base.uniform(60, 600),
                    "extrude_mm": base.uniform(1000, 9999),
                }
                true_ns = 1e7 * base.uniform(1, 50)
                outcome = (outcomes or {}).get((number, contender), "valid")
                cell = made.cell(
                    model,
                    contenders[contender],
                    setting,
                    change(number, contender, scores),
                    outcome,
                    "covered 0.9 < 0.95" if outcome == "off_task" else "",
                )
                made.times(cell, noisy_times(rng, true_ns * slower, 5))
        return made.close()

    def gate(self, *arguments: str | Path) -> tuple[int, str, str]:
        """Exit code, page, and what stands on stderr."""
        out, err = io.TextIOWrapper(io.BytesIO(), encoding="utf-8"), io.StringIO()
        with mock.patch.object(sys, "stdout", out), contextlib.redirect_stderr(err):
            code = cli.main([str(word) for word in arguments])
            out.flush()
        return code, out.buffer.getvalue().decode(), err.getvalue()  # type: ignore[attr-defined]

    def scale(self, metric: str, factor: float, model: int | None = None) -> Change:
        """Multiplies a metric of contender `one`, on one model or on all."""

        def change(number: int, contender: str, scores: dict[str, float]) -> dict[str, float]:
            if contender == "one" and model in (None, number):
                scores[metric] *= factor
            return scores

        return change

    def test_nothing_changed(self) -> None:
        old = self.make("old")
        code, page, errors = self.gate(old, old)
        self.assertEqual((code, errors), (0, ""))
        self.assertTrue(page.startswith("## PASSED, no regression\n"), page)
        self.assertNotIn("###", page)

    def test_one_percent_of_travel_fails(self) -> None:
        old = self.make("old")
        for model in (None, 3):
            new = self.make("new", self.scale("travel_mm", 1.01, model))
            code, page, _ = self.gate(old, new)
            self.assertEqual(code, 1, page)
            head = page.splitlines()[0]
            self.assertRegex(
                head, r"^## FAILED, 1 regression: Travel of one on m\d: .+ mm \(\+1 %\)$"
            )
        self.assertIn("worse on 1 of 6 cells", page)
        self.assertIn("Travel of one on m3: ", head)
        for allowed in ("--travel=2%", "--tolerance=0.02", "--limit=travel_mm=2%"):
            code, page, _ = self.gate(old, new, allowed)
            self.assertEqual(code, 0, page)
            self.assertIn("within the limit", page)

    def test_the_headline_names_the_worst(self) -> None:
        """A cell that is lost before any figure, what is exact before times, then the largest."""

        def change(number: int, contender: str, scores: dict[str, float]) -> dict[str, float]:
            scores["travel_mm"] *= {1: 1.02, 4: 1.3}.get(number, 1.0) if contender == "other" else 1
            scores["retractions"] *= 1.1 if number == 2 else 1
            return scores

        def headline(**options: object) -> str:
            new = self.make("new", **options)  # type: ignore[arg-type]
            return self.gate(old, new, "--require-all")[1].splitlines()[0]

        old = self.make("old")
        self.assertRegex(
            headline(change=change, slower=9.0),
            r"^## FAILED, \d regressions, worst: Travel of other on m4: .* \(\+30 %\)$",
        )
        self.assertRegex(
            headline(slower=9.0), r"^## FAILED, 2 regressions, worst: Planning CPU time of \w+ on m\d"
        )
        self.assertRegex(
            headline(change=change, outcomes={(2, "one"): "crashed"}),
            r"^## FAILED, \d regressions, worst: one on m2: valid → crashed$",
        )
        self.assertEqual(
            headline(skip=(4, "other")), "## FAILED, 1 regression: other on m4: missing"
        )

    def test_gains_elsewhere_excuse_nothing(self) -> None:
        def change(number: int, contender: str, scores: dict[str, float]) -> dict[str, float]:
            scores["travel_mm"] *= 1.02 if number == 0 else 0.7
            return scores

        code, _, _ = self.gate(self.make("old"), self.make("new", change))
        self.assertEqual(code, 1)

    def test_directions(self) -> None:
        """Less travel is better, less coverage is worse; without a direction nothing counts."""
        old = self.make("old")
        for metric, factor, expected in (
            ("travel_mm", 0.9, 0),
            ("covered", 0.98, 1),
            ("covered", 1.005, 0),
            ("covered", 0.999, 0),
            ("retractions", 1.2, 1),
            ("extrude_mm", 1.5, 0),
        ):
            code, page, _ = self.gate(old, self.make("new", self.scale(metric, factor)))
            self.assertEqual(code, expected, (metric, factor, page))

    def test_from_nothing_to_something(self) -> None:
        old = self.make("old", self.scale("retractions", 0.0))
        code, page, _ = self.gate(old, self.make("new"))
        self.assertEqual(code, 1)
        self.assertIn("0 →", page)

    def test_a_wobble_of_times_does_not_fail(self) -> None:
        """Noise alone never, and neither a fifth more on everything, in all of 100 tries."""
        for seed in range(100):
            old = self.make("old", seed=seed)
            new = self.make("new", slower=1.2 if seed % 2 else 1.0, seed=seed)
            code, page, _ = self.gate(old, new)
            self.assertEqual(code, 0, page)

    def test_twice_the_time_fails(self) -> None:
        for seed in range(20):
            code, page, _ = self.gate(
                self.make("old", seed=seed), self.make("new", slower=2.0, seed=seed)
            )
            self.assertEqual(code, 1, page)
            self.assertIn("Planning CPU time", page)
        code, _, _ = self.gate(
            self.folder / "old.sqlite", self.folder / "new.sqlite", "--times=never"
        )
        self.assertEqual(code, 0)

    def test_one_model_that_explodes_fails(self) -> None:
        """The median does not see it, the cell's own repetitions do."""
        old, new = self.make("old"), self.make("new")
        made = sqlite3.connect(new)
        made.execute("UPDATE timing_sample SET plan_cpu_ns = plan_cpu_ns * 9 WHERE cell_id = 3")
        made.commit()
        made.close()
        code, page, _ = self.gate(old, new)
        self.assertEqual(code, 1, page)
        self.assertIn("m1", page)

    def test_times_of_other_processors_are_not_compared(self) -> None:
        old, new = self.make("old"), self.make("new", slower=3.0)
        for path, cpu in ((old, "slow one"), (new, "fast one")):
            made = sqlite3.connect(path)
            made.execute("ALTER TABLE run ADD COLUMN cpu TEXT")
            made.execute("UPDATE run SET cpu = ?", (cpu,))
            made.commit()
            made.close()
        code, page, _ = self.gate(old, new)
        self.assertEqual(code, 0, page)
        self.assertIn("times not compared", page)
        self.assertEqual(self.gate(old, new, "--times", "always")[0], 1)

    def test_outcomes(self) -> None:
        good = self.make("old")
        bad = self.make("new", outcomes={(2, "one"): "off_task"})
        code, page, _ = self.gate(good, bad)
        self.assertEqual(code, 1)
        self.assertIn("one on m2: valid → off task (covered 0.9 \\< 0.95)", page)
        code, page, _ = self.gate(bad, good)
        self.assertEqual(code, 0)
        self.assertIn("off task → valid", page)
        other = self.make("other", outcomes={(2, "one"): "crashed"})
        code, page, _ = self.gate(bad, other)
        self.assertEqual(code, 0)
        self.assertIn("off task → crashed", page)

    def test_missing_cells_are_named(self) -> None:
        whole = self.make("old")
        for part in (
            self.make("new", skip=(4, "other")),
            self.make("away", outcomes={(4, "other"): "not_installed"}),
        ):
            code, page, _ = self.gate(whole, part)
            self.assertEqual(code, 0)
            self.assertIn("1 missing now", page)
            self.assertIn("other on m4", page)
            self.assertEqual(self.gate(whole, part, "--require-all")[0], 1)
            code, page, _ = self.gate(part, whole)
            self.assertEqual(code, 0)
            self.assertIn("New cells", page)

    def test_a_changed_model_is_not_compared(self) -> None:
        old, new = self.make("old"), self.make("new", self.scale("travel_mm", 2.0, 1))
        made = sqlite3.connect(new)
        made.execute("UPDATE model SET mesh_hash = 'x' WHERE spec = 'm1'")
        made.commit()
        made.close()
        code, page, _ = self.gate(old, new)
        self.assertEqual(code, 0, page)
        self.assertIn("the model itself differs: m1", page)

    def test_a_model_with_a_longer_name_is_told_by_its_mesh(self) -> None:
        old, new = self.make("old"), self.make("new", self.scale("travel_mm", 2.0, 1))
        for path, name, mesh in ((old, "a/m1.stl", "x"), (new, "b/m1.stl", "x")):
            made = sqlite3.connect(path)
            made.execute(
                "UPDATE model SET mesh_hash = ?, spec = ? WHERE spec = 'm1'", (mesh, name)
            )
            if path == new:  # which makes both names longer
                made.execute("UPDATE model SET mesh_hash = 'y', spec = 'c/m1.stl' WHERE spec = 'm2'")
            made.commit()
            made.close()
        code, page, _ = self.gate(old, new)
        self.assertEqual(code, 1, page)
        self.assertIn("Travel of one on m1.stl: ", page)
        for place in ("one on m2\n", "one on c/m1.stl\n"):
            self.assertIn(place, page, "missing, and new")

    def test_what_cannot_be_compared_is_refused(self) -> None:
        old = self.make("old")
        other = self.make("task", task={**TASK, "layer_height_mm": 0.3})
        stranger = self.make("stranger")
        made = sqlite3.connect(stranger)
        made.execute("UPDATE meta SET value = 'elsewhere' WHERE key = 'experiment'")
        made.commit()
        made.close()
        for arguments, why in (
            ([old, other], "[task] layer_height_mm is 0.3, but 0.2"),
            ([old, stranger], "holds the experiment 'elsewhere'"),
            ([old, self.folder / "absent"], "no results database here"),
            ([old], "new"),
            ([old, old, "--travel", "much"], "--travel much: give a share"),
            ([old, old, "--tolerance=-1%"], "--tolerance -1%"),
            ([old, old, "--limit", "travel_mm"], "give METRIC=SHARE"),
            ([old, old, "--limit", "travel=1%"], "did you mean 'travel_mm'?"),
            ([old, old, "--metrics", "travl_mm"], "did you mean 'travel_mm'?"),
            ([old, old, "--metrics", "extrude_mm"], "neither more nor less"),
            ([old, old, "--times", "often"], "often"),
        ):
            code, page, errors = self.gate(*arguments)
            self.assertEqual((code, page), (2, ""), arguments)
            self.assertRegex(errors, r"\Aroutebench: [^\n]+\n\Z")
            self.assertIn(why, errors)

    def test_the_page_is_a_table_and_the_same_each_time(self) -> None:
        old, new = self.make("old"), self.make("new", self.scale("travel_mm", 1.1))
        _, page, _ = self.gate(old, new)
        self.assertEqual(self.gate(old, new)[1], page)
        rows = [line for line in page.splitlines() if line.startswith("|")]
        self.assertGreater(len(rows), 2)
        self.assertEqual({row.count("|") for row in rows}, {rows[0].count("|")})

    def test_all_metrics(self) -> None:
        old = self.make("old")
        code, page, _ = self.gate(old, self.make("new"), "--metrics=all", "--times=never")
        self.assertEqual(code, 0)
        self.assertIn("equal in every digit", page)


class GateCommandTest(unittest.TestCase):
    """The built program, end to end: two runs of one small experiment."""

    def test_a_worse_variant_fails(self) -> None:
        program = os.environ["ROUTEBENCH_PROGRAM"]
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            for run, link in (("old", "boundary"), ("again", "boundary"), ("new", "none")):
                config = folder / f"{run}.toml"
                config.write_text(
                    'name = "small"\nmodels = ["shape:box?size=10&z=1"]\n'
                    "[run]\nrepetitions = 2\n"
                    '[[contender]]\nname = "lines"\nshell = { planner = "greedy_shell" }\n'
                    f'fill = {{ planner = "rectilinear", link = "{link}" }}\n'
                )
                subprocess.run(
                    [program, "run", config, "--out", folder / run],
                    check=True,
                    capture_output=True,
                )
            for run, expected in (("again", 0), ("new", 1), ("absent", 2)):
                done = subprocess.run(
                    [program, "gate", folder / "old", folder / run, "--limit=travel_mm=1%"],
                    capture_output=True,
                    text=True,
                    check=False,
                )
                self.assertEqual(done.returncode, expected, done.stdout + done.stderr)
            self.assertEqual(done.stdout, "")
            self.assertRegex(done.stderr, r"\Aroutebench: [^\n]+\n\Z")


if __name__ == "__main__":
    unittest.main()
