"""The parts of a report beside the viewer."""

from __future__ import annotations

import base64
import html
import json
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any
from urllib.parse import urlencode

from routebench_plots import style, summary
from routebench_plots.figures import Figure, chosen_metrics, figures
from routebench_plots.quantities import counted
from routebench_plots.results import VALID, Item, Results, Slot

from . import markdown
from .page import Section

_SHOWN_BY_THE_VIEWER = "routes-"
_LARGEST_VECTOR_BYTES = 600_000
"""Beyond that a figure is put in as pixels."""


def summary_section(results: Results, baseline: str | None) -> Section:
    """Every contender against a baseline, and what is not valid."""
    compared = summary.summary(results, baseline)
    text = summary.to_markdown(compared, results.experiment)
    # Its title stands above already.
    body = text.split("\n", 1)[1]
    return Section(
        "summary",
        "Summary and ranking",
        f'<section id="summary" class="text">{markdown.to_html(body)}</section>',
    )


def outcome_section(results: Results) -> Section:
    """How every cell ended, with the reasons."""
    return Section(
        "outcomes",
        "Outcomes",
        '<section id="outcomes">'
        + "\n".join(_matrices(results))
        + "</section>",
    )


def table_section() -> Section:
    """All cells and metrics; the page's script fills it."""
    return Section(
        "table",
        "All cells",
        '<section id="table"><p class="text">Totals of every cell. The arrow '
        "points to what is better; a click on a head sorts, a click on a "
        "figure shows the layer behind it in the viewer.</p>"
        '<div class="bar"><label>Filter '
        '<input type="search" placeholder="words of model, contender, outcome">'
        '</label><label><input type="checkbox"> all metrics</label>'
        '<output></output></div><div class="scroller" tabindex="0" '
        'role="region" aria-label="Totals of every cell"><table></table></div>'
        "</section>",
    )


def figure_section(
    results: Results,
    baseline: str | None,
    report: Callable[[int, int], None],
) -> Section:
    """All that `routebench plot` draws, but what the viewer shows better."""
    with style.applied(), tempfile.TemporaryDirectory() as folder:
        planned = [
            figure
            for figure in figures(
                results, chosen_metrics(results, None), baseline
            )
            if not figure.stem.startswith(_SHOWN_BY_THE_VIEWER)
        ]
        drawn = []
        for done, figure in enumerate(planned, start=1):
            drawn.append(_figure(figure, Path(folder)))
            report(done, len(planned))
    return Section(
        "figures",
        "Figures",
        '<section id="figures"><p class="text">As files for papers: '
        "<code>routebench plot</code>. Pictures of single layers are the "
        "route viewer’s.</p>"
        f'<div class="figures">{"".join(drawn)}</div>'
        '<dialog id="large-figure" aria-label="Figure"><img alt="" '
        'src="data:,"><form method="dialog"><button>Close</button></form>'
        "</dialog></section>",
    )


def provenance_section(results: Results) -> Section:
    """What was run, by which program, on which machine."""
    return Section(
        "provenance",
        "Provenance",
        '<section id="provenance" class="text">'
        + "\n".join(_provenance(results))
        + "</section>",
    )


def _matrices(results: Results) -> Iterator[str]:
    slots = [
        results.slot(setting, model, contender)
        for setting in results.settings
        for model in results.models
        for contender in results.contenders
    ]
    cells = [cell for slot in slots for cell in slot.cells]
    valid = sum(cell.outcome == VALID for cell in cells)
    missing = sum(not slot.cells for slot in slots)
    words = f"{valid} of {len(cells)} cells are valid; only these are ranked."
    if missing:
        words += f" {missing} were not run."
    if results.earlier_cells:
        words += (
            f" Left out: {counted(results.earlier_cells, 'cell')} of earlier "
            "runs that the last one did not ask for."
        )
    yield f"<p>{words}</p>"
    for setting in results.settings:
        if setting.label:
            yield f"<h3>{html.escape(setting.label)}</h3>"
        yield '<div class="scroller"><table class="matrix"><thead><tr><td></td>'
        for contender in results.contenders:
            yield f'<th scope="col">{html.escape(contender.label)}</th>'
        yield "</tr></thead><tbody>"
        for model in results.models:
            yield f'<tr><th scope="row">{html.escape(model.label)}</th>'
            for contender in results.contenders:
                slot = results.slot(setting, model, contender)
                link = _link(results, setting, model, contender)
                yield f"<td>{_outcomes(slot, link)}</td>"
            yield "</tr>"
        yield "</tbody></table></div>"


def _link(
    results: Results, setting: Item, model: Item, contender: Item
) -> str:
    """The address that shows a slot in the viewer; `web/place.js` reads it."""
    wishes = {"model": model.label, "a": contender.label}
    if len(results.settings) > 1:
        wishes["setting"] = setting.label
    return f"#{urlencode(wishes)}"


def _outcomes(slot: Slot, link: str) -> str:
    """The outcomes of a slot's cells, and why those not valid are not."""
    several = slot.outcomes.total() > 1
    parts = []
    for outcome, count in sorted(slot.outcomes.items()):
        words = style.outcome_look(outcome).words
        times = f" ×{count}" if several else ""
        shown = (
            f'<span class="outcome {html.escape(outcome)}">'
            f"{html.escape(words)}{times}</span>"
        )
        if slot.cells:
            shown = f'<a href="{html.escape(link)}">{shown}</a>'
        parts.append(shown)
    reasons = dict.fromkeys(c.reason for c in slot.cells if c.reason)
    parts += [
        f'<span class="reason">{html.escape(reason)}</span>'
        for reason in reasons
    ]
    return " ".join(parts)


def _figure(figure: Figure, folder: Path) -> str:
    sheet = figure.draw()
    sheet.save(folder, figure.stem, ["svg"])
    file = folder / f"{figure.stem}.svg"
    kind = "svg+xml"
    if file.stat().st_size > _LARGEST_VECTOR_BYTES:
        sheet.save(folder, figure.stem, ["png"])
        file = folder / f"{figure.stem}.png"
        kind = "png"
    name = html.escape(figure.stem)
    data = base64.b64encode(file.read_bytes()).decode("ascii")
    return (
        f'<figure class="figure"><button type="button" '
        f'aria-label="Enlarge {name}"><img loading="lazy" alt="{name}" '
        f'src="data:image/{kind};base64,{data}"></button>'
        f"<figcaption>{name}</figcaption></figure>"
    )


def _provenance(results: Results) -> Iterator[str]:
    runs = list(results.records("SELECT * FROM run ORDER BY run_id"))
    for run in runs:
        title = "Run" if len(runs) == 1 else f"Run {run['run_id']}"
        yield f"<h3>{title}</h3>{_facts(run, ('run_id', 'config_text'))}"
    if runs and runs[-1].get("config_text"):
        yield "<h3>Config, verbatim</h3>"
        yield f"<pre>{html.escape(str(runs[-1]['config_text']))}</pre>"
    for table, items in (
        ("contender", results.contenders),
        ("setting", results.settings),
    ):
        yield from _rows(results, table, items)
    models = [
        Item(row, model.label)
        for setting in results.settings
        for model in results.models
        if (row := results.model_row(setting, model)) is not None
    ]
    yield from _rows(results, "model", tuple(dict.fromkeys(models)))


def _rows(
    results: Results, table: str, items: tuple[Item, ...]
) -> Iterator[str]:
    """Every column of a table's rows, folded away one by one."""
    key = f"{table}_id"
    found = {
        row[key]: row for row in results.records(f"SELECT * FROM {table}")
    }
    yield f"<h3>{table.capitalize()}s</h3>"
    for item in items:
        label = html.escape(item.label or "default")
        facts = _facts(found[item.row_id], (key,))
        yield f"<details><summary>{label}</summary>{facts}</details>"


def _facts(row: dict[str, Any], but: tuple[str, ...]) -> str:
    return (
        '<dl class="facts">'
        + "".join(
            f"<dt>{html.escape(name)}</dt><dd>{_value(name, value)}</dd>"
            for name, value in row.items()
            if name not in but and value not in (None, "")
        )
        + "</dl>"
    )


def _value(name: str, value: object) -> str:
    text = str(value)
    if name.endswith("_json"):
        try:
            text = json.dumps(json.loads(text), indent=1, ensure_ascii=False)
        except ValueError:
            pass
        return f"<pre>{html.escape(text)}</pre>"
    return html.escape(text)
