"""Entry point; also runs as a file, `python3 routebench_report/__main__.py`."""

import sys
from pathlib import Path

if __name__ == "__main__":
    if not __package__:
        sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
    from routebench_plots.launch import launch

    sys.exit(launch("routebench_report.cli", ("numpy", "matplotlib")))
