"""The outcome matrix hides nothing."""

from __future__ import annotations

import unittest

from matplotlib.colors import to_hex

from routebench_plots import outcomes
from routebench_plots.sheet import Sheet
from routebench_plots.style import outcome_look
from support import PlotTestCase, note, visible_axes, words
from synthetic import Database, fill

ALL = (
    "valid",
    "off_task",
    "failed",
    "crashed",
    "timed_out",
    "out_of_memory",
    "not_installed",
)


class OutcomesTest(PlotTestCase):
    """One matrix."""

    def draw(self, database: Database) -> Sheet:
        """The matrix of all models."""
        results = self.open(database.close())
        return outcomes.draw(
            results, results.settings[0], results.models, "Outcomes"
        )

    def test_every_outcome_is_named_and_coloured(self) -> None:
        made = Database(self.folder / "r.sqlite")
        model, setting = made.model("m"), made.setting()
        for name in ALL:
            contender = made.contender(f"does {name}")
            made.cell(model, contender, setting, outcome=name)
        sheet = self.draw(made)
        axes = visible_axes(sheet)[0]
        shown = {" ".join(t.get_text().split()) for t in axes.texts}
        for name in ALL:
            self.assertIn(name.replace("_", " "), shown)
        # A hatch lies over its cell, without a colour of its own.
        faces = [p.get_facecolor() for p in axes.patches]
        colours = {to_hex(face) for face in faces if face[3] > 0}
        wanted = {outcome_look(name).background.lower() for name in ALL}
        self.assertEqual(colours, wanted)
        self.assertEqual(len(wanted), len(ALL))

    def test_a_new_outcome_is_shown_by_its_name(self) -> None:
        made = Database(self.folder / "r.sqlite")
        made.cell(
            made.model("m"),
            made.contender("c"),
            made.setting(),
            outcome="struck_by_lightning",
        )
        self.assertIn("struck by lightning", words(self.draw(made)))

    def test_missing_cells_are_not_run(self) -> None:
        made = Database(self.folder / "r.sqlite")
        models = [made.model("m"), made.model("n")]
        contenders = [made.contender("a"), made.contender("b")]
        setting = made.setting()
        made.cell(models[0], contenders[0], setting)
        made.cell(models[1], contenders[1], setting)
        sheet = self.draw(made)
        self.assertEqual(words(sheet).count("not run"), 3)
        self.assertIn("2 of 2 cells are valid", note(sheet))
        self.assertIn("2 not run", note(sheet))

    def test_reasons_are_told(self) -> None:
        made = Database(self.folder / "r.sqlite")
        model, setting = made.model("m"), made.setting()
        made.cell(
            model,
            made.contender("c"),
            setting,
            outcome="off_task",
            reason="covered 0.91 < 0.95",
        )
        self.assertIn("m × c: off task: covered 0.91 < 0.95", self.told(made))

    def told(self, made: Database) -> str:
        """The notes of the matrix."""
        return note(self.draw(made))

    def test_many_reasons_are_counted(self) -> None:
        made = Database(self.folder / "r.sqlite")
        contender, setting = made.contender("c"), made.setting()
        for number in range(20):
            made.cell(
                made.model(f"m{number:02}"),
                contender,
                setting,
                outcome="crashed",
                reason="signal 11",
            )
        self.assertIn("8 more reasons: see table.md", self.told(made))

    def test_seeds_are_counted(self) -> None:
        made = Database(self.folder / "r.sqlite")
        place = made.model("m"), made.contender("c"), made.setting()
        for seed in range(4):
            made.cell(*place, seed=seed)
        made.cell(*place, seed=4, outcome="timed_out", reason="120 s")
        sheet = self.draw(made)
        self.assertIn("timed out ×1 valid ×4", words(sheet))
        self.assertIn("timed out (seed 4): 120 s", note(sheet))

    def test_earlier_runs_are_left_out_and_counted(self) -> None:
        made = Database(self.folder / "r.sqlite")
        model, setting = made.model("m"), made.setting()
        made.cell(model, made.contender("old"), setting, outcome="failed")
        made.next_run()
        made.cell(model, made.contender("new"), setting)
        sheet = self.draw(made)
        self.assertNotIn("old", words(sheet))
        self.assertIn("Left out: 1 cell of earlier runs", note(sheet))

    def test_models_stand_in_the_order_of_the_config(self) -> None:
        path = fill(self.folder / "r.sqlite", ["z", "a"], ["d", "b"])
        results = self.open(path)
        self.assertEqual([m.label for m in results.models], ["z", "a"])
        self.assertEqual([c.label for c in results.contenders], ["b", "d"])


if __name__ == "__main__":
    unittest.main()
