"""Planners in Python files and planners that are programs, through the program's commands."""

import os
import sqlite3
import subprocess
import unittest

from support import PLANNERS, FolderTest

CULPRIT = PLANNERS / "culprit.py"
PROGRAM_PLANNER = f"/usr/bin/python3 {PLANNERS / 'program.py'}"
HEAD = """
name = "crimes"
models = ["shape:box?size=6"]
{plugins}
[task]
perimeters = 0
skin_layers = 0
density = 0.4
layer_height_mm = 0.3
gate_deposit_max = 2
gate_deposit_min = 0.5
[run]
repetitions = 2
timeout_s = 15
memory_mb = 600
"""


class CellsTest(FolderTest):
    """Whatever a planner does costs its own cell, which says what was done."""

    def outcomes(self, contenders: dict[str, str], plugins: str) -> dict[str, tuple[str, str]]:
        """Runs contenders, given with their fill; returns outcome and reason of each."""
        text = HEAD.format(plugins=plugins) + "".join(
            f'[[contender]]\nname = "{name}"\nfill = {fill}\n' for name, fill in contenders.items()
        )
        self.last_run = self.run_experiment(text, expect=1)
        with sqlite3.connect(self.folder / "results" / "results.sqlite") as database:
            rows = database.execute(
                "SELECT name, outcome, reason FROM current_cell JOIN contender USING(contender_id)"
            ).fetchall()
        self.assertEqual(len(rows), len(contenders))
        return {name: (outcome, reason) for name, outcome, reason in rows}

    def expect_outcomes(
        self, expected: dict[str, tuple[str, str]], found: dict[str, tuple[str, str]]
    ) -> None:
        for crime, (outcome, reason) in expected.items():
            with self.subTest(crime=crime):
                self.assertEqual(found[crime][0], outcome, found[crime][1])
                self.assertRegex(found[crime][1], reason)
                self.assertNotIn("\n", found[crime][1])

    def test_a_python_planner_misbehaves(self) -> None:
        place = "^planner py_culprit, layer 1: "
        expected = {
            "none": ("valid", "^$"),
            "print": ("valid", "^$"),
            "chatter": ("valid", "^$"),
            "sleep": ("valid", "^$"),
            "throw": ("failed", place + r"ValueError: no mood \(culprit.py, line \d+\)"),
            "nan": ("failed", place + r"stroke 0 has point 0 at \(nan, .*must be finite"),
            "shape": ("failed", place + r"stroke 0 has an array of shape \(4, 3\)"),
            "ragged": ("failed", place + "stroke 0 is no array of numbers"),
            "words": ("failed", place + "plan returned str; it must return a list of strokes"),
            "number": ("failed", place + "plan returned int"),
            "width": ("failed", place + "stroke 0 has no number as width_mm"),
            "thin": ("failed", place + "stroke 0 of the returned route has the width -1"),
            "write": ("failed", place + "ValueError: assignment destination is read-only"),
            "loop": ("timed_out", "^no result after 15 s while planning layer 1"),
            "exit": ("crashed", place + "its process ended with exit code 3 before it answered"),
            "kill": ("crashed", place + "its process died of SIGSEGV .*it last wrote: farewell"),
            "hoard": ("out_of_memory", "^more than 600 MB wanted while planning layer 1"),
            "moody": ("failed", "^not deterministic: repetition"),
        }
        if os.environ.get("ROUTEBENCH_SANITIZE"):
            del expected["hoard"]  # a sanitized program cannot limit memory
        found = self.outcomes(
            {crime: f'{{ planner = "py_culprit", crime = "{crime}" }}' for crime in expected},
            f'plugins = ["{CULPRIT}"]',
        )
        self.expect_outcomes(expected, found)

    def test_a_program_misbehaves(self) -> None:
        place = "^planner command:.*, layer 1: "
        expected = {
            "none": ("valid", "^$"),
            "exit": ("crashed", place + "its process ended with exit code 7 .*: my last words"),
            "rubbish": (
                "failed",
                place + "line 3 of its output: it is not JSON: 'Planning...'; it last wrote: hello",
            ),
            "half": ("crashed", place + "its process ended .* in the middle of a line"),
            "list": ("failed", place + r"line 3 of its output: it is JSON, but no object"),
            "nothing": ("failed", place + 'line 3 of its output: the list "strokes" is missing'),
            "complain": ("failed", place + "this layer is ugly"),
            "silent": ("timed_out", "^no result after 15 s while planning layer 1"),
            "close": ("crashed", place + "its process closed its output before it answered"),
            "point": ("failed", place + "line 3 .*stroke 0: point 1 is no pair of numbers"),
            "far": ("failed", place + "stroke 0 .* within a kilometre"),
        }
        found = self.outcomes(
            {crime: f'{{ command = "{PROGRAM_PLANNER} {crime}" }}' for crime in expected}, ""
        )
        self.expect_outcomes(expected, found)


    def test_a_command_that_is_no_planner_costs_only_what_needs_it(self) -> None:
        refused = "^planner command:.*, layer 0: it was refused: "
        expected = {
            "missing": ("failed", refused + "cannot be started: ./late: No such file"),
            "never": ("failed", refused + "its process ended with exit code 1 before it answered"),
            "version": ("failed", refused + ".*it speaks protocol 2"),
            "bars": ("valid", "^$"),
        }
        commands = {name: f"{PROGRAM_PLANNER} {name}" for name in expected}
        commands |= {
            "missing": f"./late {PLANNERS / 'program.py'}",
            "bars": f"{PROGRAM_PLANNER} none",
        }
        contenders = {name: f'{{ command = "{text}" }}' for name, text in commands.items()}
        self.expect_outcomes(expected, self.outcomes(contenders, ""))
        complaints = [
            line for line in self.last_run.splitlines() if line.startswith("routebench: warning: ")
        ]
        self.assertEqual(len(complaints), 3, self.last_run)
        for name in ("missing", "never", "version"):
            self.assertEqual(sum(commands[name] in line for line in complaints), 1, name)

        # What can be started at last is executed, and the rest is not.
        self.outcomes(contenders, "")
        self.assertIn("4 of 4 cells are in the database already", self.last_run)
        (self.folder / "late").symlink_to("/usr/bin/python3")
        found = self.outcomes(contenders, "")
        self.assertEqual(found["missing"], ("valid", ""))
        self.assertIn("executing 1 cells", self.last_run)
        self.assertIn("the plugin of its planner had been refused", self.last_run)


class LoadingTest(FolderTest):
    """Files and commands that are no planners are refused in one line."""

    def refused(self, *arguments: object) -> str:
        done = self.call(*arguments, expect=2)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        return done.stderr

    def refusal_of(self, text: str) -> str:
        (self.folder / "own.py").write_text(text, encoding="utf-8")
        return self.refused("plan", "shape:box", "--fill", "own", "--plugin", "own.py")

    def test_a_file_without_a_planner(self) -> None:
        self.assertIn("no such file", self.refused("planners", "--plugin", "missing.py"))
        self.assertIn("defines no class with a name", self.refusal_of("x = 1\n"))
        self.assertRegex(
            self.refusal_of("x = 1\ny = x / 0\n"),
            r"loading own.py failed: ZeroDivisionError: .* \(own.py, line 2\)",
        )
        self.assertIn("SyntaxError", self.refusal_of("class\n"))
        self.assertIn("ended with exit code 4", self.refusal_of("import sys\nsys.exit(4)\n"))

    def test_a_planner_that_declares_nonsense(self) -> None:
        planner = (
            "from routebench.planner import Planner, Real, Choice\n"
            "class Own(Planner):\n    name = 'own'\n"
        )
        self.assertIn("must be shell or fill", self.refusal_of(planner + "    role = 'hull'\n"))
        self.assertIn(
            "outside of its own range", self.refusal_of(planner + "    x = Real(5, 0, 1)\n")
        )
        self.assertIn(
            "none of its", self.refusal_of(planner + "    x = Choice(['a'], default='b')\n")
        )
        self.assertIn("snake_case", self.refusal_of(planner.replace("'own'", "'My Own'")))
        self.assertIn("is taken (built in)", self.refusal_of(planner.replace("'own'", "'voxel'")))

    def test_a_command_that_is_no_planner(self) -> None:
        def refusal(crime: str) -> str:
            name = f"command:{PROGRAM_PLANNER} {crime}"
            return self.refused("plan", "shape:box", "--fill", name)

        self.assertIn("ended with exit code 1", refusal("never"))
        self.assertIn("it last wrote: I will not start", refusal("never"))
        self.assertIn("it speaks protocol 2; this program speaks 1", refusal("version"))
        self.assertIn('the key "role" is missing', refusal("no_role"))
        self.assertIn("outside of its own range", refusal("bad_default"))
        self.assertIn("a command must be one", refusal("two"))
        for name, reason in (
            ("command:no_such_program", "cannot be started: no_such_program: No such file"),
            ("command:", "no word in it that names a program"),
            ("command:python3 'x", "a quote is not closed"),
        ):
            self.assertIn(reason, self.refused("planners", name))

    def test_parameters_are_checked_like_those_of_other_planners(self) -> None:
        def refusal(setting: str) -> str:
            return self.refused(
                "plan", "shape:box", "--fill", "py_culprit", "--plugin", CULPRIT, "--set", setting
            )

        self.assertIn("did you mean 'crime'", refusal("fill.crimes=none"))
        self.assertIn("it must be a number from 0 to 1 mm", refusal("fill.share=2"))
        self.assertIn("it must be a whole number from 1 to 5", refusal("fill.count=2.5"))
        self.assertIn("it must be true or false", refusal("fill.flag=1"))
        self.assertIn("did you mean 'throw'", refusal("fill.crime=throws"))

    def test_a_slot_with_a_command_needs_nothing_else(self) -> None:
        def refusal(fill: str) -> str:
            text = HEAD.format(plugins="") + f'[[contender]]\nname = "a"\nfill = {fill}\n'
            (self.folder / "a.toml").write_text(text, encoding="utf-8")
            return self.refused("run", "a.toml")

        self.assertIn(
            "the slot has a `planner`, too", refusal('{ command = "x", planner = "voxel" }')
        )
        self.assertRegex(
            refusal("{ command = \"python3 'x\" }"),
            r"a.toml:\d+: key `fill.command`: .*a quote is not closed",
        )
        self.assertRegex(
            refusal('{ command = "" }'), r"a.toml:\d+: key `fill.command`: .*no word in it"
        )
        self.assertRegex(
            refusal(f'{{ command = "{PROGRAM_PLANNER}", angle = 3 }}'),
            r"a.toml:\d+: key `fill.angle`: planner command:.*unknown parameter 'angle'",
        )

    def test_planners_shows_what_is_declared(self) -> None:
        found = self.json_of("planners", "py_culprit", "--plugin", CULPRIT, "--json")
        self.assertEqual(found["role"], "fill")
        self.assertEqual(found["source"], "nobody, 2000")
        self.assertEqual(found["origin"], str(CULPRIT))
        params = {param["name"]: param for param in found["params"]}
        self.assertEqual(list(params), ["crime", "share", "count", "flag"])
        self.assertEqual(
            (params["share"]["default"], params["share"]["unit"], params["count"]["highest"]),
            (0.5, "mm", 5),
        )
        plugins = self.json_of("planners", "--plugin", CULPRIT, "--json")["plugins"]
        self.assertRegex(plugins[0]["build_id"], r"^python 3\.\d+\.\d+, numpy ")
        self.assertRegex(plugins[0]["sha256"], "^[0-9a-f]{64}$")


class PlanTest(FolderTest):
    """What comes out of planning."""

    def test_waiting_counts_as_planning(self) -> None:
        document = self.json_of(
            "plan", "shape:box?size=6", "--fill", "py_culprit", "--plugin", CULPRIT,
            "--set", "fill.crime=sleep", "--layers", "1", "--json", "-", expect=1,
        )
        self.assertGreater(document["totals"]["plan_wall_ns"], 300_000_000)

    def test_the_same_routes_on_any_number_of_threads(self) -> None:
        def layers(jobs: int) -> list:
            document = self.json_of(
                "plan", "shape:gear", "--fill", "py_culprit", "--plugin", CULPRIT,
                "--jobs", jobs, "--json", "-", expect=1,
            )
            for layer in document["per_layer"]:
                del layer["plan_wall_ns"], layer["plan_cpu_ns"]
            return document["per_layer"]

        self.assertEqual(layers(1), layers(3))

    def test_a_changed_file_is_planned_anew_and_an_unchanged_one_is_not(self) -> None:
        text = CULPRIT.read_text(encoding="utf-8")
        (self.folder / "own.py").write_text(text, encoding="utf-8")
        config = HEAD.format(plugins='plugins = ["own.py"]')
        config += '[[contender]]\nname = "a"\nfill = { planner = "py_culprit" }\n'
        first = self.run_experiment(config, expect=0)
        self.assertIn("executing 1 cells", first)
        self.assertIn("1 of 1 cells are in the database already", self.run_experiment(config, 0))
        (self.folder / "own.py").write_text(text + "# other\n", encoding="utf-8")
        self.assertIn("executing 1 cells", self.run_experiment(config, expect=0))

    def test_a_failing_planner_leaves_no_file(self) -> None:
        done = self.call(
            "plan", "shape:box?size=6", "--fill", "py_culprit", "--plugin", CULPRIT,
            "--set", "fill.crime=exit", "--gcode", "box.gcode", expect=1,
        )
        self.assertRegex(done.stdout, "outcome +crashed: planner py_culprit, layer 1")
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_no_process_is_left_behind(self) -> None:
        name = "left_behind_planner.py"
        (self.folder / name).write_text(CULPRIT.read_text(encoding="utf-8"), encoding="utf-8")
        config = HEAD.format(plugins=f'plugins = ["{name}"]')
        config = config.replace("timeout_s = 15", "timeout_s = 2")
        config += '[[contender]]\nname = "a"\nfill = { planner = "py_culprit", crime = "loop" }\n'
        self.run_experiment(config, expect=1)
        listed = subprocess.run(["ps", "-eo", "args"], capture_output=True, text=True, check=True)
        self.assertNotIn(str(self.folder / name), listed.stdout)


class ConformanceTest(FolderTest):
    """`check-planner` looks at a command like at any planner."""

    def test_a_program_is_checked_like_any_planner(self) -> None:
        found = self.json_of(
            "check-planner", f"command:{PROGRAM_PLANNER}", "--json", "-", expect=1
        )
        failures = {check["name"]: check["failures"] for check in found["checks"]}
        for promise in ("pure", "stops", "strokes", "moves"):
            self.assertEqual(failures[promise], [], promise)
        # It fills the box round each polygon, holes or not.
        self.assertNotEqual(failures["inside"], [])


if __name__ == "__main__":
    unittest.main()
