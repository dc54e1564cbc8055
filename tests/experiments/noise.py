"""Noise of timings as public benchmark series show it, for the tests of statistics."""

from __future__ import annotations

import random


def noisy_times(rng: random.Random, true_ns: float, repetitions: int) -> list[int]:
    """Repetitions of one cell, measured in one go.

    Most measurements of equal code differ by a few percent; one in ten is off by a fifth to a
    quarter as a whole, one in a hundred by up to double; single repetitions scatter on top.
    """
    lot = rng.random()
    if lot < 0.01:
        whole = rng.uniform(1.3, 2.0)
    elif lot < 0.1:
        whole = rng.uniform(1.15, 1.3)
    else:
        whole = rng.lognormvariate(0, 0.02)
    return [
        max(1, int(true_ns * whole * rng.lognormvariate(0, 0.02))) for _ in range(repetitions)
    ]
