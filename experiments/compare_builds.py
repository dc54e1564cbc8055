#!/usr/bin/env python3
"""Compares two builds of a benchmark program in one interleaved run.

    experiments/compare_builds.py BEFORE AFTER [--filter REGEX] [--rounds N] [--json FILE]

BEFORE and AFTER are two routebench-bench programs. Every round runs both, in random order, so that
what else the machine does falls upon both alike. For each benchmark the table tells the ratio of
the median CPU times (below 1: AFTER is faster) with a 95 % interval by bootstrap, and how likely
such a difference is by chance (Mann-Whitney U, two-sided). Differences whose interval holds 1 are
none. Needs numpy and scipy.
"""

from __future__ import annotations

import argparse
import json
import random
import subprocess
import sys
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path

import numpy as np
from scipy import stats

BOOTSTRAP_SAMPLES = 4000


def one_run(program: Path, pattern: str) -> dict[str, float]:
    """CPU time of each benchmark, ns."""
    run = subprocess.run(
        [program, f"--benchmark_filter={pattern}", "--benchmark_format=json"],
        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=False)
    if run.returncode != 0:
        sys.exit(f"compare_builds: {program} ended with exit code {run.returncode}")
    scale = {"ns": 1.0, "us": 1e3, "ms": 1e6, "s": 1e9}
    return {entry["name"]: entry["cpu_time"] * scale[entry["time_unit"]]
            for entry in json.loads(run.stdout)["benchmarks"]
            if entry.get("run_type", "iteration") == "iteration"}


def ratio_of_medians(before: np.ndarray, after: np.ndarray) -> dict[str, float]:
    """Ratio with its interval, and the U test's probability."""
    rng = np.random.default_rng(1)

    def resampled(values: np.ndarray) -> np.ndarray:
        return np.median(rng.choice(values, (BOOTSTRAP_SAMPLES, len(values))), axis=1)

    low, high = np.percentile(resampled(after) / resampled(before), [2.5, 97.5])
    return {"before_ns": float(np.median(before)), "after_ns": float(np.median(after)),
            "ratio": float(np.median(after) / np.median(before)),
            "low": float(low), "high": float(high),
            "p": float(stats.mannwhitneyu(before, after).pvalue)}


def compare(before: Path, after: Path, pattern: str, rounds: int,
            tell: Callable[[str], None]) -> dict[str, dict[str, float]]:
    """All benchmarks that both programs have."""
    times: dict[Path, dict[str, list[float]]] = {p: defaultdict(list) for p in (before, after)}
    order = random.Random(1)
    for number in range(rounds):
        tell(f"round {number + 1} of {rounds}")
        for program in order.sample([before, after], 2):
            for name, value in one_run(program, pattern).items():
                times[program][name].append(value)
    return {name: ratio_of_medians(np.array(times[before][name]), np.array(times[after][name]))
            for name in times[before] if name in times[after]}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("before", type=Path)
    parser.add_argument("after", type=Path)
    parser.add_argument("--filter", default=".", help="of benchmarks, a regular expression")
    parser.add_argument("--rounds", type=int, default=9)
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
    result = compare(before, after, arguments.filter, arguments.rounds,
                     lambda text: print(text, file=sys.stderr, flush=True))
    if not result:
        sys.exit(f"compare_builds: no benchmark of both programs matches '{arguments.filter}'")
    width = max(map(len, result))
    print(f"{'benchmark':{width}}  before us   after us  ratio  95 % interval      p")
    for name, row in result.items():
        print(f"{name:{width}} {row['before_ns'] / 1e3:10.2f} {row['after_ns'] / 1e3:10.2f} "
              f"{row['ratio']:6.3f}  {row['low']:.3f} to {row['high']:.3f} {row['p']:6.3f}")
    if arguments.json:
        arguments.json.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
