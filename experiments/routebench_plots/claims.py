"""What others claim of contenders, beside what was measured.

The tables [[claim]] and [[published]] of a config say what publications state:
how time grows with a size, and single figures. They change nothing that is
executed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from matplotlib.lines import Line2D

from . import scaling
from .markdown import markdown_row, markdown_text
from .quantities import amount, in_sentence, quantity, scale_for
from .results import Item, Metric, Results
from .sheet import LegendEntry, Sheet
from .style import ABSENT, looks

SIZES = {
    "triangles": Metric("triangles", "Triangles", "", "neither", "cell", ""),
    "layers": Metric("layers", "Layers", "", "neither", "cell", ""),
    "outline_vertices": Metric(
        "outline_vertices", "Vertices of all outlines", "", "neither", "cell", ""
    ),
    "side_mm": Metric("side_mm", "Largest side", "mm", "neither", "cell", ""),
}
"""Sizes of models; any other size is a metric of the cell."""


@dataclass(frozen=True)
class Claim:
    """time ~ size ** exponent, says the source."""

    contender: Item
    size: Metric
    exponent: float
    source: str


@dataclass(frozen=True)
class Judged:
    """A claim with what the cells say."""

    claim: Claim
    points: list[tuple[float, float]]
    """Size and time of every valid cell, by size."""
    law: scaling.Fit | None
    """None if the sizes span too little."""

    @property
    def verdict(self) -> str:
        """How the claimed exponent lies to the fitted interval."""
        if self.law is None:
            return "too few sizes"
        if math.isnan(self.law.half_width):
            return "no interval"
        gap = self.law.exponent - self.claim.exponent
        if abs(gap) <= self.law.half_width:
            return "agrees"
        return "grows faster" if gap > 0 else "grows slower"


def judged_claims(results: Results) -> list[Judged]:
    """All claims of the last run's config, in its order.

    Every cell of a contender is a point, whatever its model and setting:
    what a claim holds fixed must be fixed in the config.
    """
    time = results.metric(scaling.TIME)
    found = []
    for entry in results.config_tables("claims"):
        size_name = str(entry["size"])
        size = SIZES.get(size_name) or results.metric(size_name)
        if size is None or time is None:
            continue
        for contender in results.contenders:
            if results.base_name(contender) != entry["contender"]:
                continue
            claim = Claim(
                contender, size, float(entry["exponent"]), str(entry["source"])
            )
            points = _points(results, contender, size, time)
            found.append(Judged(claim, points, _law(points)))
    return found


def _points(
    results: Results, contender: Item, size: Metric, time: Metric
) -> list[tuple[float, float]]:
    points = []
    for setting in results.settings:
        for model in results.models:
            slot = results.slot(setting, model, contender)
            took = results.value(slot, time)
            if size.name in SIZES:
                measure = results.model_size(setting, model, size.name)
            else:
                value = results.value(slot, size)
                measure = None if value is None else value.median
            if took is not None and measure:
                points.append((measure, took.median))
    return sorted(points)


def _law(points: Sequence[tuple[float, float]]) -> scaling.Fit | None:
    sizes = {x for x, _ in points}
    if (
        len(sizes) < scaling.FEWEST_MODELS
        or max(sizes) < scaling.LEAST_RANGE * min(sizes)
    ):
        return None
    return scaling.fit(points)


def claims_markdown(judged: Sequence[Judged]) -> list[str]:
    """Claimed beside fitted exponents; nothing where nothing is claimed."""
    if not judged:
        return []
    lines = [
        "",
        "## Claimed and measured growth",
        "",
        "Time grows with the size to the power of; the interval is that of the "
        "fit, 95 %, with the cells as the sample.",
        "",
        markdown_row(
            ["contender", "size", "from", "to", "claimed", "fitted", "", "source"]
        ),
        markdown_row([":--", ":--", "--:", "--:", "--:", "--:", ":--", ":--"]),
    ]
    for entry in judged:
        claim = entry.claim
        ends = [ABSENT, ABSENT]
        if entry.points:
            ends = [
                quantity(entry.points[i][0], claim.size.unit) for i in (0, -1)
            ]
        fitted = ABSENT
        if entry.law is not None:
            fitted = f"{entry.law.exponent:.2f}"
            if not math.isnan(entry.law.half_width):
                fitted += f" ± {entry.law.half_width:.2f}"
        lines.append(
            markdown_row(
                [
                    markdown_text(claim.contender.label),
                    in_sentence(claim.size.label),
                    *ends,
                    f"{claim.exponent:g}",
                    fitted,
                    entry.verdict,
                    markdown_text(claim.source),
                ]
            )
        )
    return lines


def published_markdown(results: Results) -> list[str]:
    """Published figures above ours on the same kind of model."""
    entries = results.config_tables("published")
    lines: list[str] = []
    if entries:
        lines += [
            "",
            "## As published, and here",
            "",
            "Published figures are those of other machines and years, on models "
            "of the same kind; ours are medians.",
        ]
    for model in results.models:
        for metric in results.metrics:
            rows = [
                entry
                for entry in entries
                if entry["model"] == model.label
                and entry["metric"] == metric.name
            ]
            if not rows:
                continue
            lines += [
                "",
                f"### {markdown_text(model.label)}, "
                f"{in_sentence(metric.label)}",
                "",
                markdown_row(["program", "value", "where from"]),
                markdown_row([":--", "--:", ":--"]),
            ]
            for entry in rows:
                where = "; ".join(
                    text for text in (entry["source"], entry["note"]) if text
                )
                lines.append(
                    markdown_row(
                        [
                            markdown_text(entry["program"]),
                            amount(float(entry["value"]), metric),
                            f"published: {markdown_text(where)}",
                        ]
                    )
                )
            lines += _measured_rows(results, model, metric)
    return lines


def _measured_rows(
    results: Results, model: Item, metric: Metric
) -> list[str]:
    rows = []
    for setting in results.settings:
        for contender in results.contenders:
            slot = results.slot(setting, model, contender)
            value = results.value(slot, metric)
            if value is None:
                continue
            where = f"here, {setting.label}" if setting.label else "here"
            rows.append(
                markdown_row(
                    [
                        markdown_text(contender.label),
                        amount(value.median, metric),
                        markdown_text(where),
                    ]
                )
            )
    return rows


def sizes_claimed(judged: Sequence[Judged]) -> list[Metric]:
    """The sizes of which there is a figure to draw, each once."""
    return list(
        {e.claim.size.name: e.claim.size for e in judged if e.law}.values()
    )


def draw(
    results: Results, judged: Sequence[Judged], size: Metric, title: str
) -> Sheet:
    """Cells as markers, fits as lines, claims as dashes through the middle."""
    time = results.metric(scaling.TIME)
    assert time is not None
    shown = [e for e in judged if e.claim.size == size and e.law is not None]
    points = [p for entry in shown for p in entry.points]
    x_scale = scale_for(size, (x for x, _ in points))
    y_scale = scale_for(time, (y for _, y in points))
    contender_looks = looks(results.contenders)
    sheet = Sheet(
        width=scaling.WIDTH,
        body_height=scaling.HEIGHT,
        title=title,
        notes=[
            "Full lines are power laws by least squares of the logarithms, "
            "dashed ones have the claimed exponent. Each marker is a cell."
        ],
        legend=[
            LegendEntry(
                scaling.marker_handle(contender_looks[e.claim.contender.row_id]),
                f"{e.claim.contender.label}: claimed {e.claim.exponent:g}, "
                f"{scaling.exponent_text(e.law)}",
            )
            for e in shown
            if e.law is not None
        ],
    )
    axes = sheet.panels(1, 1)[0][0]
    for entry in shown:
        law = entry.law
        assert law is not None
        look = contender_looks[entry.claim.contender.row_id]
        scaling.draw_law(axes, entry.points, law, look, x_scale, y_scale)
        xs = [entry.points[0][0], entry.points[-1][0]]
        middle = math.sqrt(xs[0] * xs[1])
        height = law.factor * middle**law.exponent
        axes.add_line(
            Line2D(
                [x_scale(x) for x in xs],
                [
                    y_scale(height * (x / middle) ** entry.claim.exponent)
                    for x in xs
                ],
                color=look.colour,
                linewidth=1,
                linestyle=(0, (4, 3)),
                zorder=1,
            )
        )
    scaling.set_up_axes(axes, size, x_scale, time, y_scale)
    return sheet
