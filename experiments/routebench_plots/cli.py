"""The command behind `routebench plot`."""

from __future__ import annotations

import argparse
import os
import shutil
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from .console import EXIT_DONE, Parser, guarded, write_out
from .database import find_database
from .errors import PlotError
from .figures import chosen_metrics, draw_all
from .results import Results
from .sheet import FORMATS
from .terminal import progress

_DEFAULT_FORMATS = "png,svg"
_INDEX = ".routebench-plots"
"""Names of the files of the last time, so that none of them goes stale."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Plots, prints the files written, and returns the exit code."""

    def work() -> int:
        # One a line, byte for byte as the system has them.
        write_out(b"".join(os.fsencode(path) + b"\n" for path in _run(arguments)))
        return EXIT_DONE

    return guarded(work, "interrupted, nothing written")


def _run(arguments: Sequence[str] | None) -> list[Path]:
    options = _parse(arguments)
    formats = _formats(options.formats)
    database = find_database(options.results)
    out = options.out or database.parent / "plots"
    with Results(database) as results:
        names = options.metrics.split(",") if options.metrics else None
        metrics = chosen_metrics(results, names)
        with _staging(out) as folder, progress() as report:
            written = draw_all(
                results, metrics, folder, formats, report, options.baseline
            )
            _publish(folder, out, written)
    return [out / name for name in written]


def _parse(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = Parser(prog="routebench plot", description=__doc__)
    parser.add_argument("results", type=Path)
    parser.add_argument("--out", type=Path)
    parser.add_argument("--formats", default=_DEFAULT_FORMATS)
    parser.add_argument("--metrics")
    parser.add_argument("--baseline")
    return parser.parse_args(arguments)


def _formats(text: str) -> list[str]:
    formats = list(dict.fromkeys(text.split(",")))
    for name in formats:
        if name not in FORMATS:
            raise PlotError(
                f"--formats {text}: '{name}' is none of {', '.join(FORMATS)}"
            )
    return formats


@contextmanager
def _staging(out: Path) -> Iterator[Path]:
    """A folder beside `out` that is gone afterwards, whatever happens."""
    places = [out, *out.absolute().parents]
    beside = next(place for place in places if place.exists())
    try:
        folder = Path(tempfile.mkdtemp(prefix=".plots-", dir=beside))
    except OSError as error:
        raise PlotError(
            f"{out}: cannot write figures there: {error.strerror}"
        ) from error
    try:
        yield folder
    except OSError as error:
        raise PlotError(
            f"{out}: cannot write figures there: {error.strerror}"
        ) from error
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _publish(folder: Path, out: Path, written: Sequence[str]) -> None:
    """Moves finished files in and removes those of an earlier time."""
    out.mkdir(parents=True, exist_ok=True)
    index = out / _INDEX
    earlier = index.read_text("utf-8").split("\n") if index.is_file() else []
    for name in written:
        os.replace(folder / name, out / name)
    for name in set(earlier) - set(written) - {""}:
        if Path(name).name == name:
            (out / name).unlink(missing_ok=True)
    index.write_text("\n".join(written) + "\n", encoding="utf-8")
