"""The documentation tells the truth: its commands run, its tables are complete."""

import json
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
PROGRAM = Path(os.environ["ROUTEBENCH_PROGRAM"])
MODULE = next(
    PROGRAM.parent.parent.glob("python/routebench/_routebench*.so"), Path("not_built/not_built/x")
)


def shell_blocks(page: Path) -> list[str]:
    """The blocks of a page that are marked ```sh, in order."""
    return re.findall(r"^```sh\n(.*?)^```$", page.read_text(encoding="utf-8"), re.M | re.S)


def python_files(page: Path) -> dict[str, str]:
    """The blocks of a page that are marked ```python and begin with `# FILE.py`."""
    blocks = re.findall(r"^```python\n(.*?)^```$", page.read_text(encoding="utf-8"), re.M | re.S)
    return {re.match(r"# (\w+\.py)\n", block).group(1): block for block in blocks}


class CommandsTest(unittest.TestCase):
    """Runs every command of a page as its reader would, in an empty folder."""

    def test_commands_of_the_readme_run(self) -> None:
        blocks = shell_blocks(SOURCE / "README.md")
        self.assertGreater(len(blocks), 4)
        with tempfile.TemporaryDirectory() as folder:
            shutil.copytree(SOURCE / "experiments", Path(folder) / "experiments")
            self.run_blocks(blocks, folder)

    @unittest.skipUnless(MODULE.is_file(), "the Python module is not built here")
    def test_commands_of_the_page_on_planners_run(self) -> None:
        page = SOURCE / "planners" / "README.md"
        # What compiles a plugin needs an installed routebench: the package test does that.
        blocks = [block for block in shell_blocks(page) if "cmake" not in block]
        files = python_files(page)
        self.assertGreaterEqual(len(blocks), 4)
        self.assertGreaterEqual(len(files), 3)
        with tempfile.TemporaryDirectory() as folder:
            for name, text in files.items():
                (Path(folder) / name).write_text(text, encoding="utf-8")
            self.run_blocks(blocks, folder)

    def run_blocks(self, blocks: list[str], folder: str) -> None:
        """Runs blocks one after the other with this program and Debian's Python."""
        # Wherever `python3` may lead, it shall be the one that the module was built for.
        with tempfile.TemporaryDirectory() as links:
            (Path(links) / "python3").symlink_to("/usr/bin/python3")
            path = os.pathsep.join([links, str(PROGRAM.parent), os.environ["PATH"]])
            for block in blocks:
                with self.subTest(block=block):
                    done = subprocess.run(
                        ["bash", "-euo", "pipefail", "-c", block],
                        cwd=folder,
                        env={**os.environ, "PATH": path, "PYTHONPATH": str(MODULE.parents[1])},
                        capture_output=True,
                        text=True,
                        check=False,
                    )
                    self.assertEqual(done.returncode, 0, done.stderr)


class TablesTest(unittest.TestCase):
    """Compares the README's tables with what the program knows."""

    def test_every_metric_is_explained(self) -> None:
        readme = (SOURCE / "README.md").read_text(encoding="utf-8")
        source = (SOURCE / "harness" / "src" / "metrics.cpp").read_text(encoding="utf-8")
        names = re.findall(r'MetricInfo\{\s*"(\w+)"', source)
        self.assertGreater(len(names), 20)
        self.assertEqual([name for name in names if f"`{name}`" not in readme], [])

    def test_every_key_of_a_config_is_explained(self) -> None:
        page = (SOURCE / "experiments" / "README.md").read_text(encoding="utf-8")
        source = SOURCE / "harness" / "src"
        config = (source / "config.cpp").read_text(encoding="utf-8")
        lists = re.findall(r"k(?:Top|Run|Contender)Keys\{(.*?)\};", config, re.S)
        self.assertEqual(len(lists), 3)
        keys = re.findall(r'"(\w+)"', " ".join(lists))
        task = (source / "task.cpp").read_text(encoding="utf-8")
        keys += re.findall(r'visit\("(\w+)"', task)
        self.assertGreater(len(keys), 40)
        missing = [key for key in keys if f"`{key}`" not in page]
        self.assertEqual(
            missing, ["task", "printer", "run", "claim", "published"]
        )

    def test_every_planner_and_parameter_is_explained(self) -> None:
        page = (SOURCE / "planners" / "README.md").read_text(encoding="utf-8")
        examples = []
        for source in (SOURCE / "planners" / "examples").glob("*.cpp"):
            plugin = PROGRAM.parents[1] / "tests" / "planners" / "plugins" / f"{source.stem}.so"
            examples += ["--plugin", plugin]
        self.assertGreater(len(examples), 2)
        listed = subprocess.run(
            [PROGRAM, "planners", "--json", *examples], capture_output=True, text=True, check=True
        ).stdout
        planners = json.loads(listed)["planners"]
        self.assertGreater(len(planners), 1)
        for planner in planners:
            with self.subTest(planner=planner["name"]):
                section = page.split(f"## `{planner['name']}`\n")[1].split("\n## ")[0]
                names = [parameter["name"] for parameter in planner["params"]]
                self.assertEqual([name for name in names if f"`{name}`" not in section], [])

    def test_every_command_is_mentioned(self) -> None:
        readme = (SOURCE / "README.md").read_text(encoding="utf-8")
        usage = subprocess.run(
            [PROGRAM, "--help"], capture_output=True, text=True, check=True
        ).stdout
        commands = re.findall(r"^  (\w[\w-]*) {2,}\w", usage, re.M)
        self.assertGreater(len(commands), 5)
        missing = [name for name in commands if f"routebench {name}" not in readme]
        self.assertEqual(missing, [])


if __name__ == "__main__":
    unittest.main()
