"""What a command says on a terminal while it works."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager


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
