"""What a command says while it works, and when it is done."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path


def print_paths(paths: Sequence[Path]) -> None:
    """One a line, byte for byte as the system has them."""
    try:
        for path in paths:
            sys.stdout.buffer.write(os.fsencode(path) + b"\n")
        sys.stdout.flush()
    except BrokenPipeError:
        # Whoever asked has read enough; Python would complain at its end.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


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
