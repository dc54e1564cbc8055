"""What the tests of the figures share."""

from __future__ import annotations

import itertools
import tempfile
import unittest
import warnings
from collections.abc import Iterator
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.text import Text
from matplotlib.transforms import Bbox

from routebench_plots import style
from routebench_plots.results import Item, Metric, Results
from routebench_plots.sheet import Sheet

LONG_NAME = (
    "a contender whose author wanted to say everything about it in its name, "
    "parameters and all [fill.angle_deg=22.5, fill.link=boundary]"
)
UNBROKEN_NAME = "n" * 150
LONG_MODEL = (
    "/a/path/which/goes/on/through/ever/deeper/folders/until/at/last/there_is"
    "/a-part.stl?size=60&resolution=1000000"
)


class PlotTestCase(unittest.TestCase):
    """A test with a folder of its own, in which figures look as always."""

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        look = style.applied()
        look.__enter__()
        self.addCleanup(look.__exit__, None, None, None)
        # A layout that does not come out is a mistake, not a remark.
        warnings.filterwarnings("error", message=".*constrained_layout.*")

    def open(self, database: Path) -> Results:
        """The results, closed after the test."""
        results = Results(database)
        self.addCleanup(results.close)
        return results

    def metric(self, results: Results, name: str) -> Metric:
        """A metric that must be there."""
        metric = results.metric(name)
        assert metric is not None, name
        return metric

    def assert_laid_out(self, sheet: Sheet) -> None:
        """Nothing is cut off, and nothing lies over data."""
        sheet.figure.draw_without_rendering()
        figure_box = sheet.figure.bbox
        texts = list(drawn_texts(sheet))
        self.assertTrue(texts)
        for text in texts:
            self.assert_inside(text.get_window_extent(), figure_box, text)
        outside = [*sheet.figure.texts]
        boxes = [text.get_window_extent() for text in outside]
        boxes += [
            legend.get_window_extent() for legend in sheet.figure.legends
        ]
        for axes in visible_axes(sheet):
            for box in boxes:
                self.assertFalse(
                    overlap(box, axes.get_tightbbox()),
                    f"something lies over {axes}",
                )
        panels = [axes.get_tightbbox() for axes in visible_axes(sheet)]
        for one, other in itertools.combinations(panels, 2):
            self.assertFalse(overlap(one, other), "panels overlap")

    def assert_inside(self, inner: Bbox, outer: Bbox, what: object) -> None:
        """Allows a pixel for rounding."""
        self.assertTrue(
            inner.x0 >= outer.x0 - 1
            and inner.x1 <= outer.x1 + 1
            and inner.y0 >= outer.y0 - 1
            and inner.y1 <= outer.y1 + 1,
            f"{what}: {inner} is not inside {outer}",
        )


def visible_axes(sheet: Sheet) -> list[Axes]:
    """The panels that are shown."""
    return [axes for axes in sheet.figure.axes if axes.get_visible()]


def drawn_texts(sheet: Sheet) -> Iterator[Text]:
    """Every text that a reader sees."""
    figure = sheet.figure
    found = [*figure.texts]
    for legend in figure.legends:
        found += legend.get_texts()
    for axes in visible_axes(sheet):
        found += [*axes.texts, axes.title]
        if not axes.axison:
            continue
        for axis in (axes.xaxis, axes.yaxis):
            found.append(axis.label)
            found += [tick.label1 for tick in axis._update_ticks()]
    return (t for t in found if t.get_visible() and t.get_text().strip())


def words(sheet: Sheet) -> str:
    """All texts, line breaks taken as spaces."""
    return " | ".join(
        " ".join(text.get_text().split()) for text in drawn_texts(sheet)
    )


def note(sheet: Sheet) -> str:
    """The notes below a figure."""
    return " ".join(sheet.figure.texts[1].get_text().split())


def overlap(one: Bbox, other: Bbox) -> bool:
    """Whether two boxes share more than a pixel's border."""
    return (
        min(one.x1, other.x1) - max(one.x0, other.x0) > 1
        and min(one.y1, other.y1) - max(one.y0, other.y0) > 1
    )


def by_label(items: tuple[Item, ...], label: str) -> Item:
    """The item of that label."""
    return next(item for item in items if item.label == label)
