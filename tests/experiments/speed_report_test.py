"""The page on speed: what contenders are told, and its tables."""

from __future__ import annotations

import json
import math
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import speed_report
from speed_report import Run

PROGRAM = Path(os.environ["ROUTEBENCH_PROGRAM"])


class Settings(unittest.TestCase):
    def test_all_contenders_fill_narrow_places_or_all_leave_them(self) -> None:
        for fills in (True, False):
            with tempfile.TemporaryDirectory() as folder:
                commands, _ = speed_report.contenders(PROGRAM, Path(folder), fills)
            self.assertEqual("shell.gaps=leave" in commands[speed_report.OURS], not fills)
            self.assertEqual("fill.thin=drop" in commands[speed_report.OURS], not fills)
            for prusa, gaps in ((True, "gap_fill_enabled"), (False, "fill_gaps")):
                lines = speed_report.ini(prusa, fills).splitlines()
                self.assertIn(f"thin_walls = {int(fills)}", lines)
                self.assertIn(f"{gaps} = {int(fills)}", lines)
            cura = speed_report.cura_settings(fills)
            self.assertIn("fill_outline_gaps=" + ("true" if fills else "false"), cura)
            self.assertIn("fill_perimeter_gaps=" + ("everywhere" if fills else "nowhere"), cura)


class Tables(unittest.TestCase):
    def rows(self, *runs: Run) -> list[str]:
        ours = Run("box", speed_report.OURS, "filled", 2, 0.1, 0.2, 20, 9, 0.991)
        medians = speed_report.median_runs([ours, *runs])
        lines = speed_report.slicer_table(medians, "filled", 2)
        for line in lines:
            self.assertEqual(line.count("|"), lines[0].count("|"), line)
        self.assertEqual(lines[2], "| box | routebench | 99.1 | 0.10 | 0.20 | 20 | | | | |")
        return lines[3:]

    def test_a_target_is_met_by_time_and_memory(self) -> None:
        for wall_s, peak_mb, met in ((1.5, 40, "yes"), (1.49, 40, "no"),
                                     (1.5, 39, "yes, too much memory")):
            rows = self.rows(Run("box", "PrusaSlicer", "filled", 2, wall_s, 3, peak_mb, 9, 0.987))
            self.assertEqual(len(rows), 1)
            self.assertTrue(rows[0].startswith("| box | PrusaSlicer | 98.7 |"), rows[0])
            self.assertTrue(rows[0].endswith(f"| 15.0 x | 15 x, memory 0.5 x | {met} |"), rows[0])

    def test_other_work_and_other_cores_are_not_compared(self) -> None:
        self.assertEqual(self.rows(Run("box", "Slic3r", "left", 2, 9, 9, 9, 9),
                                   Run("box", "Slic3r", "filled", 1, 9, 9, 9, 9)),
                         ["| box | Slic3r | - | fails | | | | | | |"])

    def test_medians_keep_what_was_judged_once(self) -> None:
        slic3r = [Run("box", "Slic3r", "filled", 2, wall_s, 4, 50, 9, covered)
                  for wall_s, covered in ((2, 0.95), (9, math.nan), (3, math.nan))]
        self.assertIn("| Slic3r | 95.0 | 3.00 |", self.rows(*slic3r)[0])

    def test_what_cannot_be_judged_is_left_open(self) -> None:
        self.assertIn("| Slic3r | - |", self.rows(Run("box", "Slic3r", "filled", 2, 2, 4, 9, 9))[0])

    def test_judging_is_met_if_it_takes_no_longer_than_the_rest(self) -> None:
        phases = [speed_report.Phases("box", 1.0, judging_s) for judging_s in (0.9, 1.1, 0.5)]
        self.assertIn("| box | 1.000 | 0.900 | 0.90 x | 1 x | yes |",
                      speed_report.judging_table(phases))
        phases[0].judging_s = 1.05
        self.assertTrue(speed_report.judging_table(phases)[-1].endswith("| 1.05 x | 1 x | no |"))


class Covered(unittest.TestCase):
    def test_it_is_what_planning_says(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            gcode = Path(folder) / "out.gcode"
            model = Path("shape:box?x=12&y=9&z=1")
            said = json.loads(subprocess.run(
                [str(PROGRAM), "plan", str(model), *speed_report.PLANNERS,
                 *speed_report.task_options(), "--gcode", str(gcode), "--json", "-"],
                stdout=subprocess.PIPE, check=True, encoding="utf-8").stdout)
            self.assertAlmostEqual(speed_report.covered_by(PROGRAM, model, gcode),
                                   said["totals"]["covered"], places=3)

    def test_nobody_can_tell_of_what_is_no_gcode(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            gcode = Path(folder) / "out.gcode"
            gcode.write_text("this is no print\n", encoding="utf-8")
            self.assertTrue(math.isnan(speed_report.covered_by(
                PROGRAM, Path("shape:box?x=12&y=9&z=1"), gcode)))


if __name__ == "__main__":
    unittest.main()
