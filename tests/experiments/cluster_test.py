"""Shards as a cluster runs them, joined, are the whole experiment."""

import os
import shutil
import sqlite3
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
CLUSTER = SOURCE / "experiments" / "cluster"
PROGRAM = os.environ["ROUTEBENCH_PROGRAM"]
SHARDS = 3

CONFIG = """
name = "cluster"
models = ["shape:box?size=6", "shape:gear?size=12"]
[task]
layer_height_mm = 0.4
line_width_mm = 0.8
[run]
repetitions = 1
[[contender]]
name = "lines"
shell = { planner = "greedy_shell" }
fill = { planner = "rectilinear", angle_deg = [0, 45] }
"""


def routes(database: Path) -> list[tuple[str, ...]]:
    """Every current cell with its outcome and route."""
    connection = sqlite3.connect(database)
    try:
        return connection.execute(
            "SELECT spec, name, outcome, route_hash FROM current_cell "
            "JOIN model USING(model_id) JOIN contender USING(contender_id) ORDER BY 1, 2"
        ).fetchall()
    finally:
        connection.close()


class ClusterTest(unittest.TestCase):
    """Runs the scripts of experiments/cluster on this machine."""

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        (self.folder / "cluster.toml").write_text(CONFIG, encoding="utf-8")
        whole = self.run_here(PROGRAM, "run", "cluster.toml", "--out", "whole")
        self.assertLessEqual(whole.returncode, 1, whole.stderr)
        self.expected = routes(self.folder / "whole" / "results.sqlite")
        self.assertEqual(len(self.expected), 4)

    def run_here(
        self, *words: str, **environment: str
    ) -> subprocess.CompletedProcess[str]:
        """Runs a command in the folder."""
        return subprocess.run(
            words,
            cwd=self.folder,
            env={**os.environ, "ROUTEBENCH": PROGRAM, **environment},
            capture_output=True,
            text=True,
            check=False,
        )

    def test_slurm_scripts(self) -> None:
        """What Slurm would set is set here, so that no Slurm is needed."""
        array = str(CLUSTER / "slurm_array.sbatch")
        merge = str(CLUSTER / "slurm_merge.sbatch")
        for number in range(1, SHARDS + 1):
            shard = self.run_here(
                array,
                "cluster.toml",
                "parts",
                str(SHARDS),
                SLURM_ARRAY_TASK_ID=str(number),
            )
            self.assertEqual(shard.returncode, 0, shard.stderr)
        merged = self.run_here(merge, "merged", "parts", str(SHARDS))
        self.assertEqual(merged.returncode, 0, merged.stderr)
        self.assertEqual(routes(self.folder / "merged" / "results.sqlite"), self.expected)
        self.assertEqual(self.run_here(array, "cluster.toml").returncode, 2)
        self.assertEqual(self.run_here(merge, "merged").returncode, 2)
        lost = self.run_here(array, "none.toml", "parts", "1", SLURM_ARRAY_TASK_ID="1")
        self.assertEqual(lost.returncode, 2, lost.stderr)

    @unittest.skipUnless(shutil.which("snakemake"), "snakemake is not installed")
    def test_snakefile(self) -> None:
        """Snakemake makes the parts and joins them; called again it has nothing to do."""
        words = [
            "snakemake",
            "-s",
            str(CLUSTER / "Snakefile"),
            "--cores",
            "2",
            "--config",
            "experiment=cluster.toml",
            "out=merged",
            f"shards={SHARDS}",
            f"routebench={PROGRAM}",
        ]
        made = self.run_here(*words, HOME=str(self.folder))
        self.assertEqual(made.returncode, 0, made.stderr)
        self.assertEqual(routes(self.folder / "merged" / "results.sqlite"), self.expected)
        again = self.run_here(*words, HOME=str(self.folder))
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertIn("Nothing to be done", again.stdout + again.stderr)


if __name__ == "__main__":
    unittest.main()
