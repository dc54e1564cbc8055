"""Five planners on twenty models: one table, every cell with its routes."""

from __future__ import annotations

import os
import sqlite3
import subprocess
import tempfile
import unittest
from contextlib import closing
from pathlib import Path

PROGRAM = os.environ["ROUTEBENCH_PROGRAM"]
MODELS = [
    f"shape:{name}?size={size}"
    for name in ("box", "cylinder", "gear", "hotend", "torus")
    for size in (8, 10, 12, 14)
]
FILLS = ("rectilinear", "concentric", "eulerian", "voxel")


class TracedTableTest(unittest.TestCase):
    """What a table shows can be followed to the strokes behind it."""

    def test_every_cell_leads_to_its_routes(self) -> None:
        contenders = "".join(
            f'[[contender]]\nname = "{fill}"\nshell = {{ planner = "greedy_shell" }}\n'
            f'fill = {{ planner = "{fill}" }}\n'
            for fill in FILLS
        )
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "e.toml").write_text(
                f"name = \"traced\"\nmodels = {MODELS!r}\n"
                "[task]\nlayer_height_mm = 0.4\nline_width_mm = 0.6\n"
                '[run]\nrepetitions = 1\nkeep_layers = "all"\n'
                '[[contender]]\nname = "walls alone"\nshell = { planner = "greedy_shell" }\n'
                + contenders,
                encoding="utf-8",
            )
            for words in (
                ["run", folder / "e.toml", "--out", folder, "--progress", "none"],
                ["export", folder, "--out", folder / "csv"],
            ):
                done = subprocess.run(
                    [PROGRAM, *words], capture_output=True, text=True, check=False, timeout=250
                )
                # Walls alone leave the inside empty: they are off task, and shown.
                self.assertIn(done.returncode, (0, 1), done.stderr)
            table = (folder / "csv" / "cells.csv").read_text(encoding="utf-8").splitlines()
            told = {tuple(line.split(",")[1:3]) for line in table[1:]}
            self.assertEqual(len(told), len(MODELS) * 5)
            with closing(sqlite3.connect(folder / "results.sqlite")) as database:
                rows = database.execute(
                    "SELECT cell.outcome, cell.layers, cell.route_hash, count(route.layer_index) "
                    "FROM current_cell AS cell LEFT JOIN route USING (cell_id) GROUP BY cell_id"
                ).fetchall()
            self.assertEqual(len(rows), len(MODELS) * 5)
            for outcome, layers, route_hash, routes in rows:
                self.assertIn(outcome, ("valid", "off_task"))
                self.assertEqual(routes, layers)
                self.assertEqual(len(route_hash), 64)


if __name__ == "__main__":
    unittest.main()
