"""The file of results: opened as a private copy, checked, asked.

Nothing is ever written to it.
"""

from __future__ import annotations

import math
import sqlite3
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any
from urllib.parse import quote

from .errors import PlotError

SCHEMA_VERSION = "2"
DATABASE_NAME = "results.sqlite"


def find_database(results: Path) -> Path:
    """The database that `results`, a folder or the file itself, means."""
    database = results / DATABASE_NAME if results.is_dir() else results
    if not database.is_file():
        raise PlotError(
            f"{results}: no results database here; give the folder that "
            f"'routebench run' wrote, or its {DATABASE_NAME}"
        )
    return database


class Database:
    """A results database of the version that is read here."""

    def __init__(self, file: Path) -> None:
        self.file = file
        self._connection = _open(file)
        try:
            self._check_schema()
        except PlotError:
            self.close()
            raise

    def close(self) -> None:
        """Lets go of the file."""
        self._connection.close()

    def records(
        self, sql: str, values: Sequence[object] = ()
    ) -> Iterator[dict[str, Any]]:
        """The rows of a query, their values by the names of its columns."""
        try:
            cursor = self._connection.execute(sql, values)
            names = [column[0] for column in cursor.description]
            for row in cursor:
                yield dict(zip(names, row))
        except sqlite3.Error as error:
            raise self._broken(error) from error

    def query(
        self, sql: str, values: Sequence[object] = ()
    ) -> list[tuple[Any, ...]]:
        """All rows of a query."""
        try:
            return self._connection.execute(sql, values).fetchall()
        except sqlite3.Error as error:
            raise self._broken(error) from error

    def _broken(self, error: sqlite3.Error) -> PlotError:
        return PlotError(
            f"{self.file}: not a whole results database: {error}"
        )

    def _check_schema(self) -> None:
        rows = self.query(
            "SELECT value FROM meta WHERE key = 'schema_version'"
        )
        version = str(rows[0][0]) if rows else "missing"
        if version != SCHEMA_VERSION:
            raise PlotError(
                f"{self.file}: schema version {version}, but these plots "
                f"read version {SCHEMA_VERSION}; plot it with the routebench "
                "that wrote it"
            )


def _open(database: Path) -> sqlite3.Connection:
    """A private copy: a run that goes on writing is never kept waiting."""
    address = f"file:{quote(str(database.resolve()))}?mode=rw"
    try:
        # Opened for writing, because only then an interrupted write of a
        # run that was killed can be undone; nothing else is written.
        source = sqlite3.connect(address, uri=True)
        try:
            source.execute("PRAGMA query_only = ON")
            copy = sqlite3.connect("")
            source.backup(copy)
        finally:
            source.close()
    except sqlite3.Error as error:
        raise PlotError(
            f"{database}: cannot be read as a results database: {error}"
        ) from error
    copy.text_factory = lambda text: text.decode(errors="replace")
    return copy


def identifier(name: str) -> str:
    """A column's name as SQL wants it."""
    return '"' + name.replace('"', '""') + '"'


def number(value: object) -> float | None:
    """A finite number, or None for whatever else a column may hold."""
    if isinstance(value, str):
        try:
            value = float(value)
        except ValueError:
            return None
    if isinstance(value, (int, float)) and math.isfinite(value):
        return float(value)
    return None


def or_nan(value: object) -> float:
    """A finite number, or NaN."""
    found = number(value)
    return math.nan if found is None else found
