"""G-code that is dropped onto the page, and what the viewer reads of it."""

from __future__ import annotations

import math
import unittest
from pathlib import Path
from typing import ClassVar

from report_pages import BrowserTestCase, link, make, stack

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


class GcodeTest(BrowserTestCase):
    """Files beside what a report shows."""

    page: ClassVar[Path]

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.page = make("report", stack(cls.folder), cls.folder / "report.html")

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


if __name__ == "__main__":
    unittest.main()
