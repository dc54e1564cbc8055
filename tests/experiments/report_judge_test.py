"""What the viewer counts against what the judge counts, on real runs."""

from __future__ import annotations

import json
import os
import sqlite3
import subprocess
import unittest
from contextlib import closing
from pathlib import Path

from report_pages import BrowserTestCase, make

PROGRAM = Path(os.environ["ROUTEBENCH_PROGRAM"])


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


if __name__ == "__main__":
    unittest.main()
