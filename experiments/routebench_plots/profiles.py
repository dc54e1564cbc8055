"""Performance profiles: how often a contender is within a factor of the best."""

from __future__ import annotations

import math
from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import PercentFormatter

from .axis import ratio_ticks
from .comparison import SHIFT, Comparisons
from .curves import curve
from .inference import performance_ratios, profile
from .quantities import counted
from .results import Item, Metric, Results
from .sheet import LegendEntry, Sheet, even_columns
from .style import PAGE_WIDTH, TEXT_SIZE, Look, looks
from .tally import Tally
from .text import wrapped

_MOST_COLUMNS = 3
_PANEL_HEIGHT = 2.0
_WIDEST = 1000.0
"""Factor beyond which a profile is not followed."""


def draw(results: Results, setting: Item, metrics: Sequence[Metric], title: str) -> Sheet:
    """A panel for each metric, a staircase for each contender."""
    contender_looks = looks(results.contenders)
    columns = even_columns(len(metrics), _MOST_COLUMNS)
    rows = -(-len(metrics) // columns)
    tally = Tally()
    for model in results.models:
        for contender in results.contenders:
            tally.add(results.slot(setting, model, contender))
    sheet = Sheet(
        width=PAGE_WIDTH,
        body_height=rows * _PANEL_HEIGHT,
        title=title,
        notes=[
            "Share of the models on which a contender's total is at most a factor above the least "
            "total there; higher is better. Where it is not valid a contender never gets there: of "
            f"{counted(len(results.models), 'model')} none is left out of the shares.",
            tally.sentence(),
        ],
        legend=[
            LegendEntry(_stairs(contender_looks[c.row_id]), c.label) for c in results.contenders
        ],
    )
    panel_width = sheet.body.width / columns
    panels = sheet.row_by_row(len(metrics), columns)
    for axes, metric in zip(panels, metrics):
        pairs = Comparisons(results, setting, metric)
        costs = {
            c.row_id: [pairs.values.get((c.row_id, model.row_id)) for model in results.models]
            for c in results.contenders
        }
        _draw_panel(axes, results.contenders, performance_ratios(costs, SHIFT), contender_looks)
        axes.set_title(wrapped(metric.label, panel_width - 0.2, TEXT_SIZE))
        axes.set_xlabel(wrapped("Factor above the least", panel_width - 0.3, TEXT_SIZE))
    for axes in panels[::columns]:
        axes.set_ylabel("Share of models")
    return sheet


def _draw_panel(
    axes: Axes,
    contenders: Sequence[Item],
    ratios: dict[int, list[float]],
    contender_looks: dict[int, Look],
) -> None:
    finite = [r for row in ratios.values() for r in row if math.isfinite(r)]
    high = min(max(finite, default=1.0), _WIDEST)
    high = max(high**1.05, 1.02)
    for contender in contenders:
        row = ratios[contender.row_id]
        steps = sorted({r for r in row if r <= high})
        line = _stairs(contender_looks[contender.row_id])
        xs = [1.0, *(r for r in steps if r > 1), high]
        line.set_data(xs, [profile(row, x) for x in xs])
        line.set_markevery(range(len(xs) - 1))
        axes.add_line(line)
    axes.set_xscale("log")
    axes.set_xlim(1 / (high / 1.0) ** 0.03, high)
    axes.set_ylim(-0.04, 1.04)
    axes.yaxis.set_major_formatter(PercentFormatter(1, symbol=" %"))
    ratio_ticks(axes, 1.0, high)
    axes.grid(True)


def _stairs(look: Look) -> Line2D:
    line = curve(look)
    line.set_drawstyle("steps-post")
    return line
