"""The command behind `routebench plot`."""

from __future__ import annotations

import argparse
import os
import shutil
import signal
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import NoReturn

from .errors import PlotError
from .figures import chosen_metrics, draw_all
from .naming import printable
from .results import Results, find_database
from .sheet import FORMATS

EXIT_DONE = 0
EXIT_BAD_INPUT = 2
EXIT_INTERNAL = 3
EXIT_INTERRUPTED = 128 + signal.SIGINT
_DEFAULT_FORMATS = "png,svg"
_INDEX = ".routebench-plots"
"""Names of the files of the last time, so that none of them goes stale."""


class Parser(argparse.ArgumentParser):
    """A parser whose complaints are one line, like all others."""

    def error(self, message: str) -> NoReturn:
        raise PlotError(f"{message} (see {self.prog} --help)")


def main(arguments: Sequence[str] | None = None) -> int:
    """Plots, prints the files written, and returns the exit code."""
    return carry_out(lambda: _run(arguments))


def carry_out(work: Callable[[], Sequence[Path]]) -> int:
    """Does a command's work, prints the files that it wrote.

    Returns the exit code. Whatever goes wrong is told in one line.
    """
    signal.signal(signal.SIGTERM, _exit_on_signal)
    try:
        paths = work()
    except PlotError as error:
        return _complain(str(error), EXIT_BAD_INPUT)
    except OSError as error:
        return _complain(f"{error.filename}: {error.strerror}", EXIT_BAD_INPUT)
    except KeyboardInterrupt:
        return _complain("interrupted, nothing written", EXIT_INTERRUPTED)
    except Exception as error:  # the last resort: still one line
        return _complain(f"internal error: {error!r}", EXIT_INTERNAL)
    _print_paths(paths)
    return EXIT_DONE


def _complain(message: str, exit_code: int) -> int:
    print(f"routebench: {printable(message)}", file=sys.stderr)
    return exit_code


def _print_paths(paths: Sequence[Path]) -> None:
    """One a line, byte for byte as the system has them."""
    try:
        for path in paths:
            sys.stdout.buffer.write(os.fsencode(path) + b"\n")
        sys.stdout.flush()
    except BrokenPipeError:
        # Whoever asked has read enough; Python would complain at its end.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


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
def progress(
    words: str = "drew {} of {} figures",
) -> Iterator[Callable[[int, int], None]]:
    """A line on stderr that comes and goes; nothing if no one looks on."""
    start = time.monotonic()

    def report(done: int, total: int) -> None:
        left = (time.monotonic() - start) / done * (total - done)
        _show(f"{words.format(done, total)}, about {left:.0f} s left")

    try:
        yield report
    finally:
        _show("")


def _show(text: str) -> None:
    """Puts text in the place of the terminal's last line."""
    if sys.stderr.isatty():
        print(f"\r\033[K{text}", end="", file=sys.stderr, flush=True)


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


def _exit_on_signal(number: int, _: object) -> NoReturn:
    """Lets `finally` run: nothing half-written stays behind."""
    sys.exit(128 + number)
