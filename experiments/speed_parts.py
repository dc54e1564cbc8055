"""Parts of the job, measured by routebench-bench, beside what bounds them.

A bound is what the same machine takes, in the same run, for what cannot be avoided, such as to hand
over a file's bytes; or a figure for one edge, one segment or one layer.
"""

from __future__ import annotations

import json
import re
import subprocess
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Measured:
    """A benchmark's median."""

    wall_ms: float
    items_per_second: float | None = None


@dataclass(frozen=True)
class Part:
    """What is measured, and how many times its bound's time it may take."""

    label: str
    benchmark: str
    bound_label: str
    bound: str
    limit: float

    def row(self, measured: Mapping[str, Measured]) -> str:
        ours, bound = measured[self.benchmark].wall_ms, measured[self.bound].wall_ms
        return (f"| {self.label} | {ours:.3g} ms | {self.bound_label}: {bound:.3g} ms "
                f"| {ours / bound:.1f} x | {self.limit:g} x | {said(ours <= self.limit * bound)} |")

    def names(self) -> list[str]:
        return [self.benchmark, self.bound]


@dataclass(frozen=True)
class Cost:
    """What one item costs, of which the benchmark handles many, or the whole of it without items."""

    label: str
    benchmark: str
    limit_ns: float
    item: str

    def row(self, measured: Mapping[str, Measured]) -> str:
        found = measured[self.benchmark]
        cost_ns = 1e9 / found.items_per_second if found.items_per_second else found.wall_ms * 1e6
        return (f"| {self.label} | {found.wall_ms:.3g} ms | | {duration(cost_ns)} {self.item} "
                f"| {duration(self.limit_ns)} | {said(cost_ns <= self.limit_ns)} |")

    def names(self) -> list[str]:
        return [self.benchmark]


READ_AND_SLICE = "Read 2 M triangles (binary STL) and slice them into 750 layers"
PARTS: list[Part | Cost] = [
    *(Part(f"{READ_AND_SLICE}, {jobs} core{'s' if jobs > 1 else ''}, "
           + ("new memory" if new else "memory that is there"),
           f"read_and_slice/triangles:2000000/jobs:{jobs}/new_memory:{new}/real_time",
           "the file's bytes, " + ("new memory" if new else "memory that is there"),
           f"copy_large_binary_stl/triangles:2000000/new_memory:{new}/real_time", 12)
      for jobs in (2, 1) for new in (1, 0)),
    *(Part(f"Read 2 M triangles (ASCII STL), {jobs} core{'s' if jobs > 1 else ''}",
           f"read_large_ascii_stl/triangles:2000000/jobs:{jobs}/real_time",
           "read the bytes and count lines", "scan_large_ascii_stl/2000000/real_time", 8)
      for jobs in (2, 1)),
    *(Part(f"Write G-code, {jobs} core{'s' if jobs > 1 else ''}",
           f"write_gcode_file/points:2048/jobs:{jobs}/real_time",
           "the same bytes, ready made, to " + ("the disk" if on_disk else "the system's memory"),
           f"write_ready_bytes/points:2048/on_disk:{on_disk}/real_time", 2)
      for jobs in (2, 1) for on_disk in (1, 0)),
    Cost("Hierholzer, 10 M edges", "hierholzer/2236", 60, "an edge"),
    Cost("`greedy_shell` with its grid, 100,000 segments", "walls_of_a_plate/71", 1000, "a segment"),
    *(Cost(f"Coverage of a layer 100 mm across, density {percent / 100:g}",
           f"cover_layer/percent:{percent}", 3e6, "a layer") for percent in (20, 100)),
]


def said(is_met: bool) -> str:
    return "yes" if is_met else "no"


def duration(nanoseconds: float) -> str:
    """In the unit that needs no power of ten."""
    for unit, size in (("ms", 1e6), ("us", 1e3)):
        if nanoseconds >= size:
            return f"{nanoseconds / size:.3g} {unit}"
    return f"{nanoseconds:.3g} ns"


def names() -> list[str]:
    """All benchmarks that the table wants, each once."""
    return list(dict.fromkeys(name for part in PARTS for name in part.names()))


def groups() -> list[list[str]]:
    """The same, those together that have bounds of one kind, or none."""
    kinds: dict[str, dict[str, None]] = {}
    for part in PARTS:
        kind = part.names()[-1].split("/")[0]
        kinds.setdefault(kind, {}).update(dict.fromkeys(part.names()))
    return [list(kind) for kind in kinds.values()]


def medians(document: str) -> dict[str, Measured]:
    """The medians in what routebench-bench writes as JSON."""
    to_ms = {"ns": 1e-6, "us": 1e-3, "ms": 1.0, "s": 1e3}
    return {entry["run_name"]: Measured(entry["real_time"] * to_ms[entry["time_unit"]],
                                        entry.get("items_per_second"))
            for entry in json.loads(document)["benchmarks"]
            if entry.get("aggregate_name") == "median"}


def measure(program: Path, repetitions: int) -> dict[str, Measured]:
    """Executes the benchmarks, those of all repetitions in random order, and in a process of their
    own those that share a bound: the memory that others leave behind changes what they take.

    Raises SystemExit if the program lacks one of them.
    """
    found: dict[str, Measured] = {}
    for together in groups():
        command = [str(program), "--benchmark_filter=^(" + "|".join(map(re.escape, together)) + ")$",
                   f"--benchmark_repetitions={max(2, repetitions)}",  # of one there is no median
                   "--benchmark_enable_random_interleaving=true",
                   "--benchmark_report_aggregates_only=true", "--benchmark_format=json"]
        found |= medians(subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                                        check=True, encoding="utf-8").stdout)
    missing = [name for name in names() if name not in found]
    if missing:
        raise SystemExit(f"speed_parts.py: {program}: no benchmark '{missing[0]}'")
    return found


def table(measured: Mapping[str, Measured]) -> list[str]:
    """The page's lines."""
    return ["| part | takes | bound | that is | at most | met |", "|---|---|---|---|---|---|",
            *(part.row(measured) for part in PARTS)]
