"""The commands behind `routebench report` and `routebench view`."""

from __future__ import annotations

import argparse
import contextlib
import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from pathlib import Path

from routebench_plots.console import EXIT_DONE, Parser, guarded, write_out
from routebench_plots.database import DATABASE_NAME, find_database
from routebench_plots.errors import PlotError
from routebench_plots.naming import printable
from routebench_plots.results import Results
from routebench_plots.terminal import progress

from . import content, sections
from .page import page, viewer_section

_SQLITE_HEAD = b"SQLite format 3\0"
_MOVE = re.compile(r"^\s*(?:N\d+\s*)?G0*[0-3](?!\d)", re.MULTILINE | re.IGNORECASE)
_SCREENS = ("DISPLAY", "WAYLAND_DISPLAY")


def main(arguments: Sequence[str] | None = None) -> int:
    """Makes a page, prints where it is, and returns the exit code."""

    def work() -> int:
        write_out(os.fsencode(_run(arguments)) + b"\n")
        return EXIT_DONE

    return guarded(work, "interrupted, nothing written")


def _run(arguments: Sequence[str] | None) -> Path:
    options = _parse(arguments)
    if options.command == "report":
        database = find_database(options.input)
        text = _report(database, options.baseline)
        out = options.out or database.parent / "report.html"
    elif _is_results(options.input):
        database = find_database(options.input)
        text = _results_view(database)
        out = options.out or database.parent / "view.html"
    else:
        text = _gcode_view(options.input)
        out = options.out or _beside(options.input)
    _write(out, text)
    if options.command == "view" and not options.no_open:
        _show(out)
    return out


def _parse(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = Parser(prog="routebench", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    for name in ("report", "view"):
        command = commands.add_parser(name)
        command.add_argument("input", type=Path)
        command.add_argument("--out", type=Path)
        if name == "report":
            command.add_argument("--baseline")
        else:
            command.add_argument("--no-open", action="store_true")
    return parser.parse_args(arguments)


def _report(database: Path, baseline: str | None) -> str:
    with Results(database) as results, progress("drew {} of {} figures") as drawn:
        first = sections.summary_section(results, baseline)
        figures = sections.figure_section(results, baseline, drawn)
        return page(
            _content(results),
            [
                first,
                sections.outcome_section(results),
                viewer_section(),
                sections.table_section(),
                figures,
                sections.provenance_section(results),
            ],
        )


def _results_view(database: Path) -> str:
    with Results(database) as results:
        return page(_content(results), [viewer_section()])


def _content(results: Results) -> content.Content:
    with progress("packed {} of {} cells") as packed:
        return content.results_content(results, packed)


def _gcode_view(file: Path) -> str:
    data = file.read_bytes()
    if b"\0" in data[:4096]:
        raise PlotError(
            f"{file}: neither G-code nor results: it is binary; give a text "
            f"file of G-code, a folder of results, or its {DATABASE_NAME}"
        )
    text = data.decode("utf-8", errors="replace")
    if not _MOVE.search(text):
        raise PlotError(
            f"{file}: neither G-code nor results: no line of it is a move; give a file of "
            f"G-code, a folder of results, or its {DATABASE_NAME}"
        )
    name = printable(file.name)
    return page(content.gcode_content(name, text), [viewer_section()])


def _is_results(file: Path) -> bool:
    """A folder or a database; what is not there is left to its reader."""
    if file.is_dir():
        return True
    if not file.exists():
        raise PlotError(
            f"{file}: there is no such file; give one of G-code, or the "
            "folder that 'routebench run' wrote"
        )
    with file.open("rb") as stream:
        return stream.read(len(_SQLITE_HEAD)) == _SQLITE_HEAD


def _beside(file: Path) -> Path:
    """A name of our own, so that no page of the user's is overwritten."""
    return file.with_name(f"{file.name}.view.html")


def _show(file: Path) -> None:
    """Opens the page in the user's browser, if there is a screen for it."""
    opener = shutil.which("xdg-open")
    if opener and any(map(os.environ.get, _SCREENS)):
        subprocess.Popen(
            [opener, file.resolve()],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )


def _write(out: Path, text: str) -> None:
    """All of the page or nothing: it takes its name when it is whole."""
    if out.is_dir():
        raise PlotError(f"{out}: is a folder; --out names the file")
    missing = [place for place in out.absolute().parents if not place.exists()]
    try:
        _write_whole(out, text)
    except BaseException as error:
        for folder in missing:
            with contextlib.suppress(OSError):
                folder.rmdir()
        if not isinstance(error, OSError):
            raise
        raise PlotError(
            f"{out}: cannot write a page there: {error.strerror}; name "
            "another place with --out"
        ) from error


def _write_whole(out: Path, text: str) -> None:
    out.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(prefix=".page-", dir=out.parent)
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as stream:
            stream.write(text)
        # Files made for their owner alone become as readable as any other.
        umask = os.umask(0)
        os.umask(umask)
        os.chmod(name, 0o666 & ~umask)
        os.replace(name, out)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise
