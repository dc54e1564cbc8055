"""What the commands written in Python share: usage, exit codes, errors in one line."""

from __future__ import annotations

import argparse
import os
import signal
import sys
from collections.abc import Callable
from typing import NoReturn

from .errors import PlotError
from .naming import printable

EXIT_DONE = 0
EXIT_BAD_INPUT = 2
EXIT_INTERNAL = 3
EXIT_INTERRUPTED = 128 + signal.SIGINT


class Parser(argparse.ArgumentParser):
    """Raises what is wrong with a command line."""

    def error(self, message: str) -> NoReturn:
        raise PlotError(f"{message} (see {self.prog} --help)")


def guarded(work: Callable[[], int], interrupted: str) -> int:
    """The exit code of the work, or of what went wrong with it, said in one line."""
    signal.signal(signal.SIGTERM, _exit_on_signal)
    try:
        return work()
    except PlotError as error:
        return _complain(str(error), EXIT_BAD_INPUT)
    except OSError as error:
        where = "" if error.filename is None else f"{error.filename}: "
        return _complain(f"{where}{error.strerror or error}", EXIT_BAD_INPUT)
    except KeyboardInterrupt:
        return _complain(interrupted, EXIT_INTERRUPTED)
    except Exception as error:  # the last resort: still one line
        return _complain(f"internal error: {error!r}", EXIT_INTERNAL)


def write_out(data: bytes) -> None:
    """Data for stdout; whoever reads it may stop before its end."""
    if sys.stdout is None:
        raise PlotError("standard output: cannot be written: it is closed")
    try:
        sys.stdout.buffer.write(data)
        sys.stdout.flush()
    except OSError as error:
        # Python would complain about it once more at its own end.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        if not isinstance(error, BrokenPipeError):
            raise PlotError(
                f"standard output: cannot be written: {error.strerror}"
            ) from error


def _complain(message: str, exit_code: int) -> int:
    print(f"routebench: {printable(message)}", file=sys.stderr)
    return exit_code


def _exit_on_signal(number: int, _: object) -> NoReturn:
    """Lets `finally` run: nothing half-written stays behind."""
    sys.exit(128 + number)
