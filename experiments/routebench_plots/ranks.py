"""Critical-difference diagrams: mean ranks, and who cannot be told apart."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from .comparison import Comparisons, Ranking
from .inference import LEVEL, alike
from .quantities import counted
from .results import Item, Metric, Results
from .sheet import MARGIN, Rect, Sheet
from .style import MUTED, PAGE_WIDTH, SMALL_SIZE, TEXT_SIZE, Look, looks
from .tally import Tally
from .text import text_height, wrap

_NAME_WIDTH = 2.1
_GAP = 0.1
_BAR_STEP = 0.11
"""Between the bars of groups that cannot be told apart."""
_HEAD = 0.75
"""Above the axis: the metric, the critical difference, the numbers."""
_FOOT = 0.12


def rankings(
    results: Results, setting: Item, metrics: Sequence[Metric]
) -> list[tuple[Metric, Ranking]]:
    """Those metrics that have a ranking."""
    found = []
    for metric in metrics:
        ranking = Comparisons(results, setting, metric).ranking()
        if ranking is not None:
            found.append((metric, ranking))
    return found


def draw(
    results: Results, setting: Item, ranked: Sequence[tuple[Metric, Ranking]], title: str
) -> Sheet:
    """A diagram for each metric, one below the other; `ranked` is not empty."""
    contender_looks = looks(results.contenders)
    heights = [_height(ranking) for _, ranking in ranked]
    sheet = Sheet(
        width=PAGE_WIDTH,
        body_height=sum(heights),
        title=title,
        notes=_notes(results, setting, ranked[0][1]),
    )
    top = sheet.body.bottom + sheet.body.height
    for (metric, ranking), height in zip(ranked, heights):
        top -= height
        axes = sheet.axes_at(Rect(sheet.body.left, top, sheet.body.width, height))
        axes.set(xlim=(0, sheet.body.width), ylim=(height, 0))
        axes.set_axis_off()
        _draw_diagram(axes, metric, ranking, contender_looks)
    return sheet


def p_text(p: float) -> str:
    """A p-value as a sentence has it."""
    return "p < 0.0001" if p < 0.0001 else f"p = {p:.2g}"


def friedman_text(ranking: Ranking) -> str:
    """What the test says of all contenders together."""
    test = ranking.test
    return (
        f"Friedman over {counted(test.models, 'model')}: χ² = {test.chi_squared:.3g}, "
        f"{counted(len(ranking.contenders) - 1, 'degree')} of freedom, {p_text(test.p)}"
    )


def _sides(ranking: Ranking) -> tuple[list[int], list[int]]:
    """Places of the better half, the best first, and of the other half, the worst first."""
    order = sorted(
        range(len(ranking.contenders)), key=lambda place: ranking.test.mean_ranks[place]
    )
    half = -(-len(order) // 2)
    return order[:half], order[half:][::-1]


def _groups(ranking: Ranking) -> list[tuple[float, float]]:
    """First and last rank of each group that the critical difference spans."""
    ranks = sorted(ranking.test.mean_ranks)
    return [(ranks[a], ranks[b]) for a, b in alike(ranks, ranking.test.critical_difference)]


def _name_lines(contender: Item, rank: float) -> list[str]:
    return wrap(f"{contender.label} ({rank:.2f})", _NAME_WIDTH, TEXT_SIZE)


def _side_height(ranking: Ranking, places: Sequence[int]) -> float:
    lines = [
        _name_lines(ranking.contenders[place], ranking.test.mean_ranks[place]) for place in places
    ]
    return sum(text_height(len(one), TEXT_SIZE) + 0.05 for one in lines)


def _height(ranking: Ranking) -> float:
    bars = _BAR_STEP * (len(_groups(ranking)) + 1)
    return _HEAD + bars + max(_side_height(ranking, side) for side in _sides(ranking)) + _FOOT


def _draw_diagram(
    axes: Axes, metric: Metric, ranking: Ranking, contender_looks: dict[int, Look]
) -> None:
    """Inches from the upper left corner."""
    width = PAGE_WIDTH - 2 * MARGIN
    left, right = _NAME_WIDTH + 2 * _GAP, width - _NAME_WIDTH - 2 * _GAP
    contenders = len(ranking.contenders)

    def place_of(rank: float) -> float:
        return left + (rank - 1) / (contenders - 1) * (right - left)

    def line(xs: Sequence[float], ys: Sequence[float], width: float, colour: str) -> None:
        axes.add_line(
            Line2D(xs, ys, linewidth=width, color=colour, solid_capstyle="butt")
        )

    axes.text(0, 0.02, metric.label, weight="bold", va="top", size=TEXT_SIZE)
    axes.text(width, 0.02, friedman_text(ranking), ha="right", va="top", size=SMALL_SIZE)
    difference = ranking.test.critical_difference
    words = f"critical difference {difference:.2f}"
    if difference < contenders - 1:
        end = place_of(1 + difference)
        line([left, end], [0.42, 0.42], 1.2, "black")
        for x in (left, end):
            line([x, x], [0.38, 0.46], 1.2, "black")
    else:
        words += ", more than there are ranks"
    axes.text(left, 0.36, words, va="bottom", size=SMALL_SIZE)
    line([left, right], [_HEAD, _HEAD], 0.8, "black")
    step = -(-(contenders - 1) // 12)
    for rank in range(1, contenders + 1, step):
        x = place_of(rank)
        line([x, x], [_HEAD - 0.05, _HEAD], 0.8, "black")
        axes.text(x, _HEAD - 0.08, str(rank), ha="center", va="bottom", size=SMALL_SIZE)
    for number, (low, high) in enumerate(_groups(ranking), start=1):
        y = _HEAD + number * _BAR_STEP
        line([place_of(low) - 0.03, place_of(high) + 0.03], [y, y], 3.0, MUTED)

    start = _HEAD + _BAR_STEP * (len(_groups(ranking)) + 1)
    for side, places in enumerate(_sides(ranking)):
        y = start
        for place in places:
            contender, rank = ranking.contenders[place], ranking.test.mean_ranks[place]
            lines = _name_lines(contender, rank)
            height = text_height(len(lines), TEXT_SIZE) + 0.05
            middle = y + height / 2
            look = contender_looks[contender.row_id]
            end = left - _GAP if side == 0 else right + _GAP
            line([place_of(rank), place_of(rank), end], [_HEAD, middle, middle], 0.7, look.colour)
            axes.plot(
                [place_of(rank)],
                [_HEAD],
                marker=look.marker,
                markersize=5,
                color=look.colour,
                markeredgecolor="black",
                markeredgewidth=0.5,
                zorder=3,
            )
            axes.text(
                end + (-0.04 if side == 0 else 0.04),
                middle,
                "\n".join(lines),
                ha="right" if side == 0 else "left",
                va="center",
                size=TEXT_SIZE,
            )
            y += height


def _notes(results: Results, setting: Item, ranking: Ranking) -> list[str]:
    tally = Tally()
    kept = {model.row_id for model in ranking.models}
    left_out = {contender.row_id for contender in ranking.left_out}
    for model in results.models:
        for contender in results.contenders:
            why = None
            if contender.row_id in left_out:
                why = "of contenders valid on fewer than half of the models"
            elif model.row_id not in kept:
                why = "on models that some contender does not do"
            tally.add(results.slot(setting, model, contender), why)
    return [
        "Mean ranks over the models on which all contenders shown are valid, 1 is the best. A bar "
        "joins contenders whose mean ranks differ by less than the critical difference "
        f"(Nemenyi, level {LEVEL}): they cannot be told apart.",
        tally.sentence(),
    ]
