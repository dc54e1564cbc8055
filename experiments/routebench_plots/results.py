"""Reads the database of an experiment.

Nothing else is read, and the database is never written. What the figures
need to know about a contender on a model under a setting is a `Slot`.
"""

from __future__ import annotations

import json
import statistics
from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .database import Database, identifier, number, or_nan
from .errors import PlotError
from .naming import distinct_labels, printable, short_specs

VALID = "valid"
NOT_RUN = "not_run"
"""What a slot without any cell is called; no outcome of the database."""

TIMED_METRICS = ("plan_wall_ns", "plan_cpu_ns")
"""Metrics whose every repetition is kept in the table timing_sample."""


@dataclass(frozen=True)
class Metric:
    """One row of the table that says what is measured."""

    name: str
    label: str
    unit: str
    better: str
    total: str
    meaning: str


@dataclass(frozen=True)
class Item:
    """A model, contender or setting with a label that no other one has."""

    row_id: int
    label: str


@dataclass(frozen=True)
class Cell:
    """One contender's work on one model with one seed."""

    cell_id: int
    seed: int
    outcome: str
    reason: str


@dataclass(frozen=True)
class Value:
    """Median and range of a metric over the seeds or repetitions."""

    median: float
    low: float
    high: float
    samples: int


@dataclass(frozen=True)
class Slot:
    """What is known of a contender on a model: one cell for each seed."""

    cells: tuple[Cell, ...] = ()

    @property
    def valid(self) -> tuple[Cell, ...]:
        """The cells that are ranked."""
        return tuple(c for c in self.cells if c.outcome == VALID)

    @property
    def outcomes(self) -> Counter[str]:
        """How many cells ended in which way."""
        if not self.cells:
            return Counter({NOT_RUN: 1})
        return Counter(cell.outcome for cell in self.cells)


@dataclass(frozen=True)
class LayerRows:
    """Scores of a cell's layers, lowest first; NaN where none applies."""

    z_mm: list[float]
    repaired: list[bool]
    columns: dict[str, list[float]]


class Results:
    """The cells of an experiment's last run, seen at one moment.

    Models and settings stand in the order of the config, contenders in
    that of their names, which decides how they look.
    """

    def __init__(self, database: Path) -> None:
        self.database = database
        self._file = Database(database)
        try:
            if self._file.query("PRAGMA foreign_key_check(cell)"):
                raise PlotError(
                    f"{database}: is damaged: a cell names a run, model, contender or "
                    "setting that is not there"
                )
            self._slots, self.earlier_cells = self._read_slots()
            self.experiment = self._read_experiment()
            self.metrics = self._read_metrics()
            self.models, self._model_rows = self._read_models()
            self.contenders = tuple(
                sorted(
                    self._read_items("contender", "name, variant_hash"),
                    key=lambda item: item.label,
                )
            )
            self.settings = self._read_items("setting", "label, setting_hash")
            self._scores = self._read_scores()
            self._samples = self._read_samples()
            self._tasks = self._read_json_of_settings("task")
            self._printers = self._read_json_of_settings("printer")
            self._layer_columns = frozenset(
                row[1] for row in self._file.query("PRAGMA table_info(layer_score)")
            )
        except PlotError:
            self.close()
            raise

    def __enter__(self) -> Results:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Lets go of the file."""
        self._file.close()

    def records(
        self, sql: str, values: Sequence[object] = ()
    ) -> Iterator[dict[str, Any]]:
        """The rows of a query, their values by the names of its columns."""
        return self._file.records(sql, values)

    def metric(self, name: str) -> Metric | None:
        """The metric of that name, if this database has it."""
        return next((m for m in self.metrics if m.name == name), None)

    def slot(self, setting: Item, model: Item, contender: Item) -> Slot:
        """What is known of a contender on a model under a setting."""
        row = self._model_rows.get((setting.row_id, model.row_id))
        return self._slots.get(
            (setting.row_id, row, contender.row_id), Slot()
        )

    def value(self, slot: Slot, metric: Metric) -> Value | None:
        """The metric over the slot's valid cells; None where absent.

        Times are taken from their repetitions, everything else from the
        cells' totals.
        """
        found = [v for one in self.samples(slot, metric) for v in one]
        if not found:
            return None
        return Value(
            statistics.median(found), min(found), max(found), len(found)
        )

    def samples(self, slot: Slot, metric: Metric) -> list[list[float]]:
        """What the value is made of: repetitions for each valid cell."""
        found = []
        for cell in slot.valid:
            samples = self._samples.get((cell.cell_id, metric.name))
            if samples:
                found.append(samples)
            elif (cell.cell_id, metric.name) in self._scores:
                found.append([self._scores[cell.cell_id, metric.name]])
        return found

    def all_values(self, setting: Item, metric: Metric) -> list[Value]:
        """The metric of every slot of a setting that has it."""
        return [
            value
            for model in self.models
            for contender in self.contenders
            if (
                value := self.value(
                    self.slot(setting, model, contender), metric
                )
            )
            is not None
        ]

    def has_values(self, metric: Metric) -> bool:
        """Whether any valid cell has this metric."""
        return any(self.all_values(s, metric) for s in self.settings)

    def last_run(self) -> dict[str, Any]:
        """The row of the run whose cells these are: where, when and with what it ran."""
        names = [row[1] for row in self._file.query("PRAGMA table_info(run)")]
        rows = self._file.query("SELECT * FROM run ORDER BY run_id DESC LIMIT 1")
        return dict(zip(names, rows[0])) if rows else {}

    def mesh_hash(self, setting: Item, model: Item) -> str:
        """Equal for equal meshes; empty where the setting lacks the model."""
        rows = self._file.query(
            "SELECT mesh_hash FROM model WHERE model_id = ?",
            (self._model_rows.get((setting.row_id, model.row_id)),),
        )
        return str(rows[0][0]) if rows else ""

    def task_number(self, setting: Item, key: str) -> float | None:
        """A number that the setting's task has under `key`, if any."""
        return number(self._tasks[setting.row_id].get(key))

    def task(self, setting: Item) -> dict[str, Any]:
        """The keys of the setting's [task]."""
        return self._tasks[setting.row_id]

    def printer(self, setting: Item) -> dict[str, Any]:
        """The keys of the setting's [printer]."""
        return self._printers[setting.row_id]

    def base_name(self, contender: Item) -> str:
        """The contender's name without the point of its sweep."""
        rows = self._file.query(
            "SELECT base_name FROM contender WHERE contender_id = ?",
            (contender.row_id,),
        )
        return str(rows[0][0])

    def config_tables(self, key: str) -> list[dict[str, Any]]:
        """A list of tables in the last run's config, with all defaults."""
        rows = self._file.query(
            "SELECT config_resolved_json FROM run ORDER BY run_id DESC LIMIT 1"
        )
        try:
            tables = json.loads(rows[0][0]).get(key, []) if rows else []
        except (TypeError, ValueError, AttributeError) as error:
            raise PlotError(
                f"{self.database}: the last run's config is not JSON: {error}"
            ) from error
        return [table for table in tables if isinstance(table, dict)]

    def model_size(
        self, setting: Item, model: Item, name: str
    ) -> float | None:
        """Triangles, layers, outline_vertices or side_mm of a model."""
        rows = self._file.query(
            "SELECT triangles, layers FROM model WHERE model_id = ?",
            (self.model_row(setting, model),),
        )
        if not rows:
            return None
        triangles, layers = rows[0]
        report = self.model_report(setting, model)
        mesh = report.get("mesh") or {}
        sides = [
            high - low
            for low, high in zip(
                mesh.get("lower_mm", []), mesh.get("upper_mm", [])
            )
        ]
        return number(
            {
                "triangles": triangles,
                "layers": layers,
                "outline_vertices": report.get("outline_vertices"),
                "side_mm": max(sides, default=None),
            }[name]
        )

    def model_report(self, setting: Item, model: Item) -> dict[str, Any]:
        """What was found in a model; its mesh is None if it is a file of layers."""
        rows = self._file.query(
            "SELECT report_json FROM model WHERE model_id = ?",
            (self.model_row(setting, model),),
        )
        return json.loads(rows[0][0]) if rows else {}

    def layer_rows(self, cell: Cell, metrics: Sequence[Metric]) -> LayerRows:
        """The scores of the cell's layers, upwards."""
        names = [m.name for m in metrics if m.name in self._layer_columns]
        columns = "".join(f", {identifier(name)}" for name in names)
        rows = self._file.query(
            f"SELECT z_mm, repaired{columns} FROM layer_score "
            "WHERE cell_id = ? ORDER BY z_mm, layer_index",
            (cell.cell_id,),
        )
        return LayerRows(
            z_mm=[or_nan(row[0]) for row in rows],
            repaired=[bool(row[1]) for row in rows],
            columns={
                name: [or_nan(row[place]) for row in rows]
                for place, name in enumerate(names, start=2)
            },
        )

    def layer_value(
        self, cell: Cell, layer_index: int, metric: Metric
    ) -> float | None:
        """One score of one layer of a cell."""
        if metric.name not in self._layer_columns:
            return None
        rows = self._file.query(
            f"SELECT {identifier(metric.name)} FROM layer_score "
            "WHERE cell_id = ? AND layer_index = ?",
            (cell.cell_id, layer_index),
        )
        return number(rows[0][0]) if rows else None

    def kept_layers(
        self, setting: Item, model: Item
    ) -> list[tuple[int, float]]:
        """Index and height of the layers whose pictures were kept."""
        rows = self._file.query(
            "SELECT layer_index, z_mm FROM layer_shape WHERE model_id = ? "
            "ORDER BY layer_index",
            (self._model_rows.get((setting.row_id, model.row_id)),),
        )
        return [(int(row[0]), float(row[1])) for row in rows]

    def layer_wkt(
        self, setting: Item, model: Item, layer_index: int
    ) -> str:
        """The material of a kept layer."""
        rows = self._file.query(
            "SELECT wkt FROM layer_shape "
            "WHERE model_id = ? AND layer_index = ?",
            (
                self._model_rows[setting.row_id, model.row_id],
                layer_index,
            ),
        )
        return str(rows[0][0])

    def route_json(self, cell: Cell, layer_index: int) -> str | None:
        """The route of a kept layer, if the cell came that far."""
        rows = self._file.query(
            "SELECT strokes_json FROM route "
            "WHERE cell_id = ? AND layer_index = ?",
            (cell.cell_id, layer_index),
        )
        return str(rows[0][0]) if rows else None

    def model_row(self, setting: Item, model: Item) -> int | None:
        """Which row of the table model a model is under a setting."""
        return self._model_rows.get((setting.row_id, model.row_id))

    def _read_metrics(self) -> tuple[Metric, ...]:
        rows = self._file.query(
            "SELECT name, label, unit, better, total, meaning FROM metric "
            "ORDER BY position"
        )
        return tuple(Metric(*map(str, row)) for row in rows)

    def _read_items(
        self, table: str, columns: str, names: Mapping[str, str] | None = None
    ) -> tuple[Item, ...]:
        """The rows of a table that a cell of the last run refers to.

        `names` says what is to be shown in place of the first column.
        """
        rows = self._file.query(
            f"SELECT {table}_id, {columns} FROM {table} WHERE {table}_id IN "
            f"(SELECT {table}_id FROM current_cell) ORDER BY {table}_id"
        )
        labels = distinct_labels(
            [((names or {}).get(str(r[1]), str(r[1])), str(r[2])) for r in rows]
        )
        return tuple(Item(int(r[0]), text) for r, text in zip(rows, labels))

    def _read_models(
        self,
    ) -> tuple[tuple[Item, ...], dict[tuple[int, int], int]]:
        """The models, and which row each of them is under a setting.

        Tasks that want other layers or skins cut the same file anew: these
        rows are one model, as long as no setting has two of them.
        """
        specs = dict(self._file.query("SELECT model_id, spec FROM model"))
        names = short_specs(specs[model] for _, model, _ in self._slots)
        items = self._read_items(
            "model", "spec, mesh_hash || layers_hash", names
        )
        used: dict[str, dict[int, set[int]]] = defaultdict(
            lambda: defaultdict(set)
        )
        for setting, model, _ in self._slots:
            used[specs[model]][setting].add(model)
        models = []
        rows = {}
        for item in items:
            spec = specs[item.row_id]
            by_setting = used[spec]
            if all(len(found) == 1 for found in by_setting.values()):
                first = min(m for found in by_setting.values() for m in found)
                if item.row_id != first:
                    continue
                item = Item(first, printable(names[spec]))
                for setting, found in by_setting.items():
                    rows[setting, first] = next(iter(found))
            else:
                for setting in by_setting:
                    rows[setting, item.row_id] = item.row_id
            models.append(item)
        return tuple(models), rows

    def _read_experiment(self) -> str:
        rows = self._file.query("SELECT value FROM meta WHERE key = 'experiment'")
        return printable(str(rows[0][0])) if rows else ""

    def _read_slots(self) -> tuple[dict[tuple[int, int, int], Slot], int]:
        """The slots, and how many cells of earlier runs are not in them."""
        rows = self._file.query(
            "SELECT setting_id, model_id, contender_id, cell_id, seed, "
            "outcome, reason FROM current_cell ORDER BY seed, cell_id"
        )
        if not rows:
            raise PlotError(
                f"{self.database}: no cells yet; let 'routebench run' finish "
                "at least one"
            )
        groups: dict[tuple[int, int, int], list[Cell]] = defaultdict(list)
        for row in rows:
            cell_id, seed, outcome, reason = row[3:]
            groups[row[0], row[1], row[2]].append(
                Cell(int(cell_id), seed % 2**64, str(outcome), str(reason))
            )
        slots = {key: Slot(tuple(cells)) for key, cells in groups.items()}
        total = self._file.query("SELECT count(*) FROM cell")[0][0]
        return slots, total - len(rows)

    def _read_scores(self) -> dict[tuple[int, str], float]:
        rows = self._file.query("SELECT cell_id, metric, value FROM cell_score")
        scores = {}
        for cell_id, metric, value in rows:
            total = number(value)
            if total is not None:
                scores[cell_id, metric] = total
        return scores

    def _read_samples(self) -> dict[tuple[int, str], list[float]]:
        columns = ", ".join(TIMED_METRICS)
        rows = self._file.query(
            f"SELECT cell_id, {columns} FROM timing_sample "
            "ORDER BY cell_id, repetition"
        )
        samples: dict[tuple[int, str], list[float]] = defaultdict(list)
        for cell_id, *values in rows:
            for metric, value in zip(TIMED_METRICS, values):
                sample = number(value)
                if sample is not None:
                    samples[cell_id, metric].append(sample)
        return samples

    def _read_json_of_settings(self, table: str) -> dict[int, dict[str, Any]]:
        """The config's table of that name as each setting has it."""
        found = {}
        for setting_id, text in self._file.query(
            f"SELECT setting_id, {table}_json FROM setting"
        ):
            try:
                keys = json.loads(text)
            except (TypeError, ValueError) as error:
                raise PlotError(
                    f"{self.database}: {table} of setting {setting_id} is "
                    f"not JSON: {error}"
                ) from error
            found[setting_id] = keys if isinstance(keys, dict) else {}
        return found
