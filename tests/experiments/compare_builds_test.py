"""The comparison of two builds, on programs that only claim to measure."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "experiments" / "compare_builds.py"

# Noise is the same whenever the tests run: one comparison in twenty would be wrong by chance.
FAKE = """#!/usr/bin/python3
import json, pathlib, random
runs = pathlib.Path(__file__ + ".runs")
run = len(runs.read_text()) if runs.exists() else 0
runs.write_text("." * (run + 1))
random.seed(f"{{pathlib.Path(__file__).name}} {{run}}")
times = {times!r}
print(json.dumps({{"benchmarks": [
    {{"name": name, "run_type": "iteration", "time_unit": "us",
     "cpu_time": time * (1 + {noise} * random.random()), **({error!r} or {{}})}}
    for name, time in times.items()]
    + [{{"name": "sort_BigO", "run_type": "aggregate", "cpu_time": 1, "time_unit": "us"}}]}}))
"""


class CompareBuilds(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def fake(self, name: str, times: dict[str, float], noise: float = 0.02,
             error: dict | None = None) -> Path:
        """A program that says of each benchmark that it takes so many microseconds."""
        path = self.folder / name
        path.write_text(FAKE.format(times=times, noise=noise, error=error), encoding="utf-8")
        path.chmod(0o755)
        return path

    def compare(self, before: Path, after: Path,
                *options: str) -> tuple[subprocess.CompletedProcess[str], dict]:
        result = self.folder / "result.json"
        run = subprocess.run([sys.executable, "-B", SCRIPT, before, after, "--json", result,
                              *options],
                             capture_output=True, text=True, check=False)
        return run, json.loads(result.read_text()) if result.exists() else {}

    def test_a_program_does_not_differ_from_its_copy(self) -> None:
        times = {f"sort/{2 ** k}": 3.0 * 2 ** k for k in range(20)}
        run, rows = self.compare(self.fake("a", times), self.fake("b", times))
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(rows.keys(), times.keys())
        self.assertEqual({row["verdict"] for row in rows.values()}, {"none"})

    def test_what_takes_a_fifth_more_is_slower_and_nothing_else_is(self) -> None:
        run, rows = self.compare(self.fake("a", {"sort": 10, "search": 5, "hash": 7}),
                                 self.fake("b", {"sort": 12, "search": 5, "hash": 3.5}))
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual({name: row["verdict"] for name, row in rows.items()},
                         {"sort": "slower", "search": "none", "hash": "faster"})
        self.assertAlmostEqual(rows["sort"]["ratio"], 1.2, delta=0.03)
        self.assertAlmostEqual(rows["sort"]["before_ns"], 10_100, delta=150)
        self.assertLess(rows["hash"]["high"], 1)
        self.assertIn("slower", run.stdout)

    def test_benchmarks_of_one_program_alone_are_named(self) -> None:
        run, rows = self.compare(self.fake("a", {"sort": 1, "old": 1}, noise=0),
                                 self.fake("b", {"sort": 1, "new": 1}, noise=0), "--rounds", "2")
        self.assertEqual(rows.keys(), {"sort"})
        self.assertRegex(run.stderr, r"only .*/b has new\n.*only .*/a has old")

    def test_what_cannot_be_compared_ends_with_one_line(self) -> None:
        good = self.fake("good", {"sort": 1})
        broken = self.folder / "broken"
        broken.write_text("#!/bin/sh\necho no such option >&2\nexit 3\n", encoding="utf-8")
        broken.chmod(0o755)
        failing = self.fake("failing", {"sort": 1},
                            error={"error_occurred": True, "error_message": "cannot write"})
        other = self.fake("other", {"walk": 1})
        for after, complaint in [(broken, "exit code 3: no such option"),
                                 (failing, "sort: cannot write"),
                                 (other, "no benchmark of both programs"),
                                 (good, "are one program"),
                                 (self.folder / "absent", "no such program")]:
            run, rows = self.compare(good, after, "--rounds", "2")
            self.assertEqual(run.returncode, 2, run.stderr)
            self.assertIn(complaint, run.stderr)
            self.assertNotIn("Traceback", run.stderr)
            self.assertEqual(rows, {})

    @unittest.skipUnless("ROUTEBENCH_BENCH" in os.environ, "the benchmarks are not built")
    def test_the_benchmarks_are_understood(self) -> None:
        program = Path(os.environ["ROUTEBENCH_BENCH"])
        copy = self.folder / "copy"
        copy.symlink_to(program)
        run, rows = self.compare(copy, program)
        self.assertEqual(run.returncode, 2)  # a link is no other program
        copy.unlink()
        copy.write_text(f'#!/bin/sh\nexec "{program}" "$@"\n', encoding="utf-8")
        copy.chmod(0o755)
        run, rows = self.compare(copy, program, "--rounds", "2", "--min-time", "0.001",
                                 "--filter", "shrink_by_a_line/(64|256)$")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(rows.keys(), {"shrink_by_a_line/64", "shrink_by_a_line/256"})


if __name__ == "__main__":
    unittest.main()
