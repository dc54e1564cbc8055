"""Makes results databases for the tests, in the shape the runner gives them.

Everything in them is made up from a seed; nothing is measured.
"""

from __future__ import annotations

import json
import math
import random
import sqlite3
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

METRICS = (
    ("extrude_mm", "Extruded length", "mm", "neither", "sum"),
    ("travel_mm", "Travel", "mm", "lower", "sum"),
    ("entry_travel_mm", "Entry travel", "mm", "lower", "sum"),
    ("retractions", "Retractions", "", "lower", "sum"),
    ("crossings", "Crossings", "", "lower", "sum"),
    ("strokes", "Strokes", "", "lower", "sum"),
    ("covered", "Covered", "", "higher", "area"),
    ("deposit", "Deposit", "", "neither", "demand"),
    ("doubled", "Doubled", "", "lower", "area"),
    ("filament_mm3", "Material", "mm3", "neither", "sum"),
    ("print_time_s", "Print time", "s", "lower", "sum"),
    ("plan_wall_ns", "Planning time", "ns", "lower", "sum"),
    ("plan_cpu_ns", "Planning CPU time", "ns", "lower", "sum"),
    ("peak_rss_bytes", "Peak memory", "bytes", "lower", "cell"),
)
LAYER_METRICS = [m[0] for m in METRICS if m[4] != "cell"]

TASK = {
    "layer_height_mm": 0.2,
    "join_mm": 0.01,
    "gate_covered_min": 0.95,
    "gate_deposit_min": 0.85,
    "gate_deposit_max": 1.15,
}

_SCHEMA = """
CREATE TABLE meta(key TEXT PRIMARY KEY, value TEXT NOT NULL);
CREATE TABLE metric(position INTEGER PRIMARY KEY, name TEXT UNIQUE NOT NULL,
  label TEXT NOT NULL, unit TEXT NOT NULL, better TEXT NOT NULL,
  total TEXT NOT NULL, meaning TEXT NOT NULL);
CREATE TABLE run(run_id INTEGER PRIMARY KEY, experiment TEXT NOT NULL,
  config_resolved_json TEXT NOT NULL);
CREATE TABLE model(model_id INTEGER PRIMARY KEY, spec TEXT NOT NULL,
  mesh_hash TEXT NOT NULL, layers_hash TEXT NOT NULL,
  triangles INTEGER NOT NULL, layers INTEGER NOT NULL,
  report_json TEXT NOT NULL, UNIQUE(spec, mesh_hash, layers_hash));
CREATE TABLE contender(contender_id INTEGER PRIMARY KEY, name TEXT NOT NULL,
  base_name TEXT NOT NULL, variant_json TEXT NOT NULL,
  variant_hash TEXT NOT NULL, UNIQUE(name, variant_hash));
CREATE TABLE setting(setting_id INTEGER PRIMARY KEY, label TEXT NOT NULL,
  task_json TEXT NOT NULL, printer_json TEXT NOT NULL,
  setting_hash TEXT NOT NULL UNIQUE);
CREATE TABLE cell(cell_id INTEGER PRIMARY KEY, cell_key TEXT NOT NULL UNIQUE,
  run_id INTEGER NOT NULL REFERENCES run,
  model_id INTEGER NOT NULL REFERENCES model,
  contender_id INTEGER NOT NULL REFERENCES contender,
  setting_id INTEGER NOT NULL REFERENCES setting, seed INTEGER NOT NULL,
  outcome TEXT NOT NULL, reason TEXT NOT NULL, layers INTEGER NOT NULL,
  route_hash TEXT, started_utc TEXT NOT NULL, cell_wall_s REAL NOT NULL);
CREATE TABLE run_cell(run_id INTEGER NOT NULL REFERENCES run,
  cell_id INTEGER NOT NULL REFERENCES cell ON DELETE CASCADE,
  PRIMARY KEY(run_id, cell_id)) WITHOUT ROWID;
CREATE VIEW current_cell AS SELECT * FROM cell WHERE cell_id IN
  (SELECT cell_id FROM run_cell
   WHERE run_id = (SELECT max(run_id) FROM run));
CREATE TABLE cell_score(cell_id INTEGER NOT NULL REFERENCES cell,
  metric TEXT NOT NULL REFERENCES metric(name), value REAL,
  PRIMARY KEY(cell_id, metric)) WITHOUT ROWID;
CREATE TABLE layer_score(cell_id INTEGER NOT NULL REFERENCES cell,
  layer_index INTEGER NOT NULL, z_mm REAL NOT NULL,
  repaired INTEGER NOT NULL, {columns},
  PRIMARY KEY(cell_id, layer_index)) WITHOUT ROWID;
CREATE TABLE timing_sample(cell_id INTEGER NOT NULL REFERENCES cell,
  repetition INTEGER NOT NULL, run_id INTEGER NOT NULL REFERENCES run,
  plan_wall_ns INTEGER NOT NULL, plan_cpu_ns INTEGER NOT NULL,
  minor_faults INTEGER NOT NULL, major_faults INTEGER NOT NULL,
  peak_rss_bytes INTEGER NOT NULL,
  PRIMARY KEY(cell_id, repetition)) WITHOUT ROWID;
CREATE TABLE layer_shape(model_id INTEGER NOT NULL REFERENCES model,
  layer_index INTEGER NOT NULL, z_mm REAL NOT NULL, wkt TEXT NOT NULL,
  PRIMARY KEY(model_id, layer_index)) WITHOUT ROWID;
CREATE TABLE route(cell_id INTEGER NOT NULL REFERENCES cell,
  layer_index INTEGER NOT NULL, strokes_json TEXT NOT NULL,
  PRIMARY KEY(cell_id, layer_index)) WITHOUT ROWID;
"""

PLATE_WKT = (
    "MULTIPOLYGON Z (((0 0 1.1, 40 0 1.1, 40 30 1.1, 0 30 1.1, 0 0 1.1), "
    "(12 10 1.1, 12 20 1.1, 22 20 1.1, 22 10 1.1, 12 10 1.1)), "
    "((46 5 1.1, 52 5 1.1, 52 25 1.1, 46 25 1.1, 46 5 1.1)))"
)


@dataclass
class Database:
    """A results database being made."""

    path: Path
    schema_version: str = "2"
    _ids: dict[str, int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        columns = ", ".join(f"{name} REAL" for name in LAYER_METRICS)
        self.connection = sqlite3.connect(self.path)
        # A made-up database need not outlive a power cut.
        self.connection.execute("PRAGMA synchronous = OFF")
        self.connection.execute("PRAGMA journal_mode = MEMORY")
        self.connection.executescript(_SCHEMA.format(columns=columns))
        self._insert("meta", "schema_version", self.schema_version)
        self._insert("meta", "experiment", "synthetic")
        for place, metric in enumerate(METRICS):
            self._insert("metric", place, *metric, f"meaning of {metric[0]}")
        self.run = 1
        self._insert("run", self.run, "synthetic", "{}")

    def close(self) -> Path:
        """Writes the file and returns where it is."""
        self.connection.commit()
        self.connection.close()
        return self.path

    def model(
        self,
        spec: str,
        hash_: str = "m",
        triangles: int = 0,
        report: dict[str, object] | None = None,
    ) -> int:
        """Adds a model of three layers."""
        row_id = self._next("model")
        self._insert(
            "model", row_id, spec, hash_, hash_, triangles, 3, json.dumps(report or {})
        )
        return row_id

    def contender(self, name: str, hash_: str = "c") -> int:
        """Adds a contender."""
        row_id = self._next("contender")
        self._insert("contender", row_id, name, name, "{}", hash_)
        return row_id

    def setting(
        self,
        label: str = "",
        printer: dict[str, object] | None = None,
        task: dict[str, object] | None = None,
    ) -> int:
        """Adds a setting of task and printer."""
        row_id = self._next("setting")
        self._insert(
            "setting",
            row_id,
            label,
            json.dumps(TASK if task is None else task),
            json.dumps(printer or {}),
            f"hash{row_id}",
        )
        return row_id

    def cell(
        self,
        model: int,
        contender: int,
        setting: int,
        scores: dict[str, float | None] | None = None,
        outcome: str = "valid",
        reason: str = "",
        seed: int = 1,
    ) -> int:
        """Adds a cell with its totals."""
        row_id = self._next("cell")
        self._insert(
            "cell",
            row_id,
            f"key{row_id}",
            self.run,
            model,
            contender,
            setting,
            seed,
            outcome,
            reason,
            3,
            None,
            "2026-01-01",
            0.5,
        )
        self._insert("run_cell", self.run, row_id)
        for name, value in (scores or {}).items():
            self._insert("cell_score", row_id, name, value)
        return row_id

    def next_run(self) -> None:
        """Begins another run: what follows belongs to it."""
        self.run += 1
        self._insert("run", self.run, "synthetic", "{}")

    def layers(
        self,
        cell: int,
        rows: Sequence[dict[str, float | None]],
        repaired: Sequence[int] = (),
    ) -> None:
        """Adds scores of layers 0.2 mm apart."""
        for index, row in enumerate(rows):
            self._insert(
                "layer_score",
                cell,
                index,
                0.1 + 0.2 * index,
                int(index in repaired),
                *(row.get(n) for n in LAYER_METRICS),
            )

    def times(self, cell: int, cpu_ns: Sequence[int]) -> None:
        """Adds repetitions."""
        for repetition, sample in enumerate(cpu_ns):
            self._insert(
                "timing_sample",
                cell,
                repetition,
                self.run,
                sample + 7,
                sample,
                12,
                0,
                10**7,
            )

    def shape(self, model: int, layer: int, wkt: str = PLATE_WKT) -> None:
        """Keeps a layer's material."""
        self._insert("layer_shape", model, layer, 0.1 + 0.2 * layer, wkt)

    def route(self, cell: int, layer: int, strokes: object) -> None:
        """Keeps a layer's route."""
        self._insert("route", cell, layer, json.dumps(strokes))

    def execute(self, sql: str, *values: object) -> None:
        """Does what no method here does."""
        self.connection.execute(sql, values)

    def _insert(self, table: str, *values: object) -> None:
        marks = ", ".join("?" * len(values))
        self.connection.execute(
            f"INSERT INTO {table} VALUES ({marks})", values
        )

    def _next(self, table: str) -> int:
        self._ids[table] = self._ids.get(table, 0) + 1
        return self._ids[table]


def plate_strokes(
    seed: int, step_mm: float = 1.2, linked: bool = False
) -> list[dict[str, object]]:
    """A route of PLATE_WKT: walls, a dense island, sparse lines."""
    rng = random.Random(seed)

    def loop(
        left: float, low: float, right: float, high: float
    ) -> list[list[float]]:
        ring = [[left, low], [right, low], [right, high], [left, high]]
        turn = rng.randrange(4)
        ring = ring[turn:] + ring[:turn]
        return [*ring, ring[0]]

    def stroke(kind: str, points: list[list[float]]) -> dict[str, object]:
        return {"kind": kind, "width_mm": 0.45, "points": points}

    strokes = [
        stroke("wall", loop(0.2, 0.2, 39.8, 29.8)),
        stroke("wall", loop(11.8, 9.8, 22.2, 20.2)),
    ]
    lines = []
    for number in range(int(38 / step_mm)):
        x = 1 + number * step_mm
        pieces = [(0.6, 9.4), (20.6, 29.4)] if 11 < x < 23 else [(0.6, 29.4)]
        for low, high in pieces:
            ends = [[x, low], [x, high]]
            lines.append(ends if number % 2 else ends[::-1])
    if linked:
        strokes.append(stroke("sparse", [p for line in lines for p in line]))
    else:
        rng.shuffle(lines)
        strokes += [stroke("sparse", line) for line in lines]
    zigzag = [
        [46.4 + 5.2 * ((row // 2 + row) % 2), 5.4 + 0.4 * row]
        for row in range(48)
    ]
    strokes.append(stroke("wall", loop(46.2, 5.2, 51.8, 24.8)))
    strokes.append(stroke("dense", zigzag))
    return strokes


def made_up_scores(model: int, contender: int) -> dict[str, float | None]:
    """Totals that differ between models and contenders, always the same."""
    rng = random.Random(1000 * model + contender)
    size = 3.0 ** (model % 7)
    return {
        "extrude_mm": 4000 * size,
        "travel_mm": size * rng.uniform(200, 900),
        "entry_travel_mm": size * rng.uniform(2, 9),
        "retractions": math.floor(size * rng.uniform(10, 60)),
        "crossings": math.floor(size * rng.uniform(0, 12)),
        "strokes": math.floor(size * rng.uniform(40, 90)),
        "covered": rng.uniform(0.955, 0.999),
        "deposit": rng.uniform(0.9, 1.1),
        "doubled": rng.uniform(0.001, 0.2),
        "filament_mm3": 320 * size,
        "print_time_s": size * rng.uniform(90, 140),
        "plan_wall_ns": size * 1e6 * 5 ** rng.uniform(0, 3),
        "plan_cpu_ns": size * 1e6 * 5 ** rng.uniform(0, 3),
        "peak_rss_bytes": 3e7 + 1e6 * size,
    }


def made_up_layers(
    model: int, contender: int, count: int
) -> list[dict[str, float | None]]:
    """Layers with a waist, so that curves have a shape."""
    rng = random.Random(77 * model + contender)
    rows: list[dict[str, float | None]] = []
    for index in range(count):
        size = 1.3 + math.cos(6 * index / count) + 0.05 * contender
        rows.append(
            {
                "travel_mm": 20 * size * rng.uniform(0.9, 1.1),
                "retractions": float(round(4 * size + rng.uniform(0, 2))),
            }
        )
    return rows


def fill(
    path: Path,
    models: Sequence[str],
    contenders: Sequence[str],
    settings: Sequence[str] = ("",),
    failures: dict[tuple[int, int], tuple[str, str]] | None = None,
    layers: int = 60,
) -> Path:
    """A whole experiment; `failures` by places of model and contender."""
    made = Database(path)
    setting_ids = [made.setting(label) for label in settings]
    model_ids = [made.model(spec) for spec in models]
    contender_ids = [made.contender(name) for name in contenders]
    for model in model_ids:
        made.shape(model, layers // 2)
    for setting in setting_ids:
        for model in model_ids:
            for contender in contender_ids:
                outcome, reason = (failures or {}).get(
                    (model - 1, contender - 1), ("valid", "")
                )
                scores = made_up_scores(model, contender + 40 * setting)
                whole = outcome in ("valid", "off_task")
                cell = made.cell(
                    model,
                    contender,
                    setting,
                    scores if whole else None,
                    outcome,
                    reason,
                )
                if not whole:
                    continue
                rng = random.Random(cell)
                base = scores["plan_cpu_ns"] or 0
                made.times(
                    cell,
                    [int(base * rng.uniform(0.97, 1.1)) for _ in range(5)],
                )
                made.layers(cell, made_up_layers(model, contender, layers))
                made.route(
                    cell,
                    layers // 2,
                    plate_strokes(
                        cell, 1.2 + 0.2 * (contender % 3), contender % 2 == 0
                    ),
                )
    return made.close()
