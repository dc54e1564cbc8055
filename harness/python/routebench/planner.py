"""Planners written in Python: what to derive from, and what comes in and goes out.

A planner is a class in a file of its own::

    from routebench.planner import Planner, Real

    class Rings(Planner):
        name = "rings"
        role = "fill"
        summary = "rings inside one another"
        source = "your name, year"
        pitch = Real(1.0, 0.5, 2.0, unit="line distances", help="between one ring and the next")

        def plan(self, layer, context):
            ...
            return strokes

``routebench plan MODEL --plugin rings.py --fill rings`` runs it. Lengths are millimetres.
Coordinates are relative to the model's lower corner: patterns that are anchored at (0, 0) meet
from layer to layer, and the route moves with the model.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Union

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "Bool",
    "Choice",
    "Context",
    "Int",
    "Layer",
    "Parameter",
    "Planner",
    "Points",
    "Polygon",
    "Real",
    "Stroke",
]

Points = NDArray[np.float64]
"""Points as rows of x and y, mm: shape (n, 2)."""


class Parameter:
    """A planner's own setting, declared once as an attribute of its class.

    From the declaration come the checks of configs and command lines, ``routebench planners NAME``
    and the record in the results. In ``plan`` the attribute has the value that was set.
    """

    type: str

    def __init__(self, default: Any, help: str, unit: str = "") -> None:
        self.default = default
        self.help = help
        self.unit = unit
        self.name = ""

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    def __get__(self, planner: Planner | None, owner: type) -> Any:
        return self if planner is None else planner.params[self.name]

    def schema(self) -> dict[str, Any]:
        """The declaration as the protocol has it."""
        return {
            "name": self.name,
            "type": self.type,
            "default": self.default,
            "unit": self.unit,
            "help": self.help,
        }


class _Number(Parameter):
    def __init__(
        self, default: Any, lowest: Any, highest: Any, unit: str = "", help: str = ""
    ) -> None:
        super().__init__(default, help, unit)
        self.lowest = lowest
        self.highest = highest

    def schema(self) -> dict[str, Any]:
        return {**super().schema(), "lowest": self.lowest, "highest": self.highest}


class Real(_Number):
    """A number from ``lowest`` to ``highest``."""

    type = "real"


class Int(_Number):
    """A whole number from ``lowest`` to ``highest``."""

    type = "int"


class Bool(Parameter):
    """True or false."""

    type = "bool"

    def __init__(self, default: bool, help: str = "") -> None:
        super().__init__(default, help)


class Choice(Parameter):
    """One of several words; the first one unless ``default`` says otherwise."""

    type = "choice"

    def __init__(self, choices: Sequence[str], default: str | None = None, help: str = "") -> None:
        super().__init__(choices[0] if default is None else default, help)
        self.choices = tuple(choices)

    def schema(self) -> dict[str, Any]:
        return {**super().schema(), "choices": list(self.choices)}


@dataclass(frozen=True)
class Polygon:
    """An area with holes. Rings do not repeat their first point and cannot be written to."""

    outer: Points
    """Counter-clockwise."""
    holes: tuple[Points, ...] = ()
    """Clockwise."""

    @property
    def rings(self) -> tuple[Points, ...]:
        """The outer ring, then the holes."""
        return (self.outer, *self.holes)


@dataclass(frozen=True)
class Layer:
    """What is to be walled or filled: disjoint polygons, which may touch in points; maybe none."""

    index: int
    z_mm: float
    height_mm: float
    polygons: tuple[Polygon, ...]
    solid: tuple[Polygon, ...] = ()
    """Of a sliced model: the part that must be dense. Planners get such parts by themselves."""


@dataclass(frozen=True)
class Context:
    """What the task demands of every planner alike."""

    start: Points
    """Where the nozzle is when the route begins: x and y."""
    line_width_mm: float
    spacing_mm: float
    """Between the centres of neighbouring lines at density 1."""
    line_distance_mm: float
    """The same at ``density``."""
    density: float
    """Share of the area to be filled, from above 0 to 1."""
    perimeters: int
    """Walls to lay, for shell planners."""
    seed: int
    """For planners that draw lots: ``numpy.random.default_rng(context.seed)``."""


@dataclass(frozen=True)
class Stroke:
    """Material along a polyline. A loop repeats its first point."""

    points: Any
    """Anything that numpy takes for an array of shape (n, 2)."""
    width_mm: float | None = None
    """The task's line width if None."""
    kind: str | None = None
    """In a finished plan: "wall", "dense" or "sparse"."""


Strokes = Iterable[Union[Stroke, Points, Sequence[Sequence[float]]]]


class Planner:
    """Base of planners. A derived class with a ``name`` is found when its file is loaded.

    The object lives as long as its process and plans many layers. Equal arguments must give equal
    routes: nothing may be kept from one call to the next that shows in a route.
    """

    name: str = ""
    """As in configs: snake_case."""
    role: str = "fill"
    """"fill", or "shell" for one that lays walls."""
    summary: str = ""
    """One line."""
    source: str = ""
    """Author and year; empty if it is your own."""
    may_leave: Sequence[tuple[str, str]] = ()
    """Parameters and values with which it may leave the polygons, as its paper did."""

    def __init__(self, params: dict[str, Any] | None = None) -> None:
        """Takes values for some or all parameters; the others get their defaults."""
        self.params: dict[str, Any] = {
            **{parameter.name: parameter.default for parameter in self.parameters()},
            **(params or {}),
        }

    @classmethod
    def parameters(cls) -> list[Parameter]:
        """What is declared, base classes first, in the order of the source."""
        found: dict[str, Parameter] = {}
        for base in reversed(cls.__mro__):
            for name, value in vars(base).items():
                if isinstance(value, Parameter):
                    found[name] = value
        return list(found.values())

    def plan(self, layer: Layer, context: Context) -> Strokes:
        """The strokes of a layer, or of one region of it, in the order in which they are laid.

        Beads must stay inside the polygons: centre lines keep half a line width from the boundary.
        """
        raise NotImplementedError(f"{type(self).__name__} has no method plan")
