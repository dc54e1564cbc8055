"""Draws everything that an experiment has to show into a folder."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from . import (
    bars,
    claims,
    curves,
    heat,
    outcomes,
    profiles,
    ranks,
    ratios,
    routes,
    scaling,
    scatter,
    summary,
    sweep,
    tables,
)
from .comparison import baseline_of, compared_metrics
from .errors import PlotError
from .matrix import MODELS_PER_PAGE
from .naming import file_slugs, nearest
from .quantities import in_sentence
from .results import TIMED_METRICS, Item, Metric, Results
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
            raise PlotError(
                f"{results.database}: no metric '{name}'{nearest(name, known)}"
            )
        chosen.append(metric)
    return chosen


def figures(
    results: Results, metrics: Sequence[Metric], baseline: str | None = None
) -> Iterator[Figure]:
    """All figures; the outcome matrices come first.

    What settings of the printer alone cannot change is drawn for the first
    of them.
    """
    models = file_slugs([model.label for model in results.models])
    settings = file_slugs([setting.label for setting in results.settings])
    plain = len(results.settings) == 1 and not results.settings[0].label
    suffixes = {
        setting.row_id: "" if plain else f"--{settings[setting.label]}"
        for setting in results.settings
    }
    shown: set[object] = set()
    for setting in results.settings:
        if _is_new(results, setting, None, shown):
            suffix = suffixes[setting.row_id]
            yield from _outcome_figures(results, setting, suffix)
    yield from _sweep_figures(results)
    yield from _claim_figures(results)
    swept = sweep.find(results) is not None
    drawn: set[object] = set()
    for setting in results.settings:
        suffix = suffixes[setting.row_id]
        again = _plans_again(results, setting)
        fresh = [
            metric
            for metric in metrics
            if not (again and metric.name in TIMED_METRICS)
            and _is_new(results, setting, metric, drawn)
        ]
        yield from _comparison_figures(
            results,
            setting,
            compared_metrics(results, fresh),
            baseline_of(results, setting, baseline),
            suffix,
        )
        yield from _metric_figures(results, setting, fresh, suffix)
        for model in results.models:
            slug = models[model.label]
            if not (again and swept):
                yield from _curve_figures(
                    results, setting, model, slug, suffix
                )
            if not again:
                yield from _route_figures(
                    results, setting, model, slug, suffix
                )


def _claim_figures(results: Results) -> Iterator[Figure]:
    """Claimed and measured growth, a figure for each size."""
    judged = claims.judged_claims(results)
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


def _plans_again(results: Results, setting: Item) -> bool:
    """Whether an earlier setting differs in the printer alone.

    Planners do not see the printer: routes and planning are the same.
    """
    task, printer = results.task(setting), results.printer(setting)
    first = next(s for s in results.settings if results.task(s) == task)
    return results.printer(first) != printer


def _is_new(
    results: Results,
    setting: Item,
    metric: Metric | None,
    drawn: set[object],
) -> bool:
    """Whether a figure of the metric's totals (of the outcomes, if none) is due.

    It is not if a setting that differs in the printer alone has all the
    same in `drawn`, which is kept up.
    """
    slots = [
        results.slot(setting, model, contender)
        for model in results.models
        for contender in results.contenders
    ]
    shown = (
        metric,
        repr(results.task(setting)),
        tuple(
            (
                tuple((c.outcome, c.reason) for c in slot.cells),
                None if metric is None else results.value(slot, metric),
            )
            for slot in slots
        ),
    )
    if shown in drawn and _plans_again(results, setting):
        return False
    drawn.add(shown)
    return True


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
    written = []
    with applied():
        planned = list(figures(results, metrics, baseline))
        for done, figure in enumerate(planned, start=1):
            figure.draw().save(folder, figure.stem, formats)
            written += [f"{figure.stem}.{ending}" for ending in formats]
            report(done, len(planned))
    made = tables.tables(results, metrics)
    for name, text in (
        ("summary.md", summary.to_markdown(compared, results.experiment)),
        (
            "table.md",
            tables.to_markdown(made, f"Totals of {results.experiment}"),
        ),
        ("table.tex", tables.to_latex(made)),
        ("comparison.tex", summary.to_latex(compared)),
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
    pages = _paged("outcomes", suffix, results.models, MODELS_PER_PAGE)
    words = f"Outcomes of {results.experiment}"
    for number, (stem, models) in enumerate(pages):
        title = _titled(words, setting, number, len(pages))
        yield Figure(
            stem, partial(outcomes.draw, results, setting, models, title)
        )


def _sweep_figures(results: Results) -> Iterator[Figure]:
    """Of the printer's retraction policy, if the settings are such a sweep."""
    found, metric = sweep.find(results), results.metric(sweep.METRIC)
    if found is not None and metric is not None:
        title = f"{metric.label} of {results.experiment} by policy"
        yield Figure(
            "retraction-sweep",
            partial(sweep.draw, results, metric, found, title),
        )


def _comparison_figures(
    results: Results,
    setting: Item,
    metrics: Sequence[Metric],
    baseline: Item,
    suffix: str,
) -> Iterator[Figure]:
    """What all models say together; nothing to compare, no figure."""
    if not metrics or len(results.contenders) < 2:
        return
    title = _titled(f"Ratios to {baseline.label}", setting)
    yield Figure(
        f"ratios{suffix}",
        partial(ratios.draw, results, setting, metrics, baseline, title),
    )
    title = _titled("Performance profiles", setting)
    yield Figure(
        f"profiles{suffix}",
        partial(profiles.draw, results, setting, metrics, title),
    )
    ranked = ranks.rankings(results, setting, metrics)
    if ranked:
        title = _titled("Mean ranks", setting)
        yield Figure(
            f"ranks{suffix}",
            partial(ranks.draw, results, setting, ranked, title),
        )
    for metric in metrics:
        pages = _paged(
            f"heat-{metric.name}", suffix, results.models, MODELS_PER_PAGE
        )
        words = f"{metric.label} as a multiple of the best"
        for number, (stem, models) in enumerate(pages):
            title = _titled(words, setting, number, len(pages))
            yield Figure(
                stem,
                partial(heat.draw, results, setting, metric, models, title),
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
    if _plans_again(results, setting):
        return
    cost, runtime = results.metric(_COST), results.metric(_RUNTIME)
    if (
        cost is not None
        and runtime is not None
        and scatter.has_points(results, setting, runtime, cost)
    ):
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


def _curve_figures(
    results: Results, setting: Item, model: Item, slug: str, suffix: str
) -> Iterator[Figure]:
    metrics = [
        metric
        for name in _CURVES
        if (metric := results.metric(name)) is not None
    ]
    valid = any(
        results.slot(setting, model, contender).valid
        for contender in results.contenders
    )
    if metrics and valid:
        title = _titled(f"Layers of {model.label}", setting)
        yield Figure(
            f"layers-{slug}{suffix}",
            partial(curves.draw, results, setting, model, metrics, title),
        )


def _route_figures(
    results: Results, setting: Item, model: Item, slug: str, suffix: str
) -> Iterator[Figure]:
    for index, z_mm in results.kept_layers(setting, model):
        title = _titled(
            f"Layer {index} of {model.label}, z = {z_mm:.6g} mm", setting
        )
        yield Figure(
            f"routes-{slug}-layer{index}{suffix}",
            partial(routes.draw, results, setting, model, index, title),
        )
