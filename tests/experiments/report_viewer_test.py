"""The route viewer in a real browser, from disk and without network."""

from __future__ import annotations

import json
import math
import os
import sqlite3
import subprocess
import tempfile
import unittest
from contextlib import closing
from pathlib import Path
from typing import Any, ClassVar
from urllib.parse import urlencode

import numpy as np
from numpy.typing import NDArray

from browser import Browser, needs_browser
from routebench_report import cli
from synthetic import Database, made_up_layers, made_up_scores, plate_strokes

PROGRAM = Path(os.environ["ROUTEBENCH_PROGRAM"])
LAYERS = 6
PRINTER = {
    "retract_policy": "length",
    "retract_over_mm": 2,
    "extrude_mm_s": 60,
    "travel_mm_s": 150,
    "accel_mm_s2": 1000,
    "junction_mm": 0.013,
}
CANVAS = "#v-canvas"

# Every way of a file to say where the head goes; lengths are worked out by hand below.
GCODE = """\
; made by hand
M82
G21
G90
G92 E0
G1 F6000
G0 X0 Y0 Z0.2
;LAYER_CHANGE
;TYPE:External perimeter
;WIDTH:0.5
G1 X10 Y0 E1 F1800
G3 X10 Y10 I0 J5 E2
G1 E1.2
G0 X0 Y10
G1 E2
;TYPE:Internal infill
G1 X0 Y20 E3
M83
G91
G1 X5 E0.5
G90
G10
G0 X20 Y20
G0 X20 Y0
G11
G1 X30 Y0 E1
G20
G1 X2 Y0 E0.1
G21
G92 X0 Y0
;LAYER_CHANGE
G0 Z0.4
;TYPE:Skirt/Brim
G1 X10 Y0 E1
G2 X20 Y0 R5 E1
G2 X20 Y0 I-5 E2
M82
G92 E5
G1 X20 Y1 E5.5
G1 X21 Y1
"""
INCHES_MM = 2 * 25.4 - 30
FIRST_LAYER = {
    "extrudeMm": 10 + 5 * math.pi + 10 + 5 + 10 + INCHES_MM,
    # To (0, 10), then to (20, 20) and (20, 0) at one go.
    "travelMm": 10 + 15 + 20,
    "travels": 2,
    "retractions": 2,
    "crossings": 0,
}
SECOND_LAYER = {
    "extrudeMm": 10 + 5 * math.pi + 10 * math.pi + 1,
    "travelMm": 0,
    "travels": 0,
    "retractions": 0,
    "crossings": 0,
}


def stack(folder: Path, kept: range = range(LAYERS)) -> Path:
    """An experiment of two models whose layers' routes differ."""
    made = Database(folder / "results.sqlite")
    settings = [made.setting("density=0.2"), made.setting("density=0.4")]
    made.execute("UPDATE setting SET printer_json = ?", json.dumps(PRINTER))
    models = [made.model("parts/plate.stl"), made.model("parts/other.stl")]
    contenders = [made.contender(name) for name in ("lines", "linked", "broken")]
    for model in models:
        for layer in kept:
            made.shape(model, layer)
    for setting in settings:
        for model in models:
            for contender in contenders:
                if contender == 3:
                    made.cell(
                        model, contender, setting, None, "crashed", "signal 11"
                    )
                    continue
                cell = made.cell(
                    model, contender, setting, made_up_scores(model, contender)
                )
                made.layers(cell, made_up_layers(model, contender, LAYERS))
                made.execute(
                    "UPDATE cell SET layers = ? WHERE cell_id = ?", LAYERS, cell
                )
                for layer in kept:
                    strokes = plate_strokes(
                        100 * cell + layer, 1.2 + 0.3 * layer, contender == 2
                    )
                    made.route(cell, layer, strokes)
    made.close()
    return folder


def make(command: str, source: Path, out: Path) -> Path:
    """The page of a command."""
    words = [command, f"--out={out}", str(source)]
    if command == "view":
        words.insert(1, "--no-open")
    assert cli.main(words) == 0
    return out


def link(**wishes: object) -> str:
    """The address of a place in the viewer."""
    return f"#{urlencode({'model': 'parts/plate.stl', **wishes})}"


@needs_browser
class BrowserTestCase(unittest.TestCase):
    """Tests that share a browser; a page may not complain of anything."""

    browser: ClassVar[Browser]
    folder: ClassVar[Path]

    @classmethod
    def setUpClass(cls) -> None:
        holder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(holder.cleanup)
        cls.folder = Path(holder.name)
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.close)

    def tearDown(self) -> None:
        self.assertEqual(self.browser.complaints(), [])

    def open(self, page: Path, hash_: str = "") -> None:
        """A page as if it had never been open before."""
        self.browser.open(self.blank())
        self.browser.open(page, hash_)

    def blank(self) -> Path:
        page = self.folder / "blank.html"
        page.write_text(
            "<!DOCTYPE html><html data-ready='yes'><meta charset=utf-8>"
            "<link rel=icon href='data:,'>"
        )
        return page

    def viewer(self, expression: str) -> Any:
        """Of what the viewer shows."""
        return self.browser.value(f"routebench.viewer.{expression}")

    def key(self, key: str, shift: bool = False) -> None:
        """A key struck while the picture has the focus."""
        self.browser.run("document.getElementById('v-canvas').focus();")
        self.browser.press(key, shift)

    def text(self, selector: str) -> str:
        """What an element says."""
        return self.browser.run(
            "return document.querySelector(arguments[0]).textContent;", selector
        )

    def layer(self) -> int:
        return self.viewer("levels[routebench.viewer.state.level].index")

    def picture(self) -> NDArray[np.float32]:
        """What the canvas shows, without what lies over it."""
        self.browser.wait_for("routebench.stage.complete")
        image = self.browser.picture(CANVAS)
        return image[90:-60, :, :3]

    def assert_drawn(self, image: NDArray[np.float32]) -> None:
        """More than a few of the pixels are not the background's."""
        background = image[2, 2]
        share = (np.abs(image - background).max(axis=2) > 0.15).mean()
        self.assertGreater(share, 0.005)

    def assert_differ(
        self, one: NDArray[np.float32], other: NDArray[np.float32]
    ) -> None:
        share = (np.abs(one - other).max(axis=2) > 0.15).mean()
        self.assertGreater(share, 0.0005)


class ViewerTest(BrowserTestCase):
    """All that one can do with a report."""

    page: ClassVar[Path]

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.page = make("report", stack(cls.folder), cls.folder / "report.html")

    def test_loads_from_disk(self) -> None:
        self.open(self.page)
        self.assertEqual(self.browser.value("location.protocol"), "file:")
        self.assertEqual(self.viewer("levels.length"), LAYERS)
        self.assert_drawn(self.picture())
        resources = self.browser.value("performance.getEntriesByType('resource').map(r => r.name)")
        self.assertEqual([r for r in resources if not r.startswith(("data:", "blob:"))], [])

    def test_layers_look_different(self) -> None:
        self.open(self.page, link(a="lines", layer=0, hide="fade"))
        self.key("t")
        self.key("s")
        pictures = []
        for layer in range(3):
            self.assertEqual(self.layer(), layer)
            pictures.append(self.picture())
            self.assert_drawn(pictures[-1])
            self.key("up")
        self.assert_differ(pictures[0], pictures[1])
        self.assert_differ(pictures[1], pictures[2])

    def test_layer_slider(self) -> None:
        self.open(self.page, link(a="lines", layer=5))
        before = self.picture()
        self.browser.run("document.getElementById('v-layer').focus();")
        for _ in range(3):
            self.browser.press("left")
        self.assertEqual(self.layer(), 2)
        self.assert_differ(before, self.picture())
        self.assertIn("2, z 0.5 mm", self.text("#v-layer-text"))

    def test_from_slider_hides_layers_below(self) -> None:
        self.open(self.page, link(a="lines", layer=4))
        count = "sides[0].pane.beads.last - routebench.viewer.sides[0].pane.beads.first"
        every = self.viewer(count)
        self.browser.run("document.getElementById('v-from').focus();")
        self.browser.press("right")
        first = self.viewer("sides[0].route.start(1).segment")
        self.assertEqual(self.viewer(count), every - first)

    def test_move_slider(self) -> None:
        self.open(self.page, link(a="lines", layer=2))
        whole = self.picture()
        most = self.viewer("moveCount()")
        self.browser.run("document.getElementById('v-move').focus();")
        self.browser.press("home")
        self.assertEqual(self.viewer("state.move"), 0)
        none = self.picture()
        self.assert_differ(whole, none)
        for _ in range(9):
            self.browser.press("right")
        self.assertEqual(self.viewer("state.move"), 9)
        self.assert_differ(none, self.picture())
        # Move by move, segments and travels add up.
        pairs = self.viewer(
            "sides.map(s => { const r = s.route, p = s.shown.to, z = r.start(p);"
            f" return Array.from({{length: {most} + 1}}, (_, m) => r.after(p, m))"
            ".map(a => a.segment - z.segment + a.travel - z.travel); })[0]"
        )
        self.assertEqual(pairs, list(range(most + 1)))
        self.browser.press("end")
        self.assertIsNone(self.viewer("state.move"))

    def test_playing(self) -> None:
        self.open(self.page, link(a="lines", layer=2))
        self.key(" ")
        self.browser.wait_for("routebench.viewer.state.move > 3")
        self.key(" ")
        stopped = self.viewer("state.move")
        self.picture()
        self.assertEqual(self.viewer("state.move"), stopped)

    def test_side_by_side(self) -> None:
        self.open(self.page, link(a="lines", layer=3))
        self.assertEqual(self.viewer("sides.length"), 1)
        self.browser.run(
            "const s = document.getElementById('v-b'); s.value = 'c2';"
            "s.dispatchEvent(new Event('change'));"
        )
        self.browser.wait_for("routebench.viewer.sides.length === 2")
        self.key("t")
        image = self.picture()
        half = image.shape[1] // 2
        left, right = image[:, : half - 2], image[:, half + 2 : 2 * half]
        self.assert_drawn(left)
        self.assert_drawn(right)
        self.assert_differ(left, right)
        # One camera: dragging turns both.
        self.browser.drag(CANVAS, 60, -80)
        turned = self.picture()
        self.assert_differ(left, turned[:, : half - 2])
        self.assert_differ(right, turned[:, half + 2 : 2 * half])
        # One slider: both stand at the same share of their moves.
        self.viewer("setMove(Math.round(routebench.viewer.moveCount() / 2))")
        for side in (0, 1):
            shown = self.viewer(f"sides[{side}].shown.moves")
            most = self.viewer(f"sides[{side}].route.movesOf(3)")
            self.assertAlmostEqual(shown / most, 0.5, delta=1 / most)
        self.key("x")
        self.browser.wait_for("routebench.viewer.sides[0].source.name === 'linked'")

    def test_a_contender_without_route_says_why(self) -> None:
        self.open(self.page, link(a="lines", b="broken"))
        labels = self.text("#v-labels")
        self.assertIn("crashed: signal 11", labels)

    def test_colours_and_legend(self) -> None:
        self.open(self.page, link(a="lines", b="linked", layer=4))
        self.key("t")
        legend = "document.getElementById('v-legend').textContent"
        seen = []
        for mode, words in (
            ("kind", ("wall", "dense", "sparse", "travel", "crossing", "retraction")),
            ("order", ("first", "last of its layer")),
            ("speed", ("mm/s",)),
            ("contender", ("lines", "linked")),
        ):
            self.assertEqual(self.viewer("state.colour"), mode)
            for word in words:
                self.assertIn(word, self.browser.value(legend))
            seen.append(self.picture())
            self.key("c")
        for one, other in zip(seen, seen[1:]):
            self.assert_differ(one, other)

    def test_toggles(self) -> None:
        self.open(self.page, link(a="lines", layer=4))
        self.key("t")
        before = self.picture()
        names = ("strokes", "travels", "crossings", "retractions", "outline", "fade")
        for number, name in enumerate(names, 1):
            self.key(str(number))
            self.assertFalse(self.viewer(f"state.shown.{name}"))
            self.assertFalse(self.browser.value(f"document.getElementById('v-{name}').checked"))
            after = self.picture()
            with self.subTest(name):
                self.assert_differ(before, after)
            self.key(str(number))

    def test_deep_link_leads_back(self) -> None:
        self.open(self.page, link(a="lines", b="linked", layer=4))
        for key in ("down", "c", "2", "t"):
            self.key(key)
        self.viewer("setMove(7)")
        self.browser.wait_for("location.hash.includes('move=7')")
        self.browser.wait_for("location.hash.includes('hide=travels')")
        hash_ = self.browser.value("location.hash")
        state = self.viewer("state")
        image = self.picture()
        self.open(self.page, hash_)
        self.assertEqual(self.viewer("state"), state)
        self.assertEqual(self.layer(), 3)
        self.assertLess(np.abs(self.picture() - image).mean(), 0.01)

    def test_a_link_to_what_is_not_there_says_so(self) -> None:
        self.open(self.page, link(a="nobody"))
        self.assertIn("no contender “nobody”", self.text("#v-status"))

    def test_worst_layer(self) -> None:
        self.open(self.page, link(a="lines", layer=0))
        travel = [row["travel_mm"] for row in made_up_layers(1, 1, LAYERS)]
        ranked = sorted(range(LAYERS), key=lambda i: -(travel[i] or 0))
        for nth in range(3):
            self.key("w")
            self.assertEqual(self.layer(), ranked[nth])

    def test_largest_difference(self) -> None:
        self.open(self.page, link(a="lines", b="linked", layer=0))
        one, other = (
            [row["travel_mm"] or 0 for row in made_up_layers(1, c, LAYERS)] for c in (1, 2)
        )
        gaps = [abs(a - b) for a, b in zip(one, other)]
        self.key("d")
        self.assertEqual(self.layer(), gaps.index(max(gaps)))

    def test_table_sorts_and_filters(self) -> None:
        self.open(self.page)
        travel = (
            "[...document.querySelectorAll('#table tbody tr')].map(r => r.cells[4].textContent)"
        )
        head = "#table thead th:nth-child(5) button"
        self.assertIn("Travel", self.text(head))

        def numbers() -> list[float]:
            texts = self.browser.value(travel)
            self.assertEqual(len(texts), 12)
            values = [float(t.replace("\u202f", "")) for t in texts if t != "n/a"]
            # What is absent comes last, whichever way.
            self.assertEqual(texts[len(values):], ["n/a"] * 4)
            return values

        self.browser.click(head)
        self.assertEqual(numbers(), sorted(numbers()))
        self.browser.click(head)
        self.assertEqual(numbers(), sorted(numbers(), reverse=True))
        order = "document.querySelector('#table th[aria-sort]').ariaSort"
        self.assertEqual(self.browser.value(order), "descending")
        self.browser.run(
            "const f = document.querySelector('#table input[type=search]');"
            "f.value = 'OTHER crash';"
            "f.dispatchEvent(new Event('input'));"
        )
        self.assertEqual(self.text("#table output"), "2 of 12 cells")

    def test_every_figure_of_the_table_leads_to_a_layer(self) -> None:
        self.open(self.page)
        links = self.browser.value(
            "[...document.querySelectorAll('#table tbody td.number a')].map(a => a.hash)"
        )
        self.assertEqual(len(links), 8 * 9)
        self.browser.click("#table tbody tr:nth-child(2) td:nth-child(6) a")
        self.browser.wait_for("routebench.viewer.message.includes('worst by Retractions')")
        scores = [row["retractions"] for row in made_up_layers(2, 2, LAYERS)]
        name = self.viewer("sides[0].source.name")
        model = self.viewer("experiment.models[routebench.viewer.state.model]")
        self.assertEqual(model, "parts/other.stl")
        if name == "linked":
            self.assertEqual(scores[self.layer()], max(s or 0 for s in scores))

    def test_wheel_scrolls_the_page_until_the_picture_is_clicked(self) -> None:
        self.open(self.page)
        turn = (
            "document.getElementById('v-canvas').dispatchEvent("
            "new WheelEvent('wheel', {deltaY: -300, bubbles: true, cancelable: true}))"
        )
        before = self.viewer("stage.cameraPlace()")
        self.assertTrue(self.browser.value(turn), "the page may scroll")
        self.assertEqual(self.viewer("stage.cameraPlace()"), before)
        self.browser.click(CANVAS)
        self.assertFalse(self.browser.value(turn), "the picture has taken it")
        self.assertNotEqual(self.viewer("stage.cameraPlace()"), before)

    def test_keys_are_listed(self) -> None:
        self.open(self.page)
        self.key("?")
        self.assertTrue(self.browser.value("document.getElementById('v-keys').open"))
        self.browser.press("escape")
        self.assertFalse(self.browser.value("document.getElementById('v-keys').open"))

    def test_every_control_has_a_name(self) -> None:
        self.open(self.page)
        nameless = self.browser.value(
            "[...document.querySelectorAll('button, input, select, canvas')].filter(e =>"
            " !(e.textContent.trim() || e.labels?.length || e.getAttribute('aria-label')"
            " || e.getAttribute('aria-labelledby'))).map(e => e.outerHTML)"
        )
        self.assertEqual(nameless, [])

    def drop(self, name: str, text: str) -> None:
        """Drops a file onto the page."""
        self.browser.run(
            "const data = new DataTransfer();"
            "data.items.add(new File([arguments[1]], arguments[0]));"
            "for (const type of ['dragover', 'drop']) document.body.dispatchEvent("
            "new DragEvent(type, {bubbles: true, cancelable: true, dataTransfer: data}));",
            name,
            text,
        )

    def test_dropped_gcode(self) -> None:
        self.open(self.page, link(a="lines", layer=1))
        before = self.picture()
        self.drop("made.gcode", GCODE)
        self.browser.wait_for("routebench.viewer.sides.length === 2")
        self.browser.wait_for("routebench.viewer.message.includes('made.gcode')")
        self.assert_differ(before, self.picture())
        self.assertEqual(self.viewer("sides[1].route.layers.length"), 2)

    def test_dropped_nonsense(self) -> None:
        self.open(self.page)
        self.drop("notes.txt", "dear diary\nG0 X3\n")
        self.browser.wait_for("routebench.viewer.message.includes('is this G-code?')")
        self.drop("far.gcode", "G1 X0 Y0\nG1 X9e9 E1\nG1 X99999999 E1")
        self.browser.wait_for("routebench.viewer.message.includes('farther than any printer')")

    def test_gcode_is_read_right(self) -> None:
        self.open(self.page)
        tallies = self.browser.run(
            "const r = routebench.readGcode('x', arguments[0]);"
            "const count = kind => r.segmentKind.filter(s => s === kind).length;"
            "return [r.tally(0), r.tally(1), r.kinds.map((_, kind) => count(kind)),"
            " [...r.segments.slice(-6)], [...new Set(r.segmentSpeed)],"
            " r.bounds(s => r.segmentKind[s] === 0), r.bounds(s => r.segmentKind[s] === 3)];",
            GCODE,
        )
        # Arcs go round on the side that they are told to: to the right, and up.
        walls, skirt = tallies[5:]
        self.assertAlmostEqual(walls["high"][0], 15, delta=0.01)
        self.assertAlmostEqual(walls["low"][0], 0)
        self.assertAlmostEqual(skirt["high"][1], 5, delta=0.01)
        self.assertAlmostEqual(skirt["low"][1], -5, delta=0.01)
        for found, wanted in zip(tallies, (FIRST_LAYER, SECOND_LAYER)):
            for name, value in wanted.items():
                # Chords of an arc are a little shorter than the arc.
                self.assertAlmostEqual(found[name], value, delta=0.05, msg=name)
        walls, dense, sparse, other, unknown = tallies[2]
        self.assertGreater(walls, 10)
        self.assertEqual((dense, sparse, unknown), (0, 4, 0))
        self.assertGreater(other, 10)
        end = [50.8 + 20, 0, 50.8 + 20, 1]
        for found, wanted in zip(tallies[3], [*end, 0.4, 0.5]):
            self.assertAlmostEqual(found, wanted, delta=1e-4)
        self.assertEqual(tallies[4], [30])


class KeptTest(BrowserTestCase):
    """Where only some layers' routes were kept."""

    def test_says_so(self) -> None:
        page = make("view", stack(self.folder, range(2, 4)), self.folder / "view.html")
        self.open(page, link(a="lines"))
        self.assertIn("Routes of 2 of 6 layers were kept", self.text("#v-kept"))
        travel = [row["travel_mm"] or 0 for row in made_up_layers(1, 1, LAYERS)]
        worst = travel.index(max(travel))
        self.assertNotIn(worst, (2, 3))
        self.key("w")
        message = self.viewer("message")
        self.assertIn(f"layer {worst} is the worst", message)
        self.assertIn("its route was not kept", message)
        self.assertEqual(self.layer(), 2 if travel[2] > travel[3] else 3)
        self.open(page, link(a="lines", layer=5))
        self.assertIn("layer 5 was not kept", self.viewer("message"))
        self.assertEqual(self.layer(), 3)


class JudgeTest(BrowserTestCase):
    """What the viewer counts is what the judge has counted, on a real run."""

    CONFIG = """
name = "judged"
models = ["shape:gear?teeth=9", "shape:islands"]
[task]
layer_height_mm = 0.4
line_width_mm = 0.6
[printer]
retract_policy = ["length", "length_and_crossing", "manhattan"]
[run]
repetitions = 1
keep_layers = "all"
[[contender]]
name = "lines"
shell = { planner = "greedy_shell" }
fill = { planner = "rectilinear", link = "none" }
"""
    COUNTED = {
        "extrude_mm": "extrudeMm",
        "travel_mm": "travelMm",
        "travels": "travels",
        "retractions": "retractions",
        "crossings": "crossings",
    }

    def test_agrees(self) -> None:
        config = self.folder / "judged.toml"
        config.write_text(self.CONFIG)
        subprocess.run(
            [PROGRAM, "run", config, "--out", self.folder / "run"],
            check=True,
            capture_output=True,
            timeout=250,
        )
        page = make("view", self.folder / "run", self.folder / "judged.html")
        self.open(page)
        with closing(sqlite3.connect(self.folder / "run" / "results.sqlite")) as database:
            database.row_factory = sqlite3.Row
            rows = database.execute(
                "SELECT spec, label, layer_score.* FROM layer_score JOIN cell USING (cell_id) "
                "JOIN model USING (model_id) JOIN setting USING (setting_id)"
            ).fetchall()
        wanted = {(r["spec"], r["label"], r["layer_index"]): r for r in rows}
        found = 0
        settings = self.viewer("experiment.settings.map(s => s.name)")
        for number, label in enumerate(settings):
            for model, spec in enumerate(self.viewer("experiment.models")):
                self.browser.run(
                    "document.body.dataset.chosen = '';"
                    "routebench.viewer.choose({setting: arguments[0], model: arguments[1]})"
                    ".then(() => { document.body.dataset.chosen = 'yes'; });",
                    number,
                    model,
                )
                self.browser.wait_for("document.body.dataset.chosen === 'yes'")
                layers = self.browser.run(
                    "const { route } = routebench.viewer.sides[0];"
                    "const speeds = routebench.modelledSpeeds(route,"
                    " routebench.experiment.settings[arguments[0]].printer);"
                    "return route.layers.map((layer, place) => {"
                    "  let seconds = 0;"
                    "  const end = route.start(place + 1).segment;"
                    "  for (let s = route.start(place).segment; s < end; s++)"
                    "    seconds += Math.hypot(route.segments[6 * s + 2] - route.segments[6 * s],"
                    "      route.segments[6 * s + 3] - route.segments[6 * s + 1]) / speeds[s];"
                    "  return { index: layer.index, ...route.tally(place), seconds };"
                    "});",
                    number,
                )
                for layer in layers:
                    row = wanted[spec, label, layer["index"]]
                    for metric, name in self.COUNTED.items():
                        tolerance = 2e-4 * row[metric] if metric.endswith("_mm") else 0
                        self.assertAlmostEqual(
                            layer[name], row[metric], delta=tolerance,
                            msg=f"{metric} of layer {layer['index']} of {spec}, {label}",
                        )
                    self.assertAlmostEqual(
                        layer["seconds"],
                        row["print_extrude_s"],
                        delta=2e-3 * row["print_extrude_s"],
                    )
                    found += 1
        self.assertEqual(found, len(rows))
        self.assertGreater(sum(r["crossings"] for r in rows), 10)

    def test_our_own_gcode_reads_back(self) -> None:
        file = self.folder / "part.gcode"
        done = subprocess.run(
            [PROGRAM, "plan", "shape:hotend", "--shell", "greedy_shell", "--fill", "rectilinear",
             "--gcode", file, "--json", "-"],
            check=True, capture_output=True, text=True, timeout=250,
        )
        layers = json.loads(done.stdout)["per_layer"]
        page = make("view", file, self.folder / "gcode.html")
        self.open(page)
        self.assert_drawn(self.picture())
        found = self.browser.run(
            "const { route } = routebench.viewer.sides[0];"
            "return route.layers.map((_, place) => route.tally(place));"
        )
        self.assertEqual(len(found), len(layers))
        for tally, layer in zip(found, layers):
            metrics = layer.get("metrics", layer)
            for metric in ("extrude_mm", "travel_mm", "travels", "retractions"):
                self.assertAlmostEqual(
                    tally[self.COUNTED[metric]],
                    metrics[metric],
                    delta=1e-3 * metrics[metric] + 0.01,
                )


class MillionTest(BrowserTestCase):
    """A million segments: shown whole, and scrubbed; how fast is printed, not judged."""

    STROKES, POINTS = 100, 101
    LAYERS = 100

    def test_million(self) -> None:
        made = Database(self.folder / "results.sqlite")
        cell = made.cell(
            made.model("large.stl"),
            made.contender("noise"),
            made.setting(),
            {"travel_mm": 1.0},
        )
        rng = np.random.default_rng(3)
        for layer in range(self.LAYERS):
            made.shape(1, layer)
            strokes = []
            for line in range(self.STROKES):
                # Noise, which cannot be packed as well as a pattern.
                x = (np.linspace(0, 50, self.POINTS) + rng.uniform(0, 0.2, self.POINTS)).round(4)
                y = (line * 0.3 + rng.uniform(0, 0.2, self.POINTS)).round(4)
                points = np.column_stack([x, y])[:: 1 if line % 2 else -1]
                strokes.append({"kind": "sparse", "width_mm": 0.45, "points": points.tolist()})
            made.route(cell, layer, strokes)
        made.close()
        page = make("view", self.folder, self.folder / "million.html")
        self.open(page)
        self.assertEqual(self.viewer("sides[0].route.segmentCount"), 1_000_000)
        ready_ms = self.browser.value("performance.getEntriesByName('ready')[0].startTime")
        self.browser.wait_for("routebench.stage.complete")
        drawn_ms = self.browser.value("performance.now()")
        before = self.picture()
        self.assert_drawn(before)
        scrub_ms = self.browser.run(
            "const { viewer, stage } = routebench;"
            "const begin = performance.now();"
            "for (let i = 0; i < 100; i++) viewer.setMove(i * 90);"
            "return (performance.now() - begin) / 100;"
        )
        frame_ms = self.browser.run(
            "const { stage } = routebench;"
            "const begin = performance.now();"
            "stage.restart = true; stage.render();"
            "return performance.now() - begin;"
        )
        print(
            f"\n1,000,000 segments: page of {page.stat().st_size / 1e6:.1f} MB, ready after "
            f"{ready_ms / 1000:.2f} s, drawn without graphics card after {drawn_ms / 1000:.2f} s; "
            f"a step of the slider {scrub_ms:.2f} ms, its first frame {frame_ms:.0f} ms"
        )
        self.viewer("setLevel(40)")
        self.assert_differ(before, self.picture())


if __name__ == "__main__":
    unittest.main()
