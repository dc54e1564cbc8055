"""What the tests of Python planners and of the module share."""

import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = Path(os.environ["ROUTEBENCH_PROGRAM"])
PLANNERS = Path(__file__).parent / "planners"
SOURCE = Path(__file__).resolve().parents[2]
MODELS = Path(os.environ.get("ROUTEBENCH_MODELS", SOURCE.parent / "shared" / "models"))
"""Real meshes, which are not in the repository; see tests/support/models.hpp."""


class FolderTest(unittest.TestCase):
    """Tests that work in a folder of their own."""

    def setUp(self) -> None:
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)

    def call(self, *arguments: object, expect: int = 0) -> subprocess.CompletedProcess[str]:
        """Runs the program and checks its exit code."""
        done = subprocess.run(
            [PROGRAM, *map(str, arguments)],
            cwd=self.folder,
            capture_output=True,
            text=True,
            check=False,
            timeout=250,
        )
        self.assertEqual(done.returncode, expect, done.stderr)
        return done

    def run_experiment(self, text: str, expect: int) -> str:
        """Runs a config; returns what it says."""
        (self.folder / "experiment.toml").write_text(text, encoding="utf-8")
        done = self.call("run", "experiment.toml", "--out", "results", "--jobs", 2, expect=expect)
        return done.stderr

    def json_of(self, *arguments: object, expect: int = 0) -> dict:
        """What the program prints."""
        return json.loads(self.call(*arguments, expect=expect).stdout)
