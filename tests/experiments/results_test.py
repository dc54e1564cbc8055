"""The database is read as it is, and refused where it is none."""

from __future__ import annotations

import os
import sqlite3
import stat
import unittest
from pathlib import Path

from routebench_plots.database import find_database
from routebench_plots.errors import PlotError
from routebench_plots.results import Results
from support import PlotTestCase
from synthetic import Database, fill


class PathTest(PlotTestCase):
    """Models that lie somewhere on a disk."""

    def test_models_are_called_by_the_end_of_their_path(self) -> None:
        made = Database(self.folder / "results.sqlite")
        setting, contender = made.setting(), made.contender("a")
        for spec in ("/home/me/a/lid.stl?size=9", "/home/me/b/lid.stl?size=9", "shape:box"):
            made.cell(made.model(spec), contender, setting, {"travel_mm": 1.0})
        with Results(made.close()) as results:
            labels = [model.label for model in results.models]
        self.assertEqual(labels, ["a/lid.stl?size=9", "b/lid.stl?size=9", "shape:box"])


class FindTest(PlotTestCase):
    """Which file a user means."""

    def test_folder_or_file(self) -> None:
        path = fill(self.folder / "results.sqlite", ["m"], ["c"])
        self.assertEqual(find_database(self.folder), path)
        self.assertEqual(find_database(path), path)

    def test_nothing_there(self) -> None:
        for place in (self.folder, self.folder / "absent"):
            with self.assertRaisesRegex(PlotError, "no results database"):
                find_database(place)


class RefuseTest(PlotTestCase):
    """What is no results database of this version."""

    def refused(self, path: Path, why: str) -> None:
        """Opening says why."""
        with self.assertRaisesRegex(PlotError, why):
            Results(path)

    def test_not_a_database(self) -> None:
        path = self.folder / "results.sqlite"
        path.write_text("something else" * 100)
        self.refused(path, "results.sqlite: cannot be read")

    def test_empty_file(self) -> None:
        path = self.folder / "results.sqlite"
        path.touch()
        self.refused(path, "not a whole results database")

    def test_another_database(self) -> None:
        path = self.folder / "results.sqlite"
        connection = sqlite3.connect(path)
        connection.execute("CREATE TABLE t(x)")
        connection.close()
        self.refused(path, "not a whole results database")

    def test_another_version(self) -> None:
        made = Database(self.folder / "r.sqlite", schema_version="3")
        self.refused(made.close(), "schema version 3, .* read version 2")

    def test_no_cells(self) -> None:
        made = Database(self.folder / "r.sqlite")
        made.model("m")
        self.refused(made.close(), "no cells yet")

    def test_truncated(self) -> None:
        path = fill(self.folder / "r.sqlite", ["m"], ["c"])
        path.write_bytes(path.read_bytes()[:5000])
        self.refused(path, "r.sqlite: ")

    def test_missing_table(self) -> None:
        made = Database(self.folder / "r.sqlite")
        made.cell(made.model("m"), made.contender("c"), made.setting())
        made.execute("DROP TABLE timing_sample")
        self.refused(made.close(), "no such table: timing_sample")


class ReadTest(PlotTestCase):
    """What is read."""

    def test_same_name_twice(self) -> None:
        made = Database(self.folder / "r.sqlite")
        model, setting = made.model("m"), made.setting()
        for digits in ("0123456789", "abcdefghij"):
            made.cell(model, made.contender("c", digits), setting)
        results = self.open(made.close())
        self.assertEqual(
            [c.label for c in results.contenders],
            ["c [0123456]", "c [abcdefg]"],
        )

    def test_a_model_cut_anew_for_another_task_is_one_model(self) -> None:
        made = Database(self.folder / "r.sqlite")
        contender = made.contender("c")
        thick, thin = made.setting("thick"), made.setting("thin")
        for setting, hash_, travel in ((thick, "a", 1.0), (thin, "b", 2.0)):
            made.cell(
                made.model("part.stl", hash_),
                contender,
                setting,
                {"travel_mm": travel},
            )
        results = self.open(made.close())
        self.assertEqual([m.label for m in results.models], ["part.stl"])
        travel = self.metric(results, "travel_mm")
        values = [
            results.value(
                results.slot(s, results.models[0], results.contenders[0]),
                travel,
            )
            for s in results.settings
        ]
        self.assertEqual([v.median for v in values if v], [1.0, 2.0])

    def test_only_the_last_run_counts(self) -> None:
        made = Database(self.folder / "r.sqlite")
        model, setting = made.model("m"), made.setting()
        old, new = made.contender("old"), made.contender("new")
        made.cell(model, old, setting)
        made.next_run()
        made.cell(model, new, setting)
        results = self.open(made.close())
        self.assertEqual([c.label for c in results.contenders], ["new"])
        self.assertEqual(results.earlier_cells, 1)

    def test_odd_values_are_absent(self) -> None:
        made = Database(self.folder / "r.sqlite")
        values = {
            "travel_mm": None,
            "covered": float("inf"),
            "deposit": 0.0,
        }
        made.cell(made.model("m"), made.contender("c"), made.setting(), values)
        made.execute("INSERT INTO cell_score VALUES(1, 'strokes', 'many')")
        results = self.open(made.close())
        slot = results.slot(
            results.settings[0], results.models[0], results.contenders[0]
        )
        for name in ("travel_mm", "covered", "strokes", "doubled"):
            metric = self.metric(results, name)
            self.assertIsNone(results.value(slot, metric), name)
        value = results.value(slot, self.metric(results, "deposit"))
        assert value is not None
        self.assertEqual(value.median, 0)
        with_values = [
            metric.name
            for metric in results.metrics
            if results.has_values(metric)
        ]
        self.assertEqual(with_values, ["deposit"])

    def test_large_seeds(self) -> None:
        made = Database(self.folder / "r.sqlite")
        made.cell(
            made.model("m"), made.contender("c"), made.setting(), seed=-1
        )
        results = self.open(made.close())
        slot = results.slot(
            results.settings[0], results.models[0], results.contenders[0]
        )
        self.assertEqual(slot.cells[0].seed, 2**64 - 1)

    def test_a_writer_is_not_kept_waiting(self) -> None:
        path = fill(self.folder / "r.sqlite", ["m"], ["c"])
        results = self.open(path)
        writer = sqlite3.connect(path, timeout=0)
        writer.execute("PRAGMA journal_mode = DELETE")
        writer.execute("UPDATE cell SET outcome = 'failed'")
        writer.commit()
        writer.close()
        slot = results.slot(
            results.settings[0], results.models[0], results.contenders[0]
        )
        self.assertEqual(slot.cells[0].outcome, "valid")

    def test_nothing_is_written(self) -> None:
        path = fill(self.folder / "r.sqlite", ["m"], ["c"])
        before = path.read_bytes()
        self.open(path)
        self.assertEqual(path.read_bytes(), before)
        self.assertEqual(os.listdir(self.folder), ["r.sqlite"])

    def test_read_only_place(self) -> None:
        place = self.folder / "locked"
        place.mkdir()
        path = fill(place / "r.sqlite", ["m"], ["c"])
        path.chmod(stat.S_IRUSR)
        place.chmod(stat.S_IRUSR | stat.S_IXUSR)
        self.addCleanup(place.chmod, stat.S_IRWXU)
        self.assertEqual(len(self.open(path).models), 1)

    def test_odd_path(self) -> None:
        place = self.folder / "what? #1 100%20"
        place.mkdir()
        path = fill(place / "results.sqlite", ["m"], ["c"])
        self.assertEqual(len(self.open(path).models), 1)


if __name__ == "__main__":
    unittest.main()
