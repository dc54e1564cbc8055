"""`routebench plot` as a user calls it."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from synthetic import fill

PACKAGE = (
    Path(__file__).resolve().parents[2] / "experiments" / "routebench_plots"
)


class PlotCommandTest(unittest.TestCase):
    """The built program, which ROUTEBENCH_PROGRAM names."""

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.program = Path(os.environ["ROUTEBENCH_PROGRAM"])

    def run_program(
        self, *command: str | Path
    ) -> subprocess.CompletedProcess[str]:
        """Runs a command to its end."""
        return subprocess.run(
            [str(word) for word in command],
            capture_output=True,
            text=True,
            timeout=250,
            check=False,
        )

    def assert_refused(
        self, done: subprocess.CompletedProcess[str], why: str
    ) -> None:
        """Exit code 2, one line on stderr, nothing on stdout."""
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(done.stdout, "")
        self.assertRegex(done.stderr, r"\Aroutebench: [^\n]+\n\Z")
        self.assertIn(why, done.stderr)

    def results(self, name: str) -> Path:
        """A folder with a small experiment."""
        place = self.folder / name
        place.mkdir()
        fill(place / "results.sqlite", ["m"], ["a"], layers=2)
        return place

    def test_plots_a_folder(self) -> None:
        place = self.results("one; two $HOME")
        done = self.run_program(
            self.program, "plot", place, "--formats=png", "--metrics=covered"
        )
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stderr, "")
        files = [Path(line) for line in done.stdout.splitlines()]
        self.assertEqual(files[0], place / "plots" / "outcomes.png")
        for file in files:
            self.assertTrue(file.is_file(), file)

    def test_output_that_goes_nowhere_is_told_in_one_line(self) -> None:
        place = self.results("r")
        words = f"'{self.program}' gate {place} {place}"
        for where in (">&-", ">/dev/full"):
            with self.subTest(where=where):
                done = self.run_program("sh", "-c", f"{words} {where}")
                self.assert_refused(done, "standard output: cannot be written: ")

    def test_refuses_what_is_not_there(self) -> None:
        absent = self.folder / "absent"
        done = self.run_program(self.program, "plot", absent)
        self.assert_refused(done, "absent: no results database here")

    def test_refuses_bad_usage(self) -> None:
        self.assert_refused(self.run_program(self.program, "plot"), "RESULTS is required")
        place = self.results("r")
        done = self.run_program(
            self.program, "plot", place, "--formats", "gif"
        )
        self.assert_refused(done, "'gif' is none of png, svg, pdf")
        done = self.run_program(
            self.program, "plot", place, "--metrics", "travel"
        )
        self.assert_refused(done, "did you mean 'travel_mm'?")

    def test_prefers_the_package_beside_an_installed_program(self) -> None:
        (self.folder / "bin").mkdir()
        program = self.folder / "bin" / "routebench"
        shutil.copy(self.program, program)
        for libraries in self.program.resolve().parents[1].glob("lib*"):
            (self.folder / libraries.name).symlink_to(libraries)
        package = self.folder / "share" / "routebench" / "routebench_plots"
        package.mkdir(parents=True)
        (package / "__main__.py").write_text(
            "import sys\nprint(sys.argv[1:])\nsys.exit(1)\n"
        )
        done = self.run_program(program, "plot", "--out=-o", "--", "-r")
        self.assertEqual(done.returncode, 1, "the child's code is passed on")
        self.assertEqual(
            done.stdout, "['--out=-o', '--formats=png,svg', '--', '-r']\n"
        )

    def test_a_python_without_matplotlib(self) -> None:
        """-S keeps Python from the folders where packages are."""
        done = self.run_program(
            sys.executable, "-I", "-S", PACKAGE / "__main__.py", self.folder
        )
        self.assert_refused(done, "install the package python3-matplotlib")

    def test_no_home(self) -> None:
        """Neither a cache nor a warning about one is left anywhere."""
        place = self.results("r")
        done = subprocess.run(
            [
                self.program,
                "plot",
                place,
                "--formats=png",
                "--metrics=covered",
            ],
            capture_output=True,
            text=True,
            timeout=250,
            check=False,
            env={"HOME": "/proc/nowhere", "PATH": "/usr/bin"},
        )
        self.assertEqual((done.returncode, done.stderr), (0, ""))


if __name__ == "__main__":
    unittest.main()
