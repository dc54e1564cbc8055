"""How `routebench` starts a Python package: what this Python lacks is said in one line."""

from __future__ import annotations

import importlib
import logging
import sys
from collections.abc import Sequence

NEEDED = (3, 11)
EXIT_BAD_INPUT = 2


def launch(module: str, needed: Sequence[str]) -> int:
    """Runs the module's main() once the needed packages are known to be there."""
    if sys.version_info < NEEDED:
        wanted = ".".join(map(str, NEEDED))
        return complain(f"this needs Python {wanted} or newer, not {sys.executable}")
    # That a home folder is missing or read-only is no concern of plots.
    logging.getLogger("matplotlib").setLevel(logging.ERROR)
    try:
        for name in needed:
            importlib.import_module(name)
    except ImportError as error:
        return complain(
            f"this needs {' and '.join(needed)} in {sys.executable} ({error}); "
            f"install the package python3-{needed[-1]}"
        )
    code: int = importlib.import_module(module).main()
    return code


def complain(message: str) -> int:
    """Says in one line what is missing."""
    print(f"routebench: {message}", file=sys.stderr)
    return EXIT_BAD_INPUT
