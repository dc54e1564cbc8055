"""The scripts of experiments/python run, in order, as their reader would run them."""

import json
import os
import subprocess
import sys
import unittest

from support import MODELS, PROGRAM, SOURCE, FolderTest

SCRIPTS = SOURCE / "experiments" / "python"


class ScriptsTest(FolderTest):
    """First score, own planner, own plot."""

    def script(self, name: str, *arguments: str) -> str:
        path = f"{PROGRAM.parent}{os.pathsep}{os.environ['PATH']}"
        done = subprocess.run(
            [sys.executable, "-B", SCRIPTS / name, *arguments],
            cwd=self.folder,
            env={**os.environ, "PATH": path},
            capture_output=True,
            text=True,
            check=False,
        )
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_a_first_score(self) -> None:
        said = self.script("first_score.py")
        self.assertEqual(said.count("\nvalid "), 3, said)

    def test_an_own_planner_and_a_plot_of_what_it_did(self) -> None:
        said = self.script("own_planner.py", "own")
        self.assertIn("lines on layer 10", said)
        self.assertIn("\nvalid, travel ", said)
        self.script("own_plot.py", "own/results", "travel.png")
        picture = (self.folder / "travel.png").read_bytes()
        self.assertTrue(picture.startswith(b"\x89PNG"))

    def test_the_example_planner_keeps_its_promises(self) -> None:
        checked = self.json_of(
            "check-planner", "diagonals", "--plugin", SCRIPTS / "diagonals.py", "--json", "-"
        )
        self.assertEqual([c["name"] for c in checked["checks"] if c["failures"]], [])

    @unittest.skipUnless(MODELS.is_dir(), f"no real models at {MODELS}")
    def test_the_example_planner_does_its_task_on_a_real_part(self) -> None:
        said = self.run_experiment(
            f"""
name = "real"
models = ["{MODELS}/functional/mk3_x_carriage.stl"]
plugins = ["{SCRIPTS}/diagonals.py"]
[task]
layer_height_mm = 0.3
[run]
repetitions = 1
[[contender]]
name = "diagonals"
shell = {{ planner = "greedy_shell" }}
fill = {{ planner = "diagonals" }}
[[contender]]
name = "rectilinear"
shell = {{ planner = "greedy_shell" }}
fill = {{ planner = "rectilinear" }}
""",
            expect=0,
        )
        events = [json.loads(line) for line in said.splitlines()]
        outcomes = [event["outcome"] for event in events if "outcome" in event]
        self.assertEqual(outcomes, ["valid", "valid"])


if __name__ == "__main__":
    unittest.main()
