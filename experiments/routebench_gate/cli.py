"""The command behind `routebench gate`."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from routebench_plots.console import EXIT_DONE, Parser, guarded, write_out
from routebench_plots.database import find_database
from routebench_plots.errors import PlotError
from routebench_plots.results import Results

from .compare import compare
from .limits import Limits, metrics_of, parse_share
from .page import regressions, to_markdown

EXIT_REGRESSION = 1


def main(arguments: Sequence[str] | None = None) -> int:
    """Compares, prints the page, and returns the exit code."""
    return guarded(lambda: _run(arguments), "interrupted")


def _run(arguments: Sequence[str] | None) -> int:
    options = _parse(arguments)
    with Results(find_database(options.old)) as old, Results(find_database(options.new)) as new:
        names = options.metrics.split(",") if options.metrics else None
        metrics = metrics_of(old, new, names)
        limits = _limits(options, old, new)
        made = compare(old, new, metrics, limits, options.times)
        page = to_markdown(made, old, new, options.require_all)
    write_out(page.encode())
    return EXIT_REGRESSION if regressions(made, options.require_all) else EXIT_DONE


def _limits(options: argparse.Namespace, old: Results, new: Results) -> Limits:
    own = {}
    for text in options.limit:
        name, equals, share = text.partition("=")
        if not equals:
            raise PlotError(f"--limit {text}: give METRIC=SHARE, such as retractions=2%")
        (metric,) = metrics_of(old, new, [name])
        own[metric.name] = parse_share(share, f"--limit {name}=")
    if options.travel is not None:
        own["travel_mm"] = parse_share(options.travel, "--travel")
    return Limits(
        parse_share(options.tolerance, "--tolerance"), parse_share(options.time, "--time"), own
    )


def _parse(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = Parser(prog="routebench gate", description=__doc__)
    parser.add_argument("old", type=Path)
    parser.add_argument("new", type=Path)
    parser.add_argument("--metrics")
    parser.add_argument("--tolerance", default="0.5%")
    parser.add_argument("--travel")
    parser.add_argument("--limit", action="append", default=[])
    parser.add_argument("--time", default="50%")
    parser.add_argument("--times", choices=("auto", "always", "never"), default="auto")
    parser.add_argument("--require-all", action="store_true")
    return parser.parse_args(arguments)
