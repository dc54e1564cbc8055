"""What the page's scripts need to know of an experiment."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeVar

from routebench_plots.errors import PlotError
from routebench_plots.figures import METRICS_OF_INTEREST
from routebench_plots.quantities import pretty_unit, scale_for
from routebench_plots.results import Cell, Item, Metric, Results
from routebench_plots.shapes import read_multipolygon, read_strokes
from routebench_plots.style import (
    MATERIAL_COLOUR,
    OTHER_STROKE_COLOUR,
    STROKE_COLOURS,
    TRAVEL_COLOUR,
    looks,
    outcome_look,
)

from .blocks import (
    QUANTUM_MM,
    LayerPolygons,
    LayerScores,
    LayerStrokes,
    TooFarError,
    outline_block,
    packed,
    route_block,
    score_block,
)


_Layer = TypeVar("_Layer", LayerPolygons, LayerStrokes)

_COUNTED_IN_A_FILE = (
    ("travel_mm", "Travel", "mm", "lower", "moves without material"),
    ("travels", "Travels", "", "lower", "number of such moves"),
    ("retractions", "Retractions", "", "lower", "as the file makes them"),
    ("extrude_mm", "Extruded length", "mm", "neither", "length of all strokes"),
)
"""What the page counts in G-code that no judge has seen."""


@dataclass(frozen=True)
class Place:
    """A cell and where it stands: everything in the page refers to it."""

    setting: int
    model: int
    contender: int
    cell: Cell


@dataclass
class Content:
    """Data of a page: what is small as JSON, the rest packed in blocks."""

    data: dict[str, Any]
    blocks: dict[str, str] = field(default_factory=dict)


def base_data(title: str) -> dict[str, Any]:
    """What every page has, also one that shows no experiment."""
    return {
        "title": title,
        "quantum_mm": QUANTUM_MM,
        "colours": {
            "material": MATERIAL_COLOUR,
            "strokes": STROKE_COLOURS,
            "other": OTHER_STROKE_COLOUR,
            "travel": TRAVEL_COLOUR,
        },
        "models": [],
        "contenders": [],
        "settings": [],
        "metrics": [],
        "cells": [],
    }


def gcode_content(name: str, text: str) -> Content:
    """A page that shows a file of G-code, which it reads itself."""
    data = base_data(name)
    data["metrics"] = [
        {
            "name": metric,
            "label": label,
            "unit": unit,
            "factor": 1,
            "layer_unit": unit,
            "layer_factor": 1,
            "better": better,
            "meaning": meaning,
            "of_interest": True,
        }
        for metric, label, unit, better, meaning in _COUNTED_IN_A_FILE
    ]
    data["gcode"] = {"name": name, "block": "gcode"}
    return Content(data, {"gcode": packed(text.encode())})


def results_content(
    results: Results, report: Callable[[int, int], None]
) -> Content:
    """The cells of an experiment with all that was kept of them.

    `report` hears how many cells are packed, and of how many.
    """
    content = Content(base_data(results.experiment))
    data = content.data
    styles = looks(results.contenders)
    data["models"] = [model.label for model in results.models]
    data["contenders"] = [
        {"name": item.label, "colour": styles[item.row_id].colour}
        for item in results.contenders
    ]
    data["settings"] = _settings(results)
    largest = _largest_of_a_layer(results)
    data["metrics"] = [
        _metric(results, metric, [largest.get(metric.name, 0.0)])
        for metric in results.metrics
    ]
    _add_outlines(results, content)
    totals = _totals(results)
    layer_counts = {
        row["cell_id"]: row["layers"]
        for row in results.records("SELECT cell_id, layers FROM current_cell")
    }
    places = list(all_places(results))
    for done, place in enumerate(places, start=1):
        made = _cell(results, content, place, totals)
        made["layer_count"] = layer_counts[place.cell.cell_id]
        data["cells"].append(made)
        report(done, len(places))
    return content


def all_places(results: Results) -> Iterator[Place]:
    """Every cell, by setting, model, contender and seed."""
    for s, setting in enumerate(results.settings):
        for m, model in enumerate(results.models):
            for c, contender in enumerate(results.contenders):
                for cell in results.slot(setting, model, contender).cells:
                    yield Place(s, m, c, cell)


def _settings(results: Results) -> list[dict[str, Any]]:
    found = {
        row["setting_id"]: row
        for row in results.records("SELECT * FROM setting")
    }
    return [
        {
            "name": setting.label,
            "task": _object(results, found[setting.row_id], "task_json"),
            "printer": _object(results, found[setting.row_id], "printer_json"),
        }
        for setting in results.settings
    ]


def _object(
    results: Results, row: dict[str, Any], column: str
) -> dict[str, Any]:
    try:
        value = json.loads(row[column])
    except (TypeError, ValueError) as error:
        raise PlotError(
            f"{results.database}: {column} of setting {row['setting_id']} "
            f"is not JSON: {error}"
        ) from error
    return value if isinstance(value, dict) else {}


def _metric(
    results: Results, metric: Metric, layer_values: Iterable[float]
) -> dict[str, Any]:
    """A metric with a unit for totals and one for single layers."""
    values = (
        value.high
        for setting in results.settings
        for value in results.all_values(setting, metric)
    )
    scale = scale_for(metric, values)
    layer_scale = scale_for(metric, layer_values)
    return {
        "name": metric.name,
        "label": metric.label,
        "unit": pretty_unit(scale.unit),
        "factor": scale.factor,
        "layer_unit": pretty_unit(layer_scale.unit),
        "layer_factor": layer_scale.factor,
        "better": metric.better,
        "meaning": metric.meaning,
        "of_interest": metric.name in METRICS_OF_INTEREST,
    }


def _largest_of_a_layer(results: Results) -> dict[str, float]:
    """The largest value that any layer has of each metric."""
    largest: dict[str, float] = {}
    for row in results.records("SELECT * FROM layer_score"):
        for name, value in row.items():
            number = _finite(value)
            if number is not None:
                largest[name] = max(largest.get(name, 0.0), number)
    return largest


def _totals(results: Results) -> dict[int, dict[str, float | None]]:
    totals: dict[int, dict[str, float | None]] = {}
    for row in results.records("SELECT cell_id, metric, value FROM cell_score"):
        totals.setdefault(row["cell_id"], {})[row["metric"]] = _finite(
            row["value"]
        )
    return totals


def _add_outlines(results: Results, content: Content) -> None:
    """One block for each model as it was sliced under a setting."""
    for setting in results.settings:
        for model in results.models:
            name = _outline_name(results, setting, model)
            if name is None or name in content.blocks:
                continue
            layers = [
                LayerPolygons(
                    index,
                    z_mm,
                    read_multipolygon(
                        results.layer_wkt(setting, model, index),
                        f"{results.database}: layer {index} of {model.label}",
                    ),
                )
                for index, z_mm in results.kept_layers(setting, model)
            ]
            if layers and (block := _fitting(outline_block, layers)):
                content.blocks[name] = block


def _fitting(
    pack: Callable[[Sequence[_Layer]], bytes], layers: Sequence[_Layer]
) -> str | None:
    """Packed layers, unless something of them is too far away to be shown.

    One route that goes astray costs its own picture, not the page.
    """
    try:
        return packed(pack(layers))
    except TooFarError:
        return None


def _outline_name(
    results: Results, setting: Item, model: Item
) -> str | None:
    row = results.model_row(setting, model)
    return None if row is None else f"outline-{row}"


def _cell(
    results: Results,
    content: Content,
    place: Place,
    totals: dict[int, dict[str, float | None]],
) -> dict[str, Any]:
    setting = results.settings[place.setting]
    model = results.models[place.model]
    cell = place.cell
    own = totals.get(cell.cell_id, {})
    made: dict[str, Any] = {
        "setting": place.setting,
        "model": place.model,
        "contender": place.contender,
        # A number of JavaScript has only 53 bits.
        "seed": str(cell.seed),
        "outcome": cell.outcome,
        "outcome_words": outcome_look(cell.outcome).words,
        "reason": cell.reason,
        "scores": [own.get(metric.name) for metric in results.metrics],
    }
    routes = _routes(results, setting, model, cell)
    if routes and (block := _fitting(route_block, routes)):
        made["kept"] = len(routes)
        made["route"] = f"route-{cell.cell_id}"
        content.blocks[made["route"]] = block
    scores = _layer_scores(results, cell)
    if scores:
        made["layers"] = f"layers-{cell.cell_id}"
        content.blocks[made["layers"]] = packed(
            score_block(scores, len(results.metrics))
        )
    outline = _outline_name(results, setting, model)
    if outline in content.blocks:
        made["outline"] = outline
    return made


def _routes(
    results: Results, setting: Item, model: Item, cell: Cell
) -> list[LayerStrokes]:
    heights = dict(results.kept_layers(setting, model))
    return [
        LayerStrokes(
            row["layer_index"],
            heights[row["layer_index"]],
            read_strokes(
                row["strokes_json"],
                f"{results.database}: route of cell {cell.cell_id}, "
                f"layer {row['layer_index']}",
            ),
        )
        for row in results.records(
            "SELECT layer_index, strokes_json FROM route WHERE cell_id = ? "
            "ORDER BY layer_index",
            (cell.cell_id,),
        )
        if row["layer_index"] in heights
    ]


def _layer_scores(results: Results, cell: Cell) -> list[LayerScores]:
    names = [metric.name for metric in results.metrics]
    return [
        LayerScores(
            row["layer_index"],
            row["z_mm"],
            [_or_nan(row.get(name)) for name in names],
        )
        for row in results.records(
            "SELECT * FROM layer_score WHERE cell_id = ? ORDER BY layer_index",
            (cell.cell_id,),
        )
    ]


def _finite(value: object) -> float | None:
    if isinstance(value, (int, float)) and math.isfinite(value):
        return value
    return None


def _or_nan(value: object) -> float:
    number = _finite(value)
    return math.nan if number is None else number

