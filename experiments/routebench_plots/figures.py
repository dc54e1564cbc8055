"""Draws everything that an experiment has to show into a folder."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from . import (
    bars,
    claims,
    curves,
    outcomes,
    routes,
    scaling,
    scatter,
    summary,
    tables,
)
from .errors import PlotError
from .naming import file_slugs
from .quantities import in_sentence
from .results import Item, Metric, Results
from .sheet import Sheet
from .style import applied

METRICS_OF_INTEREST = (
    "travel_mm",
    "retractions",
    "crossings",
    "strokes",
    "covered",
    "deposit",
    "doubled",
    "print_time_s",
    "plan_cpu_ns",
)
"""What gets bars and a column in the tables unless others are named."""

_CURVES = ("travel_mm", "retractions")
_RUNTIME = scaling.TIME
_COST = "travel_mm"
_MODELS_PER_MATRIX = 30


@dataclass(frozen=True)
class Figure:
    """A figure still to be drawn, and its file's name without ending."""

    stem: str
    draw: Callable[[], Sheet]


def chosen_metrics(
    results: Results, names: Sequence[str] | None
) -> list[Metric]:
    """The metrics with these names.

    Without names, those of interest that have any value. The name `all`
    means every metric of the database.
    """
    if names is None:
        return [
            metric
            for name in METRICS_OF_INTEREST
            if (metric := results.metric(name)) is not None
            and results.has_values(metric)
        ]
    if list(names) == ["all"]:
        return list(results.metrics)
    chosen = []
    for name in names:
        metric = results.metric(name)
        if metric is None:
            known = [m.name for m in results.metrics]
            near = difflib.get_close_matches(name, known, n=1)
            hint = (
                f"did you mean '{near[0]}'?"
                if near
                else f"it has {', '.join(known)}"
            )
            raise PlotError(f"{results.database}: no metric '{name}'; {hint}")
        chosen.append(metric)
    return chosen


def figures(results: Results, metrics: Sequence[Metric]) -> Iterator[Figure]:
    """All figures; the outcome matrices come first."""
    models = file_slugs([model.label for model in results.models])
    settings = file_slugs([setting.label for setting in results.settings])
    plain = len(results.settings) == 1 and not results.settings[0].label
    suffixes = {
        setting.row_id: "" if plain else f"--{settings[setting.label]}"
        for setting in results.settings
    }
    for setting in results.settings:
        yield from _outcome_figures(results, setting, suffixes[setting.row_id])
    for setting in results.settings:
        suffix = suffixes[setting.row_id]
        yield from _metric_figures(results, setting, metrics, suffix)
        for model in results.models:
            yield from _model_figures(
                results, setting, model, models[model.label], suffix
            )


def claim_figures(
    results: Results, judged: Sequence[claims.Judged]
) -> Iterator[Figure]:
    """Claimed and measured growth, a figure for each size."""
    for size in claims.sizes_claimed(judged):
        yield Figure(
            f"claims-{size.name}",
            partial(
                claims.draw,
                results,
                judged,
                size,
                f"Claimed and measured growth with {in_sentence(size.label)}",
            ),
        )


def draw_all(
    results: Results,
    metrics: Sequence[Metric],
    folder: Path,
    formats: Sequence[str],
    report: Callable[[int, int], None],
    baseline: str | None = None,
) -> list[str]:
    """Writes all figures and tables; returns file names in that order.

    Equal databases make equal bytes. `report` hears after each figure how
    many are done, and of how many.
    """
    compared = summary.summary(results, baseline)
    judged = claims.judged_claims(results)
    written = []
    with applied():
        planned = [
            *figures(results, metrics),
            *claim_figures(results, judged),
        ]
        for done, figure in enumerate(planned, start=1):
            figure.draw().save(folder, figure.stem, formats)
            written += [f"{figure.stem}.{ending}" for ending in formats]
            report(done, len(planned))
    made = tables.tables(results, metrics)
    for name, text in (
        (
            "summary.md",
            summary.to_markdown(compared, results.experiment)
            + "".join(
                line + "\n"
                for line in (
                    *claims.claims_markdown(judged),
                    *claims.published_markdown(results),
                )
            ),
        ),
        (
            "table.md",
            tables.to_markdown(made, f"Totals of {results.experiment}"),
        ),
        ("table.tex", tables.to_latex(made)),
    ):
        (folder / name).write_text(text, encoding="utf-8")
        written.append(name)
    return written


def _titled(words: str, setting: Item, page: int = 0, pages: int = 1) -> str:
    title = f"{words}, {setting.label}" if setting.label else words
    return f"{title} ({page + 1}/{pages})" if pages > 1 else title


def _paged(
    stem: str, suffix: str, models: Sequence[Item], per_page: int
) -> list[tuple[str, Sequence[Item]]]:
    """File names and models of the pages that a long list takes."""
    pages = [
        models[start : start + per_page]
        for start in range(0, len(models), per_page)
    ]
    return [
        (f"{stem}{f'-{n}' if len(pages) > 1 else ''}{suffix}", page)
        for n, page in enumerate(pages, start=1)
    ]


def _outcome_figures(
    results: Results, setting: Item, suffix: str
) -> Iterator[Figure]:
    pages = _paged("outcomes", suffix, results.models, _MODELS_PER_MATRIX)
    words = f"Outcomes of {results.experiment}"
    for number, (stem, models) in enumerate(pages):
        title = _titled(words, setting, number, len(pages))
        yield Figure(
            stem, partial(outcomes.draw, results, setting, models, title)
        )


def _metric_figures(
    results: Results, setting: Item, metrics: Sequence[Metric], suffix: str
) -> Iterator[Figure]:
    per_page = bars.layout_for(results).models_per_page
    slugs = file_slugs([metric.name for metric in metrics])
    for metric in metrics:
        stem = f"bars-{slugs[metric.name]}"
        pages = _paged(stem, suffix, results.models, per_page)
        for number, (stem, models) in enumerate(pages):
            title = _titled(metric.label, setting, number, len(pages))
            yield Figure(
                stem,
                partial(bars.draw, results, setting, metric, models, title),
            )
    cost, runtime = results.metric(_COST), results.metric(_RUNTIME)
    if cost is not None and runtime is not None:
        words = f"{cost.label} against {in_sentence(runtime.label)}"
        yield Figure(
            f"scatter-{cost.name}-{runtime.name}{suffix}",
            partial(
                scatter.draw,
                results,
                setting,
                runtime,
                cost,
                _titled(words, setting),
            ),
        )
    size = results.metric(scaling.SIZE)
    if (
        size is not None
        and runtime is not None
        and scaling.fits(results, setting, size, runtime)
    ):
        words = f"Growth of {in_sentence(runtime.label)}"
        yield Figure(
            f"scaling-{runtime.name}-{size.name}{suffix}",
            partial(
                scaling.draw,
                results,
                setting,
                size,
                runtime,
                _titled(words, setting),
            ),
        )


def _model_figures(
    results: Results, setting: Item, model: Item, slug: str, suffix: str
) -> Iterator[Figure]:
    metrics = [
        metric
        for name in _CURVES
        if (metric := results.metric(name)) is not None
    ]
    if metrics:
        title = _titled(f"Layers of {model.label}", setting)
        yield Figure(
            f"layers-{slug}{suffix}",
            partial(curves.draw, results, setting, model, metrics, title),
        )
    for index, z_mm in results.kept_layers(setting, model):
        title = _titled(
            f"Layer {index} of {model.label}, z = {z_mm:.6g} mm", setting
        )
        yield Figure(
            f"routes-{slug}-layer{index}{suffix}",
            partial(routes.draw, results, setting, model, index, title),
        )
