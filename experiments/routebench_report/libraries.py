"""The JavaScript that a page takes in: three.js as the system has it, and ours."""

from __future__ import annotations

from pathlib import Path

from routebench_plots.errors import PlotError

_PLACES = (
    Path("/usr/share/javascript/three"),
    Path("/usr/share/nodejs/three"),
)
_PACKAGE = "libjs-three"
_RENDERER = ("three.min.js", "build/three.min.js", "build/three.js")
_CONTROLS = ("examples/js/controls/OrbitControls.js",)

_WEB = Path(__file__).resolve().parent / "web"
_SCRIPTS = (
    "blocks.js",
    "outline.js",
    "route.js",
    "speed.js",
    "gcode.js",
    "palette.js",
    "beads.js",
    "scene.js",
    "chart.js",
    "place.js",
    "model.js",
    "viewer.js",
    "controls.js",
    "table.js",
    "main.js",
)
"""Our own, each after those that it uses."""


def three_js() -> str:
    """The renderer and its camera controls, scripts that define THREE."""
    return "\n".join(
        _first_of(names).read_text("utf-8") for names in (_RENDERER, _CONTROLS)
    )


def own_script() -> str:
    """All that the page itself does, in one scope of its own."""
    parts = [(_WEB / name).read_text("utf-8") for name in _SCRIPTS]
    return '(() => {\n"use strict";\n' + "\n".join(parts) + "\n})();"


def style() -> str:
    """How the page looks."""
    return (_WEB / "style.css").read_text("utf-8")


def viewer_markup() -> str:
    """The viewer's elements."""
    return (_WEB / "viewer.html").read_text("utf-8")


def _first_of(names: tuple[str, ...]) -> Path:
    for place in _PLACES:
        for name in names:
            if (place / name).is_file():
                return place / name
    raise PlotError(
        f"the route viewer needs three.js: there is no {names[0]} in "
        f"{' or '.join(map(str, _PLACES))}; install the package {_PACKAGE}"
    )
