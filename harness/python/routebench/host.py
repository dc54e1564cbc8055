"""Speaks for the planners of a Python file: requests on standard input, answers on output.

``routebench`` starts it by itself for every plugin that is a Python file. Under another Python,
with routebench's Python folder in PYTHONPATH, it serves as a command:
``fill = { command = "my_env/bin/python -m routebench.host my_planner.py" }``.
"""

from __future__ import annotations

import importlib.util
import json
import os
import platform
import signal
import sys
import time
import traceback
from collections.abc import Iterable
from pathlib import Path
from types import ModuleType
from typing import Any, TextIO

# Not resolved: in a build folder the files are links, and the compiled part lies beside the links.
_PACKAGE = Path(__file__).absolute().parent
if sys.path and Path(sys.path[0] or ".").resolve() == Path(__file__).resolve().parent:
    sys.path[0] = str(_PACKAGE.parent)  # run as a file: its neighbours are no modules of their own

PROTOCOL = 1

# Taken before anybody's code can replace them.
_wall_ns = time.perf_counter_ns
_cpu_ns = time.process_time_ns


class Refusal(Exception):
    """Something about a planner or its answer is wrong; the message says what."""


try:
    import numpy as np

    from routebench.planner import Context, Layer, Planner, Polygon, Stroke

    _missing = ""
except ImportError as error:
    _missing = str(error)
    if error.name == "numpy":
        _missing += "; planners in Python need numpy: install the package python3-numpy"


def load(file: Path) -> ModuleType:
    """Executes the file as a module of its own; what lies beside it can be imported."""
    sys.path.append(str(file.parent))  # last: its own name may be that of a known module
    spec = importlib.util.spec_from_file_location(f"routebench_plugin_{file.stem}", file)
    if spec is None or spec.loader is None:
        raise Refusal(f"{file.name} is no Python file")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    try:
        spec.loader.exec_module(module)
    except Exception as failure:
        raise Refusal(f"loading {file.name} failed: {describe(failure, file)}") from failure
    return module


def describe(failure: BaseException, file: Path) -> str:
    """An exception in one line, with the last place in the planner's own file."""
    text = str(failure)
    line = f"{type(failure).__name__}: {text}" if text else type(failure).__name__
    places = [
        frame.lineno
        for frame in traceback.extract_tb(failure.__traceback__)
        if Path(frame.filename) == file
    ]
    if places:
        line += f" ({file.name}, line {places[-1]})"
    return " ".join(line.split())


def planners_in(module: ModuleType) -> dict[str, type[Planner]]:
    """The classes with a name that the file defines."""
    found: dict[str, type[Planner]] = {}
    for value in vars(module).values():
        if not (isinstance(value, type) and issubclass(value, Planner)):
            continue
        if value.__module__ != module.__name__ or not value.name:
            continue
        if found.setdefault(value.name, value) is not value:
            raise Refusal(f"two of its classes are named {value.name}")
    if not found:
        raise Refusal(
            "it defines no class with a name that is derived from routebench.planner.Planner"
        )
    return found


def description(planners: dict[str, type[Planner]]) -> dict[str, Any]:
    """What the program is told of the file."""
    return {
        "routebench": PROTOCOL,
        "made_with": f"python {platform.python_version()}, numpy {np.__version__}",
        "planners": [
            {
                "name": planner.name,
                "role": planner.role,
                "summary": planner.summary,
                "source": planner.source,
                "may_leave": [
                    {"param": param, "value": value} for param, value in planner.may_leave
                ],
                "params": [parameter.schema() for parameter in planner.parameters()],
            }
            for planner in planners.values()
        ],
    }


def ring(points: list[list[float]]) -> Any:
    """Rows of x and y that cannot be written to."""
    array = np.array(points, dtype=np.float64).reshape(-1, 2)
    array.flags.writeable = False
    return array


def layer_of(data: dict[str, Any]) -> Layer:
    """The layer of a request."""
    return Layer(
        index=data["index"],
        z_mm=data["z_mm"],
        height_mm=data["height_mm"],
        polygons=tuple(
            Polygon(ring(polygon["outer"]), tuple(ring(hole) for hole in polygon["holes"]))
            for polygon in data["polygons"]
        ),
    )


def context_of(data: dict[str, Any]) -> Context:
    """The context of a request."""
    start = np.array(data["start"], dtype=np.float64)
    start.flags.writeable = False
    return Context(
        start=start,
        line_width_mm=data["line_width_mm"],
        spacing_mm=data["spacing_mm"],
        line_distance_mm=data["line_distance_mm"],
        density=data["density"],
        perimeters=data["perimeters"],
        seed=data["seed"],
    )


def answer_stroke(stroke: Any) -> dict[str, Any]:
    """One stroke as it is sent. Raises Refusal for what is none."""
    given = stroke.points if isinstance(stroke, Stroke) else stroke
    try:
        points = np.asarray(given, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise Refusal(f"is no array of numbers: {error}") from error
    if points.ndim != 2 or points.shape[1] != 2:
        raise Refusal(f"has an array of shape {points.shape}; it must be (n, 2)")
    bad = np.flatnonzero(~np.isfinite(points).all(axis=1))
    if bad.size > 0:
        x, y = points[bad[0]]
        raise Refusal(f"has point {bad[0]} at ({x}, {y}); coordinates must be finite")
    answer: dict[str, Any] = {"points": points.tolist()}
    if isinstance(stroke, Stroke) and stroke.width_mm is not None:
        try:
            width = float(stroke.width_mm)
        except (TypeError, ValueError) as error:
            raise Refusal(f"has no number as width_mm: {error}") from error
        if not np.isfinite(width):
            raise Refusal(f"has the width {width}; it must be finite")
        answer["width_mm"] = width
    return answer


class Host:
    """The planners of a file, made as they are asked for."""

    def __init__(self, file: Path) -> None:
        self._file = file
        self._classes = planners_in(load(file))
        self._made: dict[str, Planner] = {}

    def _planner(self, name: str, params: dict[str, Any]) -> Planner:
        key = name + json.dumps(params, sort_keys=True)
        if key not in self._made:
            self._made[key] = self._classes[name](params)
        return self._made[key]

    def plan(self, request: dict[str, Any]) -> dict[str, Any]:
        """Plans one layer and says how long the planner took."""
        planner = self._planner(request["planner"], request["params"])
        layer = layer_of(request["layer"])
        context = context_of(request["context"])
        cpu, wall = _cpu_ns(), _wall_ns()
        strokes = planner.plan(layer, context)
        # One that yields its strokes plans while they are fetched.
        if isinstance(strokes, Iterable) and not isinstance(strokes, (np.ndarray, str, bytes)):
            strokes = list(strokes)
        wall, cpu = _wall_ns() - wall, _cpu_ns() - cpu
        if isinstance(strokes, np.ndarray) and strokes.ndim == 3:
            strokes = list(strokes)
        if not isinstance(strokes, list):
            raise Refusal(
                f"plan returned {type(strokes).__name__}; it must return a list of strokes"
            )
        answers = []
        for index, stroke in enumerate(strokes):
            try:
                answers.append(answer_stroke(stroke))
            except Refusal as refusal:
                raise Refusal(f"stroke {index} {refusal}") from None
        return {"strokes": answers, "plan_wall_ns": wall, "plan_cpu_ns": cpu}

    def answer(self, line: str) -> dict[str, Any]:
        """What to say to a request."""
        try:
            request = json.loads(line)
            if request["request"] == "describe":
                return description(self._classes)
            return self.plan(request)
        except MemoryError:
            return {"error": "no memory left", "out_of_memory": True}
        except Refusal as refusal:
            return {"error": str(refusal)}
        except Exception as failure:
            return {"error": describe(failure, self._file)}


def own_streams() -> tuple[TextIO, TextIO]:
    """The streams of the protocol. What the planner prints goes to the standard error instead."""
    requests = os.fdopen(os.dup(0), "r", encoding="utf-8", newline="\n")
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8", newline="\n")
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.dup2(2, 1)
    sys.stdout = sys.stderr
    return requests, answers


def main() -> int:
    """Answers until the input ends."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl-C ends it without a word
    requests, answers = own_streams()

    def say(answer: dict[str, Any]) -> None:
        answers.write(json.dumps(answer) + "\n")
        answers.flush()

    host: Host | None = None
    refused = ""
    try:
        if len(sys.argv) != 2:
            raise Refusal("it is to be called with one Python file")
        if _missing:
            raise Refusal(_missing)
        host = Host(Path(sys.argv[1]).resolve())
    except Refusal as refusal:
        refused = str(refusal)
    for line in requests:
        say({"error": refused} if host is None else host.answer(line))
    return 0


if __name__ == "__main__":
    sys.exit(main())
