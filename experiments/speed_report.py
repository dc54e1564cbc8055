#!/usr/bin/env python3
"""Measures the whole job, model to G-code, beside the slicers that are installed, and writes a page.

    experiments/speed_report.py PROGRAM --models DIR --out DIR [--only NAME,...] [--repetitions N]
                                [--cores 2,1] [--bench PROGRAM] [--before PROGRAM]

One process at a time, all contenders of a model in random order, again in every repetition; each is
bound to the given number of cores. All have the same work: once all fill what is too narrow for a
wall, as the planners do unless told otherwise, and once all leave it; how much of the parts each
covers, as our judge sees it, tells whether they did. Wall time, CPU time and peak memory are those
of the process and its children as the kernel counts them; the page shows medians. What judging
costs beside planning is told by the program itself, for every layer. With --bench, a
routebench-bench, parts of the job stand beside what bounds them. With --before, an older build of
the program, and valgrind installed, it also tells how many instructions named functions take before
and after: that does not depend on what else the machine does.
"""

from __future__ import annotations

import argparse
import csv
import json
import math
import os
import platform
import random
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from dataclasses import asdict, dataclass
from pathlib import Path

import speed_parts

TASK = {"layer_height_mm": 0.2, "line_width_mm": 0.45, "perimeters": 2, "density": 0.2,
        "skin_layers": 3}
SPACING_MM = 0.45 - 0.2 * (1 - 3.141592653589793 / 4)
PLANNERS = ["--shell", "greedy_shell", "--fill", "rectilinear"]
FEWEST_TRIANGLES = 20_000
MANY_CONTOURS = ["thin/hex_grate.stl"]
OURS = "routebench"
# How many times faster we are to be, and the share of the other's memory that we may take.
TARGETS = {"PrusaSlicer": (15.0, 0.5), "Slic3r": (15.0, None), "CuraEngine": (8.0, 1.0)}
MANY_CONTOURS_TARGET = 50.0  # times faster than PrusaSlicer
JUDGING_TARGET = 1.0  # times what reading, slicing and planning take
# What is too narrow for a wall gets a line of its own width, or none.
LEAVE_NARROW = ["--set", "shell.gaps=leave", "--set", "fill.thin=drop"]
PROFILED = ["organic/armadillo.stl?size=40", "thin/hex_grate.stl?size=40"]
PROFILED_FUNCTIONS = {
    "whole job": r"\(below main\)",
    "offsets": r"routebench::offset\(",
    "rings to polygons": r"routebench::polygons_from_rings\(",
    "skins and demands": r"routebench::(find_solid|SkinFinder::skins_in|SkinFinder::SkinFinder|"
                         r"demand_of)\(",
}


@dataclass
class Run:
    """One execution of one contender."""

    model: str
    contender: str
    narrow: str  # places: "filled" or "left"
    cores: int
    wall_s: float
    cpu_s: float
    peak_mb: float
    gcode_bytes: int
    covered: float = math.nan  # share of what is to be covered; judged once


@dataclass
class Phases:
    """CPU time of one execution on one core, every layer planned and judged."""

    model: str
    planning_s: float  # with reading and slicing
    judging_s: float


def ini(prusa: bool, fills_narrow: bool) -> str:
    """The task for PrusaSlicer and Slic3r, which share most of their keys."""
    keys: dict[str, object] = {
        "layer_height": 0.2, "first_layer_height": 0.2, "perimeters": 2, "fill_density": "20%",
        "fill_pattern": "rectilinear", "fill_angle": 45, "infill_overlap": "25%",
        "top_solid_layers": 3, "bottom_solid_layers": 3, "solid_infill_below_area": 0,
        "thin_walls": int(fills_narrow), "extra_perimeters": 0, "overhangs": 0, "skirts": 0,
        "brim_width": 0, "support_material": 0, "cooling": 0, "nozzle_diameter": 0.4,
        "filament_diameter": 1.75, "seam_position": "nearest", "retract_length": 0.8,
        "retract_speed": 40, "retract_before_travel": 2, "retract_layer_change": 0,
        "retract_lift": 0, "wipe": 0, "only_retract_when_crossing_perimeters": 0,
        "avoid_crossing_perimeters": 0, "bed_shape": "0x0,400x0,400x400,0x400",
        "travel_speed": 150, "first_layer_speed": 60,
    }
    for part in ("", "first_layer_", "perimeter_", "external_perimeter_", "infill_",
                 "solid_infill_", "top_infill_"):
        keys[f"{part}extrusion_width"] = 0.45
    for part in ("perimeter", "external_perimeter", "small_perimeter", "infill", "solid_infill",
                 "top_solid_infill", "gap_fill", "bridge"):
        keys[f"{part}_speed"] = 60
    if prusa:
        keys |= {"perimeter_generator": "classic", "ensure_vertical_shell_thickness": 0,
                 "elefant_foot_compensation": 0, "gap_fill_enabled": int(fills_narrow)}
    else:
        keys["fill_gaps"] = int(fills_narrow)
    return "".join(f"{key} = {value}\n" for key, value in keys.items())


def cura_settings(fills_narrow: bool) -> list[str]:
    """The task for CuraEngine, whose beads are rectangles; once for all, once for the extruder."""
    keys: dict[str, object] = {
        "layer_height": 0.2, "layer_height_0": 0.2, "wall_line_count": 2, "top_layers": 3,
        "bottom_layers": 3, "initial_bottom_layers": 3, "roofing_layer_count": 0,
        "infill_line_distance": round(SPACING_MM / 0.2, 5), "infill_pattern": "zigzag",
        "zig_zaggify_infill": "true", "infill_wipe_dist": 0, "initial_layer_line_width_factor": 100,
        "adhesion_type": "none", "support_enable": "false",
        "fill_outline_gaps": str(fills_narrow).lower(),
        "fill_perimeter_gaps": "everywhere" if fills_narrow else "nowhere",
        "alternate_extra_perimeter": "false",
        "retraction_combing": "off", "retraction_amount": 0.8, "retraction_min_travel": 2,
        "retraction_count_max": 10000, "travel_avoid_other_parts": "false",
        "speed_slowdown_layers": 0, "acceleration_enabled": "false", "material_diameter": 1.75,
    }
    for part in ("line_width", "wall_line_width", "wall_line_width_0", "wall_line_width_x",
                 "skin_line_width", "infill_line_width"):
        keys[part] = round(SPACING_MM, 5)
    settings: list[str] = []
    for key, value in keys.items():
        settings += ["-s", f"{key}={value}"]
    return settings + ["-e0"] + settings


def cura_definitions() -> Path | None:
    """fdmprinter.def.json, on CURA_ENGINE_SEARCH_PATH, where Debian's cura has it, or where
    install_slicers.sh has unpacked that package."""
    folders = os.environ.get("CURA_ENGINE_SEARCH_PATH", "").split(":")
    resources = "usr/share/cura/resources/definitions"
    cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    for folder in [*filter(None, folders), Path("/") / resources,
                   cache / "routebench" / "cura" / resources]:
        if (Path(folder) / "fdmprinter.def.json").is_file():
            return Path(folder) / "fdmprinter.def.json"
    return None


def task_options() -> list[str]:
    return [word for key, value in TASK.items() for word in ("--task", f"{key}={value}")]


def contenders(program: Path, scratch: Path,
               fills_narrow: bool) -> tuple[dict[str, list[str]], list[str]]:
    """Command lines with MODEL, OUT and CORES to be filled in, and what is missing."""
    found = {OURS: [str(program), "plan", "MODEL", *PLANNERS,
                    *([] if fills_narrow else LEAVE_NARROW), *task_options(), "--no-judge",
                    "--gcode", "OUT", "--jobs", "CORES"]}
    missing: list[str] = []
    for name, command in (("PrusaSlicer", "prusa-slicer"), ("Slic3r", "slic3r")):
        if shutil.which(command) is None:
            missing.append(f"{name} ({command})")
            continue
        settings = scratch / f"{command}-{'filled' if fills_narrow else 'left'}.ini"
        settings.write_text(ini(command == "prusa-slicer", fills_narrow), encoding="utf-8")
        found[name] = (
            [command, "--load", str(settings), "--loglevel", "1", "--center", "200,200",
             "--export-gcode", "--output", "OUT", "MODEL"] if command == "prusa-slicer" else
            [command, "--no-gui", "--load", str(settings), "--print-center", "200,200",
             "--threads", "CORES", "--output", "OUT", "MODEL"])
    definitions = cura_definitions()
    if shutil.which("CuraEngine") is None or definitions is None:
        missing.append("CuraEngine (the program, or fdmprinter.def.json of the package cura)")
    else:
        os.environ["CURA_ENGINE_SEARCH_PATH"] = ":".join(
            [str(definitions.parent), str(definitions.parent.parent / "extruders")])
        found["CuraEngine"] = ["CuraEngine", "slice", "-mCORES", "-j", str(definitions),
                               *cura_settings(fills_narrow), "-o", "OUT", "-l", "MODEL"]
    return found, missing


def execute(command: list[str], model: Path, cores: int, scratch: Path) -> Run | None:
    """Runs a contender once; nothing if it fails."""
    out = scratch / "out.gcode"
    out.unlink(missing_ok=True)
    fill = {"MODEL": str(model), "OUT": str(out), "CORES": str(cores)}
    words = [fill.get(word, word.replace("-mCORES", f"-m{cores}")) for word in command]
    # The program inherits our cores: a function to run before it would have all of this process
    # copied first, for longer than the smallest jobs can spare.
    usable = os.sched_getaffinity(0)
    os.sched_setaffinity(0, sorted(usable)[:cores])
    begin = time.monotonic()
    process = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    wall_s = time.monotonic() - begin
    os.sched_setaffinity(0, usable)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0 or not out.exists():
        return None
    return Run(model.name, "", "", cores, wall_s, usage.ru_utime + usage.ru_stime,
               usage.ru_maxrss / 1024, out.stat().st_size)


def measure(program: Path, model: Path, commands: dict[str, dict[str, list[str]]],
            works: list[tuple[str, int]], repetitions: int, scratch: Path) -> list[Run]:
    """Runs every contender of `commands`, by what becomes of narrow places, on every work; what it
    has written the first time is judged by `program`."""
    order = random.Random(model.stem)
    runs: list[Run] = []
    for repetition in range(repetitions):
        cells = [(name, narrow, count) for narrow, count in works for name in commands[narrow]]
        for name, narrow, count in order.sample(cells, len(cells)):
            run = execute(commands[narrow][name], model, count, scratch)
            print(f"{model.stem} {repetition + 1}/{repetitions} {name}, narrow places {narrow}, "
                  f"on {count}: "
                  + (f"{run.wall_s:.2f} s, CPU {run.cpu_s:.2f} s" if run else "failed"),
                  file=sys.stderr, flush=True)
            if run:
                run.model, run.contender, run.narrow = model.stem, name, narrow
                if repetition == 0:
                    run.covered = covered_by(program, model, scratch / "out.gcode")
                runs.append(run)
    return runs


def covered_by(program: Path, model: Path, gcode: Path) -> float:
    """What a file's strokes cover of what is to be covered, as a share; nan if nobody can tell."""
    done = subprocess.run([str(program), "plan", str(model), "--from-gcode", str(gcode),
                           *task_options(), "--json", "-"], stdout=subprocess.PIPE,
                          stderr=subprocess.DEVNULL, check=False, encoding="utf-8")
    if done.returncode not in (0, 1):
        return math.nan
    return json.loads(done.stdout).get("totals", {}).get("covered", math.nan)


def measure_phases(program: Path, model: Path, repetitions: int) -> list[Phases]:
    usable = os.sched_getaffinity(0)
    os.sched_setaffinity(0, sorted(usable)[:1])
    command = [str(program), "plan", str(model), *PLANNERS, *task_options(), "--jobs", "1",
               "--phases", "--json", "-"]
    phases: list[Phases] = []
    for _ in range(repetitions):
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                              check=False, encoding="utf-8")
        if done.returncode in (0, 1):
            cpu_ns = json.loads(done.stdout)["cpu_ns"]
            phases.append(Phases(model.stem, (cpu_ns["prepare"] + cpu_ns["plan"]) / 1e9,
                                 cpu_ns["judge"] / 1e9))
    os.sched_setaffinity(0, usable)
    return phases


def write_page(folder: Path, runs: list[Run], text: str) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / "runs.csv").open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, list(Run.__dataclass_fields__), lineterminator="\n")
        writer.writeheader()
        writer.writerows({key: round(value, 4) if isinstance(value, float) else value
                          for key, value in asdict(run).items()} for run in runs)
    (folder / "README.md").write_text(text, encoding="utf-8")


def instructions(program: Path, model: str, scratch: Path, judged: bool) -> dict[str, float] | None:
    """Instructions of the profiled functions with all that they call.

    Without centre lines: those ask CGAL for exact predicates, which round in directions that
    valgrind cannot.
    """
    file = scratch / "callgrind.out"
    command = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={file}", str(program), "plan",
               model, *PLANNERS, *LEAVE_NARROW, *task_options(), "--jobs", "1", "--gcode",
               str(scratch / "out.gcode")] + ([] if judged else ["--no-judge"])
    if subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                      check=False).returncode not in (0, 1):
        return None
    table = subprocess.run(["callgrind_annotate", "--inclusive=yes", "--threshold=100", str(file)],
                           stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True,
                           encoding="utf-8").stdout
    rows = [(int(m.group(1).replace(",", "")), m.group(2)) for m in
            re.finditer(r"^ *([0-9,]+) \([^)]*\) +[^:]*:(.*)$", table, re.MULTILINE)]
    result: dict[str, float] = {}
    for name, pattern in PROFILED_FUNCTIONS.items():
        hits = [count for count, function in rows if re.match(pattern, function)]
        result[name] = max(hits, default=0) if name == "whole job" else sum(hits)
    judging = [count for count, function in rows
               if re.match(r"routebench::judge_layers\(", function)]
    result["whole job"] -= max(judging, default=0)
    return result


def median_runs(runs: list[Run]) -> dict[tuple[str, str, str, int], Run]:
    groups: dict[tuple[str, str, str, int], list[Run]] = {}
    for run in runs:
        groups.setdefault((run.model, run.contender, run.narrow, run.cores), []).append(run)
    return {key: Run(*key, *(statistics.median(getattr(r, field) for r in group)
                             for field in ("wall_s", "cpu_s", "peak_mb", "gcode_bytes")),
                     group[0].covered)
            for key, group in groups.items()}


def judging_table(phases: list[Phases]) -> list[str]:
    lines = ["| model | reading, slicing, planning: CPU s | judging: CPU s | judging takes "
             "| at most | met |", "|---|---|---|---|---|---|"]
    for model in sorted({phase.model for phase in phases}):
        of_model = [phase for phase in phases if phase.model == model]
        ratio = statistics.median(phase.judging_s / phase.planning_s for phase in of_model)
        lines.append(f"| {model} "
                     f"| {statistics.median(phase.planning_s for phase in of_model):.3f} "
                     f"| {statistics.median(phase.judging_s for phase in of_model):.3f} "
                     f"| {ratio:.2f} x | {JUDGING_TARGET:g} x "
                     f"| {speed_parts.said(ratio <= JUDGING_TARGET)} |")
    return lines


def slicer_table(medians: dict[tuple[str, str, str, int], Run], narrow: str,
                 cores: int) -> list[str]:
    lines = ["| model | contender | covered, % | wall s | CPU s | peak MB "
             "| our wall is shorter by | our CPU is less by | target | met |",
             "|---|---|---|---|---|---|---|---|---|---|"]
    there = {name for _, name, *_ in medians}
    for model in sorted({model for model, *_ in medians}):
        ours = medians.get((model, OURS, narrow, cores))
        for name in [OURS, *TARGETS]:
            run = medians.get((model, name, narrow, cores))
            if ours is None or name not in there:
                continue
            if run is None:
                lines.append(f"| {model} | {name} | - | fails | | | | | | |")
                continue
            covered = f"{100 * run.covered:.1f}" if math.isfinite(run.covered) else "-"
            row = (f"| {model} | {name} | {covered} | {run.wall_s:.2f} | {run.cpu_s:.2f} "
                   f"| {run.peak_mb:.0f} ")
            if name == OURS:
                lines.append(row + "| | | | |")
                continue
            faster, memory = TARGETS[name]
            if any(Path(m).stem == model for m in MANY_CONTOURS):
                faster = MANY_CONTOURS_TARGET if name == "PrusaSlicer" else faster
            ratio = run.wall_s / ours.wall_s
            lean = memory is None or ours.peak_mb <= memory * run.peak_mb
            met = ("yes" if ratio >= faster else "no") + ("" if lean else ", too much memory")
            target = f"{faster:g} x" + (f", memory {memory:g} x" if memory else "")
            lines.append(row + f"| {ratio:.1f} x | {run.cpu_s / ours.cpu_s:.1f} x "
                               f"| {target} | {met} |")
    return lines


def page(runs: list[Run], phases: list[Phases], parts: dict[str, speed_parts.Measured],
         missing: list[str], works: list[tuple[str, int]], repetitions: int,
         profiles: list[tuple[str, dict[str, float], dict[str, float]]], load: float,
         commit: str) -> str:
    medians = median_runs(runs)
    lines = ["# The whole job beside slicers", "",
             "Model to written G-code: `plan MODEL " + " ".join(PLANNERS) + " --no-judge`, task "
             + ", ".join(f"{key} = {value}" for key, value in TASK.items()) + ". Slicers have the "
             "same task, as far as their settings go (see `experiments/speed_report.py`). Where a "
             "part or a gap is too narrow for a wall, these planners lay a line of its own width; "
             "so the slicers are told to find thin walls and to fill gaps. The last table is of "
             "jobs that leave such places: ours with `" + " ".join(LEAVE_NARROW) + "`, theirs "
             "without these settings. How much of what is to be covered each file covers is judged "
             "once, as by `plan --from-gcode`. Who fails has ended with an "
             "error.", "",
             f"Medians of {repetitions} run(s), contenders in random order, one at a time, bound "
             f"to the cores named. {platform.machine()}, {os.cpu_count()} cores, commit {commit}. "
             f"The load of the machine was {load:.1f} when measuring began: above 1 or 2, other "
             "jobs took part of the cores, so wall times are longer than they would be; CPU times "
             "suffer less. Compare contenders within a row."]
    if missing:
        lines += ["", "Not installed, so not compared: " + "; ".join(missing) + "."]
    for narrow, count in works:
        lines += ["", f"## On {count} core{'s' if count > 1 else ''}, narrow places {narrow}", "",
                  *slicer_table(medians, narrow, count)]
    if phases:
        lines += ["", "## Judging beside planning", "",
                  "On one core, as `plan --phases` tells it: every layer is planned and judged, "
                  "equal ones, too.", "", *judging_table(phases)]
    if parts:
        lines += ["", "## Parts of the job", "",
                  "Measured by `routebench-bench`, a part and its bound in one process; wall "
                  "times, medians.", "", *speed_parts.table(parts)]
    if profiles:
        lines += ["", "## Instructions before and after", "",
                  "Counted by callgrind on one thread, with all that the functions call; without "
                  "judging and without centre lines (valgrind cannot round as CGAL needs it). "
                  "Functions may call each other, so parts overlap.", "",
                  "| model | part | before, millions | after, millions | after / before |",
                  "|---|---|---|---|---|"]
        for model, before, after in profiles:
            for name in PROFILED_FUNCTIONS:
                share = after[name] / before[name] if before[name] else float("nan")
                lines.append(f"| {model} | {name} | {before[name] / 1e6:.0f} "
                             f"| {after[name] / 1e6:.0f} | {share:.3f} |")
    lines += ["", "## How it was made", "", "`experiments/speed.sh` measured and wrote this page; "
              "`runs.csv` has every run.", ""]
    return "\n".join(lines)


def chosen_models(folder: Path, only: list[str]) -> list[Path]:
    with (folder / "MANIFEST.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    names = [row["file"] for row in rows
             if int(row["triangles"]) >= FEWEST_TRIANGLES or row["file"] in MANY_CONTOURS]
    return [folder / name for name in names if not only or Path(name).stem in only]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=Path)
    parser.add_argument("--models", type=Path, required=True, help="folder with a MANIFEST.csv")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--only", default="", help="names of models, separated by commas")
    parser.add_argument("--repetitions", type=int, default=3)
    parser.add_argument("--cores", default="2,1")
    parser.add_argument("--bench", type=Path, help="routebench-bench, for parts of the job")
    parser.add_argument("--before", type=Path, help="an older build, for instruction counts")
    arguments = parser.parse_args()
    if not (arguments.models / "MANIFEST.csv").is_file():
        parser.error(f"{arguments.models}: no MANIFEST.csv there")
    cores = [int(count) for count in arguments.cores.split(",")]
    load = os.getloadavg()[0]
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], stdout=subprocess.PIPE,
                            encoding="utf-8", check=False).stdout.strip() or "unknown"
    with tempfile.TemporaryDirectory() as folder:
        scratch = Path(folder)
        commands: dict[str, dict[str, list[str]]] = {}
        for narrow in ("filled", "left"):
            commands[narrow], missing = contenders(arguments.program.resolve(), scratch,
                                                   narrow == "filled")
        works = [*(("filled", count) for count in cores), ("left", cores[0])]
        models = chosen_models(arguments.models, [n for n in arguments.only.split(",") if n])
        profiles = []
        if arguments.before and shutil.which("valgrind"):
            for model in PROFILED:
                path = str(arguments.models / model)
                before = instructions(arguments.before.resolve(), path, scratch, True)
                after = instructions(arguments.program.resolve(), path, scratch, False)
                if before and after:
                    profiles.append((model, before, after))
        parts = (speed_parts.measure(arguments.bench.resolve(), arguments.repetitions)
                 if arguments.bench else {})
        runs: list[Run] = []
        phases: list[Phases] = []
        for model in models:
            runs += measure(arguments.program.resolve(), model, commands, works,
                            arguments.repetitions, scratch)
            phases += measure_phases(arguments.program.resolve(), model, arguments.repetitions)
            # After every model, so that a long run that is ended leaves a page of what it has seen.
            write_page(arguments.out, runs,
                       page(runs, phases, parts, missing, works, arguments.repetitions, profiles,
                            load, commit))
    print(arguments.out / "README.md")


if __name__ == "__main__":
    main()
