"""Files are all there, the same each time, or not there at all."""

from __future__ import annotations

import contextlib
import io
import sys
import unittest
from pathlib import Path
from unittest import mock
from xml.etree import ElementTree

from routebench_plots import cli
from routebench_plots.figures import chosen_metrics, figures
from support import PlotTestCase
from synthetic import fill


class FilesTest(PlotTestCase):
    """The command as a whole."""

    def setUp(self) -> None:
        super().setUp()
        self.database = fill(
            self.folder / "results.sqlite",
            ["m"],
            ["a", "b"],
            failures={(0, 1): ("crashed", "signal 11")},
            layers=4,
        )

    def plot(
        self, *arguments: str, place: Path | None = None
    ) -> tuple[int, list[str], str]:
        """Exit code, lines on stdout, text on stderr."""
        out = io.TextIOWrapper(io.BytesIO(), encoding="utf-8")
        err = io.StringIO()
        with mock.patch.object(sys, "stdout", out):
            with contextlib.redirect_stderr(err):
                code = cli.main([*arguments, "--", str(place or self.folder)])
        out.flush()
        text = out.buffer.getvalue().decode()  # type: ignore[attr-defined]
        return code, text.splitlines(), err.getvalue()

    def few(self, out: Path) -> tuple[int, list[str], str]:
        """The least that can be asked for."""
        return self.plot(
            "--out", str(out), "--metrics=travel_mm", "--formats=png"
        )

    def test_default_place_and_order(self) -> None:
        code, lines, errors = self.plot("--metrics=travel_mm,strokes")
        self.assertEqual((code, errors), (0, ""))
        place = self.folder / "plots"
        names = [Path(line).name for line in lines]
        self.assertEqual([Path(line).parent for line in lines], [place] * len(names))
        self.assertEqual(
            names,
            [
                f"{stem}.{ending}"
                for stem in (
                    "outcomes",
                    "ratios",
                    "profiles",
                    "heat-travel_mm",
                    "heat-strokes",
                    "bars-travel_mm",
                    "bars-strokes",
                    "scatter-travel_mm-plan_cpu_ns",
                    "layers-m",
                    "routes-m-layer2",
                )
                for ending in ("png", "svg")
            ]
            + ["summary.md", "table.md", "table.tex", "comparison.tex"],
        )
        for name in names:
            self.assertGreater((place / name).stat().st_size, 0, name)
        for svg in place.glob("*.svg"):
            ElementTree.parse(svg)
        for png in place.glob("*.png"):
            self.assertEqual(png.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        visible = {p.name for p in place.iterdir() if p.name[0] != "."}
        self.assertEqual(visible, set(names))

    def test_equal_input_gives_equal_bytes(self) -> None:
        several = self.folder / "several.sqlite"
        fill(several, ["m", "n", "o"], ["a", "b", "c"], layers=4)
        folders = [self.folder / "one", self.folder / "two"]
        for folder in folders:
            code, _, _ = self.plot(
                "--out",
                str(folder),
                "--metrics=deposit,travel_mm",
                "--formats=svg,png,pdf",
                place=several,
            )
            self.assertEqual(code, 0)
        first, second = (
            {p.name: p.read_bytes() for p in folder.iterdir()}
            for folder in folders
        )
        self.assertEqual(first.keys(), second.keys())
        for stem in ("ratios", "profiles", "ranks", "heat-travel_mm"):
            for ending in ("svg", "png", "pdf"):
                self.assertIn(f"{stem}.{ending}", first)
        for name, content in first.items():
            self.assertEqual(content, second[name], name)

    def stems(self, database: Path, metrics: list[str]) -> list[str]:
        """Names of all figures, without drawing them."""
        results = self.open(database)
        chosen = chosen_metrics(results, metrics)
        return [figure.stem for figure in figures(results, chosen)]

    def test_settings_have_files_of_their_own(self) -> None:
        labels = ["density=0.2", "density=0.4"]
        path = fill(self.folder / "s.sqlite", ["m"], ["a"], labels, layers=2)
        stems = self.stems(path, ["travel_mm"])
        self.assertEqual(
            stems[:2], ["outcomes--density=0.2", "outcomes--density=0.4"]
        )
        self.assertEqual(len(stems), 10)
        self.assertEqual(len(set(stems)), 10)

    def test_pages_have_files_of_their_own(self) -> None:
        models = [f"model {n}" for n in range(70)]
        path = fill(self.folder / "p.sqlite", models, ["a"], layers=1)
        stems = self.stems(path, ["travel_mm"])
        self.assertEqual(stems[:3], ["outcomes-1", "outcomes-2", "outcomes-3"])
        self.assertIn("bars-travel_mm-2", stems)
        self.assertEqual(len(set(stems)), len(stems))

    def test_no_figure_without_anything_to_show(self) -> None:
        failed = {(0, 0): ("failed", "broke"), (0, 1): ("failed", "broke")}
        path = fill(self.folder / "f.sqlite", ["m", "n"], ["a", "b"], failures=failed, layers=2)
        stems = self.stems(path, ["travel_mm"])
        self.assertNotIn("layers-m", stems)
        self.assertIn("layers-n", stems)
        self.assertIn("scatter-travel_mm-plan_cpu_ns", stems)
        path = fill(self.folder / "g.sqlite", ["m"], ["a", "b"], failures=failed, layers=2)
        stems = self.stems(path, ["travel_mm"])
        self.assertIn("outcomes", stems)
        self.assertIn("routes-m-layer1", stems)
        self.assertNotIn("scatter-travel_mm-plan_cpu_ns", stems)

    def test_all_metrics(self) -> None:
        stems = self.stems(self.database, ["all"])
        self.assertIn("bars-peak_rss_bytes", stems)
        self.assertIn("bars-extrude_mm", stems)

    def test_stale_figures_go_and_strangers_stay(self) -> None:
        out = self.folder / "out"
        self.plot(
            "--out", str(out), "--metrics=travel_mm,strokes", "--formats=png"
        )
        (out / "mine.png").write_text("mine")
        _, lines, _ = self.few(out)
        names = {p.name for p in out.iterdir() if p.name[0] != "."}
        self.assertEqual(
            names, {Path(line).name for line in lines} | {"mine.png"}
        )
        self.assertNotIn("bars-strokes.png", names)

    def test_nothing_half_written_stays(self) -> None:
        out = self.folder / "out"
        before = {p.name for p in self.folder.iterdir()}
        for error, code in (
            (RuntimeError("boom"), 3),
            (KeyboardInterrupt(), 130),
            (OSError(28, "No space left on device", "x.png"), 2),
        ):
            with mock.patch("routebench_plots.bars.draw", side_effect=error):
                found, lines, errors = self.few(out)
            self.assertEqual(found, code)
            self.assertEqual(lines, [])
            self.assertRegex(errors, r"^routebench: [^\n]+\n$")
            self.assertEqual({p.name for p in self.folder.iterdir()}, before)

    def test_bad_usage_is_one_line(self) -> None:
        (self.folder / "file").touch()
        for arguments, why in (
            (["--formats=gif"], "'gif' is none of png, svg, pdf"),
            (["--formats="], "'' is none of"),
            (["--metrics=travel"], "did you mean 'travel_mm'"),
            (["--metrics=zzz"], "it has extrude_mm, travel_mm"),
            (["--out", str(self.folder / "file")], "cannot write"),
            (["--colour=red"], "--colour"),
        ):
            code, lines, errors = self.plot(*arguments)
            self.assertEqual((code, lines), (2, []))
            self.assertRegex(errors, r"^routebench: [^\n]+\n$")
            self.assertIn(why, errors)


if __name__ == "__main__":
    unittest.main()
