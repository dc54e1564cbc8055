"""The page as a file: whole or not there, the same each time, complete, safe to open."""

from __future__ import annotations

import contextlib
import io
import json
import os
import re
import sqlite3
import subprocess
import sys
import tempfile
import unittest
from html.parser import HTMLParser
from pathlib import Path
from unittest import mock

from routebench_report import cli, libraries, markdown
from synthetic import Database, fill

PROGRAM = Path(os.environ["ROUTEBENCH_PROGRAM"])
NASTY = "a </script><img src=x onerror=alert(1)> & \"b\" | <!-- `c` **d**"
GCODE = "G21\nG90\nM83\nG1 X0 Y0 Z0.2 F3000\nG1 X10 E0.4\n"


class Outline(HTMLParser):
    """Elements, their attributes, and what a reader sees of a page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.words = ""
        self._hidden = 0
        self.feed(text)

    def handle_starttag(
        self, tag: str, attrs: list[tuple[str, str | None]]
    ) -> None:
        self.tags.append((tag, dict(attrs)))
        self._hidden += tag in ("script", "style")

    def handle_endtag(self, tag: str) -> None:
        self._hidden -= tag in ("script", "style")

    def handle_data(self, data: str) -> None:
        if not self._hidden:
            self.words += data

    def ids(self) -> list[str]:
        return [i for _, attrs in self.tags if (i := attrs.get("id"))]


class PageTestCase(unittest.TestCase):
    """A test with a folder of its own."""

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def call(self, *words: str) -> tuple[int, str, str]:
        """Exit code, stdout and stderr of a command."""
        out = io.TextIOWrapper(io.BytesIO(), encoding="utf-8")
        err = io.StringIO()
        with mock.patch.object(sys, "stdout", out):
            with contextlib.redirect_stderr(err):
                code = cli.main(words)
        out.flush()
        text = out.buffer.getvalue().decode()  # type: ignore[attr-defined]
        return code, text, err.getvalue()

    def make(self, *words: str) -> str:
        """The page that a command writes to page.html."""
        out = self.folder / "page.html"
        code, stdout, errors = self.call(*words[:1], f"--out={out}", *words[1:])
        self.assertEqual((code, errors), (0, ""))
        self.assertEqual(stdout, f"{out}\n")
        return out.read_text("utf-8")

    def results(self, models: list[str], contenders: list[str]) -> str:
        """A small experiment with a cell that crashed."""
        fill(
            self.folder / "results.sqlite",
            models,
            contenders,
            failures={(0, 1): ("crashed", "signal 11 <in> layer 3")},
            layers=4,
        )
        return str(self.folder)

    def assert_refused(self, code: int, out: str, err: str, why: str) -> None:
        """Exit code 2, one line on stderr, nothing on stdout."""
        self.assertEqual((code, out), (2, ""), err)
        self.assertRegex(err, r"\Aroutebench: [^\n]+\n\Z")
        self.assertIn(why, err)


class ReportTest(PageTestCase):
    """`routebench report`."""

    def test_has_all_parts(self) -> None:
        text = self.make("report", self.results(["m"], ["a", "b"]))
        outline = Outline(text)
        for part in ("summary", "outcomes", "viewer", "table", "figures", "provenance"):
            self.assertIn(part, outline.ids())
        self.assertEqual(len(outline.ids()), len(set(outline.ids())))
        self.assertIn("signal 11 <in> layer 3", outline.words)
        self.assertIn("1 of 2 cells are valid", outline.words)
        for name in ("outcomes", "bars-travel_mm", "layers-m"):
            self.assertIn(name, outline.words)
        self.assertNotIn("routes-m", outline.words)
        for _, attrs in outline.tags:
            for label in ("for", "aria-labelledby"):
                if target := attrs.get(label):
                    self.assertIn(target, outline.ids())

    def test_asks_for_nothing_from_anywhere(self) -> None:
        outline = Outline(self.make("report", self.results(["m"], ["a", "b"])))
        for tag, attrs in outline.tags:
            for name in ("src", "href", "action", "data", "poster"):
                if value := attrs.get(name):
                    self.assertRegex(value, r"\A(#|data:)", f"{tag} {name}")
        policy = next(
            attrs["content"]
            for tag, attrs in outline.tags
            if tag == "meta" and attrs.get("http-equiv") == "Content-Security-Policy"
        )
        assert policy is not None
        self.assertIn("default-src 'none'", policy)
        self.assertNotRegex(policy, r"https?:|\*")

    def test_names_are_never_markup(self) -> None:
        text = self.make("report", self.results([NASTY, "m"], [NASTY + "1", "b"]))
        outline = Outline(text)
        sources = [attrs.get("src") for tag, attrs in outline.tags if tag == "img"]
        self.assertNotIn("x", sources)
        shown = " ".join(outline.words.split())
        self.assertGreaterEqual(shown.count(" ".join(NASTY.split())), 3)
        data = re.search(r'id="data">(.*?)</script>', text, re.S)
        assert data is not None
        # A path goes by its end.
        self.assertIn(" ".join(NASTY.rpartition("/")[2].split()), json.loads(data[1])["models"])

    def test_equal_input_gives_equal_bytes(self) -> None:
        place = self.results(["m"], ["a", "b"])
        self.assertEqual(self.make("report", place), self.make("report", place))

    def test_default_place(self) -> None:
        place = self.results(["m"], ["a", "b"])
        code, out, _ = self.call("report", place)
        self.assertEqual((code, out), (0, f"{self.folder / 'report.html'}\n"))
        names = {path.name for path in self.folder.iterdir()}
        self.assertEqual(names, {"results.sqlite", "report.html"})

    def test_nothing_kept_still_makes_a_page(self) -> None:
        made = Database(self.folder / "results.sqlite")
        cell = made.cell(
            made.model("m"), made.contender("a"), made.setting(), {"travel_mm": 3.0}
        )
        made.layers(cell, [{"travel_mm": 3.0}])
        made.close()
        outline = Outline(self.make("report", str(self.folder)))
        self.assertIn("1 of 1 cells are valid", outline.words)

    def test_an_interrupted_page_leaves_the_earlier_one(self) -> None:
        place = self.results(["m"], ["a", "b"])
        before = self.make("view", "--no-open", place)
        for error in (KeyboardInterrupt(), OSError(28, "No space left on device")):
            with mock.patch.object(os, "replace", side_effect=error):
                code, out, err = self.call(
                    "view", "--no-open", f"--out={self.folder / 'page.html'}", place
                )
            self.assertIn(code, (2, 130))
            self.assertEqual(out, "")
            self.assertEqual(len(err.splitlines()), 1)
        names = {path.name for path in self.folder.iterdir()}
        self.assertEqual(names, {"results.sqlite", "page.html"})
        self.assertEqual((self.folder / "page.html").read_text("utf-8"), before)

    def test_bad_input(self) -> None:
        place = self.results(["m"], ["a", "b"])
        empty = self.folder / "empty"
        empty.mkdir()
        for words, why in (
            (["report", str(empty)], "no results database here"),
            (["report", place, "--baseline=c"], "no contender 'c'"),
            (["report", place, f"--out={empty}"], "is a folder"),
            (["report", place, "--out=/proc/no/page.html"], "cannot write a page"),
            (["report"], "required"),
            (["view", str(self.folder / "absent.gcode")], "no such file"),
        ):
            with self.subTest(words=words):
                self.assert_refused(*self.call(*words), why)
        self.assertEqual(list(empty.iterdir()), [])

    def change(self, sql: str) -> None:
        """Does to the results what no program would."""
        with contextlib.closing(
            sqlite3.connect(self.folder / "results.sqlite")
        ) as connection:
            connection.execute(sql)
            connection.commit()

    def test_a_route_that_goes_astray_costs_its_own_picture(self) -> None:
        place = self.results(["m"], ["a", "b"])
        kept = self.make("report", place).count('"kept":')
        self.change(
            "UPDATE route SET strokes_json = '[{\"kind\": \"wall\", \"width_mm\": 0.4, "
            "\"points\": [[0, 0], [9e5, 0]]}]' WHERE cell_id = 1"
        )
        self.assertEqual(self.make("report", place).count('"kept":'), kept - 1)

    def test_cells_of_nothing_are_refused(self) -> None:
        place = self.results(["m"], ["a", "b"])
        self.change("UPDATE cell SET model_id = 99")
        self.assert_refused(*self.call("report", place), "results.sqlite: is damaged")

    def test_where_there_is_no_room_nothing_is_left(self) -> None:
        place = self.results(["m"], ["a", "b"])
        out = self.folder / "new" / "page.html"
        with mock.patch.object(os, "replace", side_effect=OSError(28, "No space left")):
            self.assert_refused(
                *self.call("report", f"--out={out}", place),
                f"{out}: cannot write a page there: No space left",
            )
        self.assertFalse(out.parent.exists())

    def test_broken_strokes_are_named(self) -> None:
        place = self.results(["m"], ["a", "b"])
        self.change("UPDATE route SET strokes_json = '[{]'")
        self.assert_refused(
            *self.call("report", place), "route of cell 1, layer 2: broken strokes"
        )

    def test_says_which_package_is_missing(self) -> None:
        with mock.patch.object(libraries, "_PLACES", (self.folder / "none",)):
            self.assert_refused(
                *self.call("report", self.results(["m"], ["a", "b"])),
                "install the package libjs-three",
            )


class ViewTest(PageTestCase):
    """`routebench view`."""

    def gcode(self, name: str = "part.gcode") -> Path:
        file = self.folder / name
        file.write_text(GCODE)
        return file

    def test_gcode_beside_the_file(self) -> None:
        file = self.gcode()
        code, out, err = self.call("view", "--no-open", str(file))
        page = self.folder / "part.gcode.view.html"
        self.assertEqual((code, out, err), (0, f"{page}\n", ""))
        self.assertIn("viewer", Outline(page.read_text("utf-8")).ids())

    def test_results(self) -> None:
        outline = Outline(self.make("view", "--no-open", self.results(["m"], ["a", "b"])))
        self.assertIn("viewer", outline.ids())
        self.assertNotIn("table", outline.ids())

    def test_refuses_what_moves_nothing(self) -> None:
        file = self.folder / "notes.txt"
        for text in ("", "name = 'a'\n[task]\n", "dear diary\nG28\nG100 X1\n"):
            file.write_text(text)
            self.assert_refused(*self.call("view", "--no-open", str(file)), "no line of it is a move")
        self.assertEqual([path.name for path in self.folder.iterdir()], ["notes.txt"])
        file.write_text("n1 g01x3\n")
        self.assertEqual(self.call("view", "--no-open", str(file))[0], 0)

    def test_refuses_what_is_binary(self) -> None:
        file = self.folder / "part.stl"
        file.write_bytes(b"\0" * 200)
        self.assert_refused(
            *self.call("view", "--no-open", str(file)), "neither G-code nor results"
        )

    def test_opens_a_browser_only_where_there_is_a_screen(self) -> None:
        for screen, opened in (({}, 0), ({"DISPLAY": ":7"}, 1)):
            with (
                mock.patch.dict(os.environ, {"DISPLAY": "", "WAYLAND_DISPLAY": "", **screen}),
                mock.patch.object(cli.shutil, "which", return_value="/bin/opener"),
                mock.patch.object(cli.subprocess, "Popen") as started,
            ):
                self.call("view", str(self.gcode()))
                self.assertEqual(started.call_count, opened)
                self.call("view", "--no-open", str(self.gcode()))
                self.assertEqual(started.call_count, opened)


class CommandTest(PageTestCase):
    """The built program."""

    def run_program(self, *words: str) -> tuple[int, str, str]:
        done = subprocess.run(
            [str(PROGRAM), *words],
            capture_output=True,
            text=True,
            timeout=250,
            check=False,
        )
        return done.returncode, done.stdout, done.stderr

    def test_report_and_view(self) -> None:
        place = self.results(["m"], ["a"])
        for words, name in (
            (["report", place, "--baseline", "a"], "report.html"),
            (["view", "--no-open", place], "view.html"),
        ):
            code, out, err = self.run_program(*words)
            self.assertEqual((code, out, err), (0, f"{self.folder / name}\n", ""))

    def test_refusals_come_through(self) -> None:
        absent = str(self.folder / "absent")
        self.assert_refused(*self.run_program("report", absent), "no results database")
        self.assert_refused(*self.run_program("view", absent), "no such file")
        self.assert_refused(*self.run_program("view"), "INPUT is required")


class MarkdownTest(unittest.TestCase):
    """The little Markdown of summaries."""

    def test_blocks(self) -> None:
        made = markdown.to_html(
            "# One\n\ntwo\n*three* **four** `<five>`\n\n- six\n- seven\n\n"
            "| a | b |\n| :-- | --: |\n| x \\| y | 1 |\n"
        )
        self.assertIn("<h3>One</h3>", made)
        self.assertIn(
            "<p>two <em>three</em> <strong>four</strong> <code>&lt;five&gt;</code></p>", made
        )
        self.assertIn("<ul><li>six</li><li>seven</li></ul>", made)
        self.assertIn('<td>x | y</td><td class="number">1</td>', made)

    def test_escaped_is_text(self) -> None:
        made = markdown.to_html("\\<b\\> \\*\\*not bold\\*\\* 2 * 3 * 4 \\`no code\\`")
        self.assertEqual(made, "<p>&lt;b&gt; **not bold** 2 * 3 * 4 `no code`</p>")


if __name__ == "__main__":
    unittest.main()
