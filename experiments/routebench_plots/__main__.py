"""Entry point; also runs as a file, `python3 routebench_plots/__main__.py`."""

import importlib
import logging
import sys
from pathlib import Path

NEEDED = (3, 11)
EXIT_BAD_INPUT = 2


def start(package: str = "routebench_plots") -> int:
    """Runs a package's command line.

    Checks what this Python lacks before anything else is imported.
    """
    if sys.version_info < NEEDED:
        wanted = ".".join(map(str, NEEDED))
        return complain(
            f"plots need Python {wanted} or newer, not {sys.executable}"
        )
    # That a home folder is missing or read-only is no concern of plots.
    logging.getLogger("matplotlib").setLevel(logging.ERROR)
    try:
        importlib.import_module("numpy")
        importlib.import_module("matplotlib")
    except ImportError as error:
        return complain(
            f"plots need numpy and matplotlib in {sys.executable} ({error}); "
            "install the package python3-matplotlib"
        )
    if not __package__:
        sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
    return int(importlib.import_module(f"{package}.cli").main())


def complain(message: str) -> int:
    """Says in one line what is missing."""
    print(f"routebench: {message}", file=sys.stderr)
    return EXIT_BAD_INPUT


if __name__ == "__main__":
    sys.exit(start())
