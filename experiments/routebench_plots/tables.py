"""The totals of every cell as tables, for Markdown and for LaTeX."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from .latex import latex_name, latex_text
from .markdown import markdown_row, markdown_text
from .quantities import Scale, format_number, pretty_unit, scale_for
from .results import VALID, Item, Metric, Results, Slot
from .style import ABSENT, outcome_look

_ARROWS = {"lower": "↓", "higher": "↑", "neither": ""}


@dataclass(frozen=True)
class Number:
    """An entry of a table; `best` of its model and metric."""

    text: str
    best: bool


@dataclass(frozen=True)
class Row:
    """One contender on one model; no rank where it cannot have one."""

    rank: int | None
    contender: str
    numbers: list[Number]
    outcome: str
    reason: str


@dataclass(frozen=True)
class Block:
    """One model under one setting, the best contender first."""

    model: str
    rows: list[Row]


@dataclass(frozen=True)
class Table:
    """All models under one setting."""

    setting: str
    heads: list[tuple[str, str]]
    """Label, and unit with an arrow towards what is better."""
    blocks: list[Block]


def tables(results: Results, metrics: Sequence[Metric]) -> list[Table]:
    """A table for each setting.

    Contenders are ranked by the first metric that has a better direction;
    ties share a rank. A cell that is not valid has neither rank nor number
    but its outcome and the reason for it.
    """
    ranked_by = next(
        (m for m in metrics if m.better in ("lower", "higher")), None
    )
    return [
        _table(results, setting, metrics, ranked_by)
        for setting in results.settings
    ]


def to_markdown(made: Sequence[Table], title: str) -> str:
    """All tables as one Markdown page."""
    lines = [
        f"# {markdown_text(title)}",
        "",
        "Totals of every cell. The arrow points to what is better, the best "
        "of a model is bold; only valid cells are ranked.",
    ]
    for table in made:
        if table.setting:
            lines += ["", f"## {markdown_text(table.setting)}"]
        heads = [
            "#",
            "contender",
            *(" ".join(filter(None, head)) for head in table.heads),
            "outcome",
        ]
        for block in table.blocks:
            lines += ["", f"### {markdown_text(block.model)}", ""]
            lines.append(markdown_row([markdown_text(head) for head in heads]))
            lines.append(
                markdown_row(
                    ["--:", ":--", *("--:" for _ in table.heads), ":--"]
                )
            )
            lines += [markdown_row(_markdown_cells(r)) for r in block.rows]
    return "\n".join(lines) + "\n"


def to_latex(made: Sequence[Table]) -> str:
    """A booktabs table for each setting."""
    lines = [r"% Needs \usepackage{array,booktabs}. Arrows: what is better."]
    for table in made:
        columns = len(table.heads) + 3
        if table.setting:
            lines.append(f"% {table.setting}")
        lines += [
            r"\begin{tabular}{r>{\raggedright\arraybackslash}p{0.22\linewidth}"
            + "r" * len(table.heads)
            + r">{\raggedright\arraybackslash}p{0.12\linewidth}}",
            r"\toprule",
            " & ".join(
                ["", "Contender"]
                + [latex_text(label) for label, _ in table.heads]
                + ["Outcome"]
            )
            + r" \\",
            " & ".join(
                ["", ""] + [latex_text(unit) for _, unit in table.heads] + [""]
            )
            + r" \\",
        ]
        for block in table.blocks:
            lines += [
                r"\midrule",
                rf"\multicolumn{{{columns}}}{{p{{0.95\linewidth}}}}"
                rf"{{\textit{{{latex_name(block.model)}}}}} \\",
            ]
            lines += [
                " & ".join(_latex_cells(row)) + r" \\" for row in block.rows
            ]
        lines += [r"\bottomrule", r"\end{tabular}", ""]
    return "\n".join(lines)


def _table(
    results: Results,
    setting: Item,
    metrics: Sequence[Metric],
    ranked_by: Metric | None,
) -> Table:
    slots = {
        model.row_id: [
            results.slot(setting, model, contender)
            for contender in results.contenders
        ]
        for model in results.models
    }
    scales = [
        scale_for(
            metric,
            (value.high for value in results.all_values(setting, metric)),
        )
        for metric in metrics
    ]
    return Table(
        setting=setting.label,
        heads=[_head(metric, scale) for metric, scale in zip(metrics, scales)],
        blocks=[
            Block(
                model.label,
                _rows(
                    results, slots[model.row_id], metrics, scales, ranked_by
                ),
            )
            for model in results.models
        ],
    )


def _head(metric: Metric, scale: Scale) -> tuple[str, str]:
    unit = f"[{pretty_unit(scale.unit)}]" if scale.unit else ""
    arrow = _ARROWS.get(metric.better, "")
    return metric.label, " ".join(filter(None, (unit, arrow)))


def _rows(
    results: Results,
    slots: Sequence[Slot],
    metrics: Sequence[Metric],
    scales: Sequence[Scale],
    ranked_by: Metric | None,
) -> list[Row]:
    columns = [_numbers(results, slots, m, s) for m, s in zip(metrics, scales)]
    ranks = _ranks(results, slots, ranked_by)
    rows = [
        Row(
            rank=ranks[place],
            contender=contender.label,
            numbers=[column[place] for column in columns],
            outcome=_outcome(slots[place]),
            reason="; ".join(
                cell.reason for cell in slots[place].cells if cell.reason
            ),
        )
        for place, contender in enumerate(results.contenders)
    ]
    return sorted(rows, key=lambda row: (row.rank is None, row.rank or 0))


def _numbers(
    results: Results, slots: Sequence[Slot], metric: Metric, scale: Scale
) -> list[Number]:
    """A metric's column for one model."""
    goodness = [_goodness(results, slot, metric) for slot in slots]
    best = min((g for g in goodness if g is not None), default=None)
    numbers = []
    for slot, good in zip(slots, goodness):
        value = results.value(slot, metric)
        text = format_number(scale(value.median)) if value else ABSENT
        numbers.append(Number(text, good is not None and good == best))
    return numbers


def _goodness(results: Results, slot: Slot, metric: Metric) -> float | None:
    """A number that is lower for the better value; None without one."""
    value = results.value(slot, metric)
    if value is None or metric.better not in ("lower", "higher"):
        return None
    return value.median if metric.better == "lower" else -value.median


def _ranks(
    results: Results, slots: Sequence[Slot], metric: Metric | None
) -> list[int | None]:
    if metric is None:
        return [None] * len(slots)
    goodness = [_goodness(results, slot, metric) for slot in slots]
    known = [good for good in goodness if good is not None]
    return [
        None if good is None else 1 + sum(other < good for other in known)
        for good in goodness
    ]


def _outcome(slot: Slot) -> str:
    counts = slot.outcomes
    return ", ".join(
        outcome_look(outcome).words
        + (f" ×{count}" if counts.total() > 1 else "")
        for outcome, count in sorted(
            counts.items(), key=lambda entry: (entry[0] != VALID, entry[0])
        )
    )


def _markdown_cells(row: Row) -> list[str]:
    outcome = f"{row.outcome}: {row.reason}" if row.reason else row.outcome
    return [
        "–" if row.rank is None else str(row.rank),
        markdown_text(row.contender),
        *(f"**{n.text}**" if n.best else n.text for n in row.numbers),
        markdown_text(outcome),
    ]


def _latex_cells(row: Row) -> list[str]:
    return [
        "--" if row.rank is None else str(row.rank),
        latex_name(row.contender),
        *(
            rf"\textbf{{{latex_text(n.text)}}}" if n.best else latex_text(n.text)
            for n in row.numbers
        ),
        latex_text(row.outcome),
    ]
