"""The results of an experiment as pandas data frames. Only the database is read."""

from __future__ import annotations

import json
import sqlite3
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

from ._routebench import Error

if TYPE_CHECKING:
    import pandas

SCHEMA_VERSION = "2"
"""Of the databases that this reads."""

_CELLS = """
    SELECT cell_id, experiment, spec AS model, contender.name AS contender, base_name,
           setting.label AS setting, current_cell.seed AS seed, outcome, reason,
           current_cell.layers AS layers, variant_json
    FROM current_cell JOIN run USING(run_id) JOIN model USING(model_id)
         JOIN contender USING(contender_id) JOIN setting USING(setting_id)
    ORDER BY setting_id, model_id, current_cell.seed, contender_id"""

_SCORES = """
    SELECT current_cell.cell_id AS cell_id, metric.name AS metric, value, unit, better
    FROM current_cell CROSS JOIN metric
         LEFT JOIN cell_score ON cell_score.cell_id = current_cell.cell_id
                             AND cell_score.metric = metric.name
    ORDER BY position"""

_LAYERS = """
    SELECT layer_score.* FROM current_cell JOIN layer_score USING(cell_id) ORDER BY layer_index"""

_TIMINGS = """
    SELECT cell_id, repetition, plan_wall_ns, plan_cpu_ns
    FROM current_cell JOIN timing_sample USING(cell_id) ORDER BY repetition"""

_LONG_FORMS = {"long": _SCORES, "layers": _LAYERS, "timings": _TIMINGS}
FORMS = ("wide", *_LONG_FORMS)


def read_results(results: str | Path, form: str = "wide") -> pandas.DataFrame:
    """Reads the cells of an experiment's last run.

    ``results`` is the folder that ``routebench run`` wrote, or its results.sqlite. ``form`` is

    * ``"wide"``: a row for each cell, a column for each metric, and one for each parameter of the
      planners (``fill.angle_deg``);
    * ``"long"``: a row for each cell and metric: ``metric``, ``value``, ``unit``, ``better``;
    * ``"layers"``: a row for each cell and layer, a column for each metric;
    * ``"timings"``: a row for each cell and repetition: ``plan_wall_ns``, ``plan_cpu_ns``.

    Every row begins with what tells its cell from the others. All cells are there: those that are
    not valid have the reason in the wide form, and no place in a ranking.

    Raises ImportError without pandas, Error for what is no results database.
    """
    if form not in FORMS:
        raise Error(f"form is {form!r}; it must be one of {', '.join(FORMS)}")
    try:
        import pandas
    except ImportError as error:
        raise ImportError(
            "read_results needs pandas: install the package python3-pandas"
        ) from error

    with _Database(_file_of(Path(results))) as database:
        cells = pandas.DataFrame(**database.table(_CELLS))
        variants = cells.pop("variant_json")
        if form == "wide":
            scores = pandas.DataFrame(**database.table(_SCORES))
            parameters = pandas.DataFrame([_parameters(text) for text in variants])
            parameters.index = cells.index
            values = scores.pivot(index="cell_id", columns="metric", values="value")
            values = values[list(dict.fromkeys(scores["metric"]))].astype(float)
            cells = cells.join(values, on="cell_id").join(parameters)
            return cells.drop(columns="cell_id")
        cells = cells.drop(columns=["reason", "layers"])
        rows = pandas.DataFrame(**database.table(_LONG_FORMS[form]))
        return cells.merge(rows, on="cell_id").drop(columns="cell_id")


def _parameters(variant_json: str) -> dict[str, Any]:
    """The slots of a contender with their parameters, as columns."""
    columns: dict[str, Any] = {}
    variant = json.loads(variant_json)
    for slot in ("shell", "fill"):
        if not isinstance(variant.get(slot), dict):
            continue
        columns[slot] = variant[slot]["planner"]
        for name, value in variant[slot]["params"].items():
            columns[f"{slot}.{name}"] = value
    return columns


def _file_of(results: Path) -> Path:
    file = results / "results.sqlite" if results.is_dir() else results
    if not file.is_file():
        raise Error(
            f"{results}: no results database here; give the folder that 'routebench run' wrote, "
            "or its results.sqlite"
        )
    return file


class _Database:
    """A database that is only read, seen at one moment."""

    def __init__(self, file: Path) -> None:
        self._connection = sqlite3.connect(f"file:{quote(str(file.resolve()))}?mode=ro", uri=True)
        try:
            self._connection.execute("BEGIN")
            found = self._connection.execute("SELECT value FROM meta WHERE key = 'schema_version'")
            version = (found.fetchone() or ("(none)",))[0]
        except sqlite3.DatabaseError as error:
            self._connection.close()
            raise Error(f"{file}: is no results database of routebench: {error}") from error
        if version != SCHEMA_VERSION:
            self._connection.close()
            raise Error(
                f"{file}: has schema version {version}, but this reads {SCHEMA_VERSION}"
            )

    def __enter__(self) -> _Database:
        return self

    def __exit__(self, *_: object) -> None:
        self._connection.close()

    def table(self, query: str) -> dict[str, Any]:
        """Rows and column names, as a data frame takes them."""
        rows = self._connection.execute(query)
        columns = [column[0] for column in rows.description]
        return {"data": rows.fetchall(), "columns": columns}
