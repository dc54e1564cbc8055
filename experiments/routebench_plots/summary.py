"""What an experiment shows, on one Markdown page.

Contenders are compared model by model with one of them, the baseline: only
models on which both are valid count, so nobody gains by failing on the hard
ones, and the page says on how many models each figure rests.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from . import claims, scaling, simplified, sweep
from .comparison import (
    SHIFT,
    TIME_MARGIN,
    Comparison,
    Comparisons,
    Ranking,
    baseline_of,
    compared_metrics,
    valid_models,
)
from .errors import PlotError
from .inference import LEVEL
from .latex import latex_name, latex_text
from .markdown import markdown_table, markdown_text
from .naming import nearest
from .quantities import in_sentence
from .ranks import friedman_text
from .results import VALID, Item, Metric, Results
from .style import ABSENT, outcome_look

_MOST_PAIRS = 12


@dataclass(frozen=True)
class Line:
    """One contender under one setting."""

    contender: str
    valid: int
    models: int
    comparisons: list[Comparison | None]
    """One a metric; None where no model is shared."""


@dataclass(frozen=True)
class Miss:
    """A cell that is not valid."""

    contender: str
    model: str
    outcome: str
    reason: str


@dataclass(frozen=True)
class Test:
    """What holds for all contenders on one metric."""

    metric: Metric
    ranking: Ranking | None
    pairs: int
    """Pairs of contenders that share models."""
    alike: list[tuple[str, str]]
    """Those of them that are not told apart."""
    least_p: float
    """The smallest p-value that so many models and pairs can give."""


@dataclass(frozen=True)
class Part:
    """All about one setting."""

    setting: str
    baseline: str
    metrics: list[Metric]
    lines: list[Line]
    """The least travel first; contenders that share no model last."""
    tests: list[Test]
    """One a metric."""
    misses: list[Miss]
    growth: list[tuple[str, scaling.Fit]]
    """Contenders with the power law of their planning time, if any."""


@dataclass(frozen=True)
class Summary:
    """All about an experiment."""

    parts: list[Part]
    """One a setting."""
    policy: list[str] = field(default_factory=list)
    """What a sweep of the retraction policy shows, as Markdown."""
    claims: list[str] = field(default_factory=list)
    """Claims and published figures beside what was measured, as Markdown."""
    simplified: list[str] = field(default_factory=list)
    """What simplifying models saves, as Markdown."""


def summary(results: Results, baseline: str | None = None) -> Summary:
    """Every setting's comparison.

    Without a name the baseline of a setting is the contender that is valid
    on most models, of several the first by name.
    """
    names = [contender.label for contender in results.contenders]
    if baseline is not None and baseline not in names:
        raise PlotError(
            f"{results.database}: no contender '{baseline}'"
            + nearest(baseline, names)
        )
    return Summary(
        [_part(results, setting, baseline) for setting in results.settings],
        _policy(results),
        [
            *claims.claims_markdown(claims.judged_claims(results)),
            *claims.published_markdown(results),
        ],
        simplified.simplified_markdown(results),
    )


def to_markdown(made: Summary, experiment: str) -> str:
    """The summary as a page."""
    lines = [
        f"# What {markdown_text(experiment)} shows",
        "",
        "Each figure is a contender's total over that of the baseline on the "
        "same model, as the geometric mean over the models on which both are "
        "valid; below 1 is better. In brackets: on how many of these models "
        f"the contender is worse. {SHIFT:.0f} (mm, s, ns, or piece) is added "
        "to both totals, so that a total of 0 has a ratio.",
        "",
        "The tables below *How sure that is* give the median of these ratios "
        "with its 95 % interval (bootstrap with the models as the sample, "
        "for times with their repetitions drawn anew; with fewer than six "
        "models it covers less), and the p-value of Wilcoxon's signed-rank "
        "test over the models, corrected by Holm for all pairs of contenders. "
        f"A difference is called one if p < {LEVEL}; of times the median must "
        f"differ by more than {TIME_MARGIN:.0%}, too, for equal code measured "
        "twice differs by a few percent.".replace("%,", " %,"),
    ]
    lines += made.claims
    lines += made.simplified
    if made.policy:
        lines += ["", "## Retraction policy", "", *made.policy]
    for part in made.parts:
        lines += ["", f"## {markdown_text(part.setting or 'All models')}", ""]
        lines += _table(part)
        lines += _certainty(part)
        if part.growth:
            lines += [
                "",
                "Planning CPU time grows with the extruded length to the "
                "power of (with 95 % interval, over models):",
                "",
            ]
            lines += [
                f"- {markdown_text(name)}: {scaling.exponent_text(law)}"
                f" ({law.points} models)"
                for name, law in part.growth
            ]
        if part.misses:
            lines += ["", "Not valid:", ""]
            lines += _missed(part)
    return "\n".join(lines) + "\n"


def to_latex(made: Summary) -> str:
    """A booktabs table for each setting: ratios to the baseline, and how sure they are."""
    lines = [
        r"% Needs \usepackage{array,booktabs}. Median over the models of the",
        "% ratio to the baseline with its 95 % bootstrap interval, geometric",
        "% mean, models on which the contender is worse, and p of Wilcoxon's",
        "% signed-rank test corrected by Holm for all pairs of contenders.",
    ]
    for part in made.parts:
        if len(part.lines) < 2:
            continue
        if part.setting:
            lines.append(f"% {part.setting}")
        lines += [
            r"\begin{tabular}{>{\raggedright\arraybackslash}p{0.3\linewidth}rrrr}",
            r"\toprule",
            rf"Against {latex_name(part.baseline)} & Median [95\,\%] & Mean & Worse on & $p$ \\",
        ]
        for place, metric in enumerate(part.metrics):
            lines += [
                r"\midrule",
                rf"\multicolumn{{5}}{{l}}{{\textit{{{latex_text(metric.label)}}}}} \\",
            ]
            lines += [
                " & ".join(_latex_cells(line.contender, line.comparisons[place])) + r" \\"
                for line in part.lines
                if line.contender != part.baseline
            ]
        lines += [r"\bottomrule", r"\end{tabular}", ""]
    return "\n".join(lines)


def _latex_cells(contender: str, made: Comparison | None) -> list[str]:
    # Braces, for after a line's end a bracket would be an argument.
    name = "{}" + latex_name(contender)
    if made is None:
        return [name, "--", "--", "--", "--"]
    return [
        name,
        interval_text(made),
        f"{made.ratio:.3g}",
        f"{made.worse} of {made.shared}",
        p_value_text(made.p).replace("<", "$<$"),
    ]


def interval_text(made: Comparison) -> str:
    """Median and interval."""
    low, high = made.interval.low, made.interval.high
    return f"{made.median:.3g} [{low:.3g}, {high:.3g}]"


def p_value_text(p: float) -> str:
    """A p-value in a table."""
    return "< 0.0001" if p < 0.0001 else f"{p:.2g}"


def verdict(made: Comparison) -> str:
    """What the comparison amounts to, in words."""
    if not made.differs:
        return "no difference shown"
    return "better" if made.median < 1 else "worse"


def _part(results: Results, setting: Item, baseline: str | None) -> Part:
    metrics = compared_metrics(results)
    compared = [Comparisons(results, setting, metric) for metric in metrics]
    base = baseline_of(results, setting, baseline)
    lines = [
        Line(
            contender=contender.label,
            valid=valid_models(results, setting, contender),
            models=len(results.models),
            comparisons=[pairs.compare(contender, base) for pairs in compared],
        )
        for contender in results.contenders
    ]
    lines.sort(key=_least_first)
    return Part(
        setting.label,
        base.label,
        metrics,
        lines,
        [
            Test(
                pairs.metric,
                pairs.ranking(),
                pairs.pairs,
                [(a.label, b.label) for a, b in pairs.not_told_apart()],
                pairs.least_p,
            )
            for pairs in compared
        ],
        _misses(results, setting),
        _growth(results, setting),
    )


def _growth(
    results: Results, setting: Item
) -> list[tuple[str, scaling.Fit]]:
    size, time = results.metric(scaling.SIZE), results.metric(scaling.TIME)
    if size is None or time is None:
        return []
    found = scaling.fits(results, setting, size, time)
    return [
        (contender.label, found[contender.row_id][1])
        for contender in results.contenders
        if contender.row_id in found
    ]


def _least_first(line: Line) -> tuple[bool, float]:
    first = line.comparisons[0] if line.comparisons else None
    return (first is None, 0.0 if first is None else first.ratio)


def _misses(results: Results, setting: Item) -> list[Miss]:
    return [
        Miss(
            contender.label,
            model.label,
            outcome_look(cell.outcome).words,
            cell.reason,
        )
        for contender in results.contenders
        for model in results.models
        for cell in results.slot(setting, model, contender).cells
        if cell.outcome != VALID
    ]


def _policy(results: Results) -> list[str]:
    """The ranking under each policy, and where it flips."""
    found = sweep.find(results)
    if found is None or len(found.contenders) < 2:
        return []
    rows = []
    for setting in results.settings:
        order = sweep.ranked(found, setting)
        rows.append(
            [
                markdown_text(setting.label),
                ", ".join(
                    f"{markdown_text(contender.label)} {total:.0f}"
                    for contender, total in order
                ),
            ]
        )
    lines = [
        f"Retractions over the {len(found.models)} of {len(results.models)} "
        "models on which all these contenders are valid under every policy, "
        "the fewest first:",
        "",
        *markdown_table(["policy", "ranking"], rows, left=2),
        "",
    ]
    flips = [sweep.flip_text(found, flip) for flip in sweep.flips(found)]
    flips += [
        sweep.group_flip_text(found, flip)
        for flip in sweep.flips_between_groups(found)
    ]
    if flips:
        lines += ["The ranking flips:", ""]
        lines += [f"- {markdown_text(flip)}" for flip in flips]
    else:
        lines.append("The ranking flips nowhere.")
    if found.left_out:
        names = ", ".join(markdown_text(c.label) for c in found.left_out)
        lines += ["", f"Left out, valid on too few models: {names}."]
    return lines


def _missed(part: Part) -> list[str]:
    """A line for each miss, or one for a contender that is valid nowhere."""
    nowhere = {line.contender for line in part.lines if line.valid == 0}
    lines = []
    told = set()
    for miss in part.misses:
        if miss.contender in told:
            continue
        place = markdown_text(miss.model)
        if miss.contender in nowhere:
            told.add(miss.contender)
            place = f"every model, such as {place}"
        reason = f", {markdown_text(miss.reason)}" if miss.reason else ""
        lines.append(
            f"- {markdown_text(miss.contender)} on {place}: "
            f"{miss.outcome}{reason}"
        )
    return lines


def _table(part: Part) -> list[str]:
    heads = ["contender", "valid on"]
    heads += [in_sentence(metric.label) for metric in part.metrics]
    rows = []
    for line in part.lines:
        name = markdown_text(line.contender)
        if line.contender == part.baseline:
            name += " (baseline)"
        rows.append(
            [
                name,
                f"{line.valid} of {line.models}",
                *(_comparison(c) for c in line.comparisons),
            ]
        )
    return markdown_table([markdown_text(head) for head in heads], rows)


def _comparison(made: Comparison | None) -> str:
    if made is None:
        return ABSENT
    return f"{made.ratio:.3g} ({made.worse} of {made.shared})"


def _certainty(part: Part) -> list[str]:
    """A table of intervals and tests for each metric; none for one contender."""
    if len(part.lines) < 2:
        return []
    lines = ["", "### How sure that is"]
    for place, test in enumerate(part.tests):
        rows = [
            [
                markdown_text(line.contender),
                str(made.shared),
                interval_text(made),
                f"{made.worse} of {made.shared}",
                p_value_text(made.p),
                verdict(made),
            ]
            for line in part.lines
            if line.contender != part.baseline
            and (made := line.comparisons[place]) is not None
        ]
        if not rows:
            continue
        lines += [
            "",
            f"{markdown_text(test.metric.label)}, over that of "
            f"{markdown_text(part.baseline)}:",
            "",
            *markdown_table(
                [
                    "contender",
                    "models",
                    "median [95 %]",
                    "worse on",
                    "p (Holm)",
                    "verdict",
                ],
                rows,
            ),
            *_among_all(test),
        ]
    return lines


def _among_all(test: Test) -> list[str]:
    """What the contenders are among each other."""
    lines = []
    if test.ranking is not None:
        means = sorted(
            zip(test.ranking.test.mean_ranks, test.ranking.contenders),
            key=lambda entry: entry[0],
        )
        ranks = ", ".join(
            f"{markdown_text(contender.label)} {rank:.2f}"
            for rank, contender in means
        )
        lines += [
            "",
            f"{friedman_text(test.ranking)}. Mean ranks (Nemenyi's critical "
            f"difference {test.ranking.test.critical_difference:.2f}): "
            f"{ranks}.",
        ]
    if test.least_p >= LEVEL:
        lines += [
            "",
            f"With {test.pairs} pairs on so few models p is never below "
            f"{p_value_text(test.least_p)}: more models or fewer contenders "
            "are needed to tell any pair apart.",
        ]
    elif test.alike:
        pairs = "; ".join(
            f"{markdown_text(one)} and {markdown_text(other)}"
            for one, other in test.alike[:_MOST_PAIRS]
        )
        more = len(test.alike) - _MOST_PAIRS
        if more > 0:
            pairs += f"; and {more} more pairs"
        lines += ["", f"Not told apart: {pairs}."]
    return lines
