"""What simplifying models saves, and by how much it moves their surface."""

from __future__ import annotations

from collections import defaultdict
from typing import Any

from .markdown import markdown_table, markdown_text
from .quantities import amount, format_number, in_sentence
from .results import Item, Metric, Results
from .style import ABSENT

_TIMES = ("job_wall_s", "plan_cpu_ns")
"""The first of them that a contender has is its time."""


def simplified_markdown(results: Results) -> list[str]:
    """Triangles, deviation and times of models of which some were simplified.

    Returns a section of Markdown; nothing where no model was simplified.
    """
    lines: list[str] = []
    for setting in results.settings:
        rows = [
            _row(results, setting, model, original)
            for original, family in _families(results, setting)
            for model in family
        ]
        if not rows:
            continue
        if setting.label:
            lines += ["", f"### {markdown_text(setting.label)}"]
        lines += ["", *markdown_table(_heads(results), rows)]
    if not lines:
        return []
    return [
        "",
        "## Simplified models",
        "",
        "How many triangles are left, by how much the surface has moved at most, and what contenders "
        "take: the time of the whole job where one has it, else of planning or cutting, as the median; "
        "in brackets over that of the model as it came. Simplifying comes before and is in none of "
        "these times.",
        *lines,
    ]


def as_it_came(label: str) -> str:
    """The label of the model that was simplified."""
    name, _, query = label.partition("?")
    rest = [part for part in query.split("&") if part and not part.startswith("simplify=")]
    return name + ("?" + "&".join(rest) if rest else "")


def _families(results: Results, setting: Item) -> list[tuple[Item | None, list[Item]]]:
    """Models of one origin, the most triangles first, with the one as it came if it is there."""
    families: dict[str, list[Item]] = defaultdict(list)
    for model in results.models:
        if results.model_row(setting, model) is not None:
            families[as_it_came(model.label)].append(model)
    return [
        (
            next((m for m in family if _simplification(results, setting, m) is None), None),
            sorted(family, key=lambda m: -(results.model_size(setting, m, "triangles") or 0)),
        )
        for family in families.values()
        if any(_simplification(results, setting, m) is not None for m in family)
    ]


def _simplification(results: Results, setting: Item, model: Item) -> dict[str, Any] | None:
    return (results.model_report(setting, model).get("mesh") or {}).get("simplification")


def _heads(results: Results) -> list[str]:
    heads = ["model", "triangles", "moved by at most", "vertices of all outlines"]
    for contender in results.contenders:
        time = _time_of(results, contender)
        heads.append(contender.label + (f", {in_sentence(time.label)}" if time else ""))
    return [markdown_text(head) for head in heads]


def _row(results: Results, setting: Item, model: Item, original: Item | None) -> list[str]:
    simplification = _simplification(results, setting, model)

    def size(name: str) -> str:
        found = results.model_size(setting, model, name)
        return ABSENT if found is None else format_number(found)

    cells = [
        markdown_text(model.label),
        size("triangles"),
        "as it came" if simplification is None else f"{simplification['deviation_mm']:.2g} mm",
        size("outline_vertices"),
    ]
    for contender in results.contenders:
        time = _time_of(results, contender)
        value = time and results.value(results.slot(setting, model, contender), time)
        if not time or not value:
            cells.append(ABSENT)
            continue
        text = amount(value.median, time)
        before = original and results.value(results.slot(setting, original, contender), time)
        if before and model != original and before.median > 0:
            text += f" ({value.median / before.median:.2g})"
        cells.append(text)
    return cells


def _time_of(results: Results, contender: Item) -> Metric | None:
    """What a contender's time is; nothing if it has none."""
    for name in _TIMES:
        metric = results.metric(name)
        if metric is not None and any(
            results.value(results.slot(setting, model, contender), metric) is not None
            for setting in results.settings
            for model in results.models
        ):
            return metric
    return None
