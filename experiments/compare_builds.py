#!/usr/bin/env python3
"""Compares two builds of a benchmark program in one interleaved run.

    experiments/compare_builds.py BEFORE AFTER [--filter REGEX] [--rounds N] [--min-time S]
                                  [--json FILE]

BEFORE and AFTER are two routebench-bench programs. Every round runs both, in random order, so that
what else the machine does falls upon both alike. For each benchmark the table tells the ratio of
the median CPU times (below 1: AFTER is faster) with a 95 % interval by bootstrap, how likely such a
difference is by chance (Mann-Whitney U, two-sided, corrected by Holm for the number of benchmarks),
and the verdict: faster or slower where the interval does not hold 1 and that chance is below 5 %.
Benchmarks that only one of the programs has are named. Needs numpy and scipy.
"""

from __future__ import annotations

import argparse
import json
import random
import subprocess
import sys
from collections import defaultdict
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from scipy import stats

from routebench_plots.inference import holm

BOOTSTRAP_SAMPLES = 4000
SIGNIFICANCE = 0.05
Times = dict[str, list[float]]
"""CPU times of each benchmark, ns, one a round."""


def fail(message: str) -> None:
    """Ends the program as one that was used wrongly."""
    print(f"compare_builds: {message}", file=sys.stderr)
    sys.exit(2)


def one_run(program: Path, options: Sequence[str]) -> dict[str, float]:
    """CPU time of each benchmark, ns."""
    try:
        run = subprocess.run([program, *options, "--benchmark_format=json"],
                             stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
    except OSError as error:
        fail(f"{program} cannot be run: {error.strerror}")
    if run.returncode != 0:
        words = run.stderr.decode(errors="replace").strip().splitlines()
        fail(f"{program} ended with exit code {run.returncode}: {words[-1] if words else ''}")
    if not run.stdout.strip():
        return {}  # no benchmark matches
    scale = {"ns": 1.0, "us": 1e3, "ms": 1e6, "s": 1e9}
    times = {}
    for entry in json.loads(run.stdout)["benchmarks"]:
        if entry.get("error_occurred"):
            fail(f"{program}: {entry['name']}: {entry['error_message']}")
        if entry.get("run_type", "iteration") == "iteration":
            times[entry["name"]] = entry["cpu_time"] * scale[entry["time_unit"]]
    return times


def ratio_of_medians(before: np.ndarray, after: np.ndarray) -> dict[str, float | str]:
    """Ratio with its interval, and the U test's probability."""
    rng = np.random.default_rng(1)

    def resampled(values: np.ndarray) -> np.ndarray:
        return np.median(rng.choice(values, (BOOTSTRAP_SAMPLES, len(values))), axis=1)

    low, high = np.percentile(resampled(after) / resampled(before), [2.5, 97.5])
    return {"before_ns": float(np.median(before)), "after_ns": float(np.median(after)),
            "ratio": float(np.median(after) / np.median(before)),
            "low": float(low), "high": float(high),
            "p": float(stats.mannwhitneyu(before, after).pvalue)}


def measure(before: Path, after: Path, options: Sequence[str], rounds: int,
            tell: Callable[[str], None]) -> tuple[Times, Times]:
    """What each program says, both in every round."""
    times: tuple[Times, Times] = (defaultdict(list), defaultdict(list))
    order = random.Random(1)
    for number in range(rounds):
        tell(f"round {number + 1} of {rounds}")
        for which in order.sample((0, 1), 2):
            for name, value in one_run((before, after)[which], options).items():
                times[which][name].append(value)
    return times


def compare(before: Times, after: Times) -> dict[str, dict[str, float | str]]:
    """All benchmarks that both programs have, with a verdict each."""
    rows = {name: ratio_of_medians(np.array(before[name]), np.array(after[name]))
            for name in before if name in after}
    for row, chance in zip(rows.values(), holm([row["p"] for row in rows.values()])):
        row["p"] = chance
        differs = chance < SIGNIFICANCE and not row["low"] <= 1 <= row["high"]
        row["verdict"] = ("faster" if row["ratio"] < 1 else "slower") if differs else "none"
    return rows


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("before", type=Path)
    parser.add_argument("after", type=Path)
    parser.add_argument("--filter", default=".", help="of benchmarks, a regular expression")
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--min-time", type=float, default=0.5,
                        help="seconds that a benchmark is repeated for in a round, at least")
    parser.add_argument("--json", type=Path, help="write the figures there, too")
    arguments = parser.parse_args()
    before, after = arguments.before.resolve(), arguments.after.resolve()
    if before == after:
        parser.error("BEFORE and AFTER are one program")
    for program in (before, after):
        if not program.is_file():
            parser.error(f"{program}: no such program; build it with cmake --build --preset bench")
    if arguments.rounds < 2:
        parser.error("--rounds must be at least 2")
    options = [f"--benchmark_filter={arguments.filter}",
               f"--benchmark_min_time={arguments.min_time}"]
    old, new = measure(before, after, options, arguments.rounds,
                       lambda text: print(text, file=sys.stderr, flush=True))
    for name in sorted(old.keys() ^ new.keys()):
        print(f"only {before if name in old else after} has {name}", file=sys.stderr)
    result = compare(old, new)
    if not result:
        fail(f"no benchmark of both programs matches '{arguments.filter}'")
    width = max(map(len, result))
    print(f"{'benchmark':{width}}  before us   after us  ratio  95 % interval      p  difference")
    for name, row in result.items():
        print(f"{name:{width}} {row['before_ns'] / 1e3:10.2f} {row['after_ns'] / 1e3:10.2f} "
              f"{row['ratio']:6.3f}  {row['low']:.3f} to {row['high']:.3f} {row['p']:6.3f}  "
              f"{row['verdict']}")
    if arguments.json:
        arguments.json.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
