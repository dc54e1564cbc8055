"""Experiments made up for the page's tests, and what tests in a browser share."""

from __future__ import annotations

import json
import tempfile
import unittest
from pathlib import Path
from typing import Any, ClassVar
from urllib.parse import urlencode

import numpy as np
from numpy.typing import NDArray

from browser import Browser, needs_browser
from routebench_report import cli
from synthetic import Database, made_up_layers, made_up_scores, plate_strokes

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
    return f"#{urlencode({'model': 'plate.stl', **wishes})}"


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
