"""Nothing is cut off, however long names are and however many there are."""

from __future__ import annotations

import io
import unittest
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib import image
from matplotlib.patches import Rectangle

from routebench_plots.figures import chosen_metrics, figures
from routebench_plots.sheet import Rect, Sheet
from support import LONG_MODEL, LONG_NAME, UNBROKEN_NAME, PlotTestCase
from synthetic import fill

FAILURES = {
    (0, 0): ("off_task", "covered 0.91 < 0.95; " * 6),
    (1, 0): ("out_of_memory", "more than 4096 MB"),
}


class LayoutTest(PlotTestCase):
    """All figures of an experiment, drawn and measured."""

    def check(
        self,
        models: Sequence[str],
        contenders: Sequence[str],
        settings: Sequence[str] = ("",),
    ) -> None:
        """Draws everything but some metrics that look like others."""
        path: Path = fill(
            self.folder / "results.sqlite",
            models,
            contenders,
            settings,
            FAILURES,
            layers=9,
        )
        results = self.open(path)
        metrics = chosen_metrics(results, ["travel_mm", "plan_cpu_ns"])
        for figure in figures(results, metrics):
            with self.subTest(figure.stem):
                self.assert_laid_out(figure.draw())

    def test_one_contender_one_model(self) -> None:
        self.check(["m"], ["c"])

    def test_twelve_contenders_with_long_names(self) -> None:
        names = [LONG_NAME, UNBROKEN_NAME, "_hidden", "cost in $ and $"]
        names += [f"{LONG_NAME} {n}" for n in range(4)]
        names += [f"short {n}" for n in range(4)]
        self.check([LONG_MODEL, "m" * 120], names)

    def test_long_setting(self) -> None:
        self.check(["m"], ["c"], ["density=0.2, retract_over_mm=1.5, " * 5])

    def test_one_contender_on_models_with_long_names(self) -> None:
        spec = "shape:grate?holes={}&pitch=2.5&diameter=2&z=0.2&triangles=64000"
        self.check([spec.format(n) for n in range(10, 16)], ["walls and gaps"])

    def test_one_contender_with_a_long_name(self) -> None:
        self.check(["m", "n", LONG_MODEL, "o"], [LONG_NAME])

    def test_names_of_other_scripts(self) -> None:
        self.check(["модель", "模型"], ["größe µ", "naïve → élève", "\t\n"])

    def test_nothing_lies_where_a_png_cannot_be_drawn(self) -> None:
        # Wider than Agg draws at the usual resolution, and wider than it makes at all.
        for width in (200.0, 400.0):
            with self.subTest(width=width):
                sheet = Sheet(width, 1, "wide")
                axes = sheet.axes_at(Rect(width - 1.5, sheet.body.bottom, 1, 1))
                axes.set_axis_off()
                axes.add_patch(Rectangle((0, 0), 1, 1, color="black"))
                pixels = image.imread(io.BytesIO(sheet.encoded("png")))
                dark = np.flatnonzero((pixels[..., :3] == 0).all(axis=2).any(axis=0))
                self.assertGreater(dark.size, 0)
                edge = dark.max() / pixels.shape[1] * width
                self.assertAlmostEqual(edge, width - 0.5, delta=0.05)
                self.assertEqual(sheet.encoded("svg"), sheet.encoded("svg"))


if __name__ == "__main__":
    unittest.main()
