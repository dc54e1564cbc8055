"""Statistics of paired comparisons; pure functions of numbers.

A pair is one model: what a contender and its rival scored there. Models are the sample; seeds and
repetitions are nested in them.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from .distributions import (
    chi_squared_tail,
    normal_cdf,
    student_quantile,
    studentized_range_quantile,
)

CONFIDENCE = 0.95
LEVEL = 0.05
"""From which p-value on a difference may be chance."""

_DRAWS = 4000
_INNER_DRAWS = 200
_MOST_EXACT = 50
"""Pairs up to which the distribution of signed ranks is counted out."""

Samples = Sequence[Sequence[float]]
"""Repetitions by seed."""


@dataclass(frozen=True)
class Interval:
    """From where to where a figure lies with the confidence of this module."""

    low: float
    high: float


@dataclass(frozen=True)
class Friedman:
    """Whether any of several contenders differ in rank, and by how much they must."""

    models: int
    mean_ranks: list[float]
    """1 is the best; ties share their mean."""
    chi_squared: float
    p: float
    critical_difference: float
    """Of two mean ranks, by Nemenyi."""


def geometric_mean(ratios: Sequence[float]) -> float:
    """Of positive numbers."""
    return math.exp(math.fsum(map(math.log, ratios)) / len(ratios))


def median_interval(ratios: Sequence[float], seed: int = 1) -> Interval:
    """Bootstrap interval of the median, one ratio a model.

    The percentiles are expanded for small samples, without which the interval is too short. The
    same for equal input. Fewer than six numbers cannot carry 95 %: the interval then reaches at
    most from the smallest to the largest and covers less (1 - 2^(1-n) of the cases).

    Source: T. C. Hesterberg, What teachers should know about the bootstrap, 2015 (expanded
    percentiles).
    """
    return _percentiles(np.asarray(ratios, dtype=float)[:, None], seed)


def nested_median_interval(
    pairs: Sequence[tuple[Samples, Samples]], shift: float = 0.0, seed: int = 1
) -> Interval:
    """The same where each side of a pair has repetitions, which are drawn anew as well.

    A model's ratio is that of the medians, each with `shift` added.
    """
    generator = np.random.default_rng([seed, len(pairs)])
    pools = []
    for own, base in pairs:
        top, bottom = _redrawn_medians(own, generator), _redrawn_medians(base, generator)
        pools.append((top + shift) / (bottom + shift))
    return _percentiles(np.array(pools), seed)


def _redrawn_medians(samples: Samples, generator: np.random.Generator) -> np.ndarray:
    """Medians over drawn seeds of drawn repetitions."""
    if sum(map(len, samples)) == 1:
        return np.full(_INNER_DRAWS, samples[0][0], dtype=float)
    medians = np.array(
        [
            np.median(generator.choice(np.asarray(one, dtype=float), (_INNER_DRAWS, len(one))), 1)
            for one in samples
        ]
    )
    if len(medians) == 1:
        return medians[0]
    drawn = generator.integers(len(medians), size=(len(medians), _INNER_DRAWS))
    return np.median(medians[drawn, np.arange(_INNER_DRAWS)], axis=0)


def _percentiles(pools: np.ndarray, seed: int) -> Interval:
    """`pools`: a row for each model, a column for each of its possible ratios."""
    models, inner = pools.shape
    generator = np.random.default_rng(seed)
    chosen = generator.integers(models, size=(_DRAWS, models))
    column = generator.integers(inner, size=(_DRAWS, models)) if inner > 1 else 0
    medians = np.median(pools[chosen, column], axis=1)
    if models > 1:
        quantile = student_quantile((1 + CONFIDENCE) / 2, models - 1)
        edge = 100 * normal_cdf(-math.sqrt(models / (models - 1)) * quantile)
    else:
        edge = 50 * (1 - CONFIDENCE)
    low, high = np.percentile(medians, [edge, 100 - edge])
    return Interval(float(low), float(high))


def mean_ranks(values: Sequence[float]) -> list[float]:
    """The rank of each value, 1 for the lowest; equal ones share their mean."""
    order = sorted(values)
    first = {value: place for place, value in reversed(list(enumerate(order, start=1)))}
    count = {value: order.count(value) for value in first}
    return [first[value] + (count[value] - 1) / 2 for value in values]


def signed_rank_p(differences: Sequence[float]) -> float:
    """Two-sided p-value of Wilcoxon's signed-rank test.

    Zeros are dropped, as Wilcoxon does; ties share their mean rank. Up to 50 differences the
    distribution is counted out for the ranks at hand, ties or not; beyond that it is the normal
    approximation with its variance corrected for ties. Nothing but zeros gives 1.
    """
    left = [d for d in differences if d != 0]
    if not left:
        return 1.0
    ranks = mean_ranks([abs(d) for d in left])
    positive = math.fsum(rank for rank, d in zip(ranks, left) if d > 0)
    if len(left) <= _MOST_EXACT:
        return _exact_p([round(2 * rank) for rank in ranks], round(2 * positive))
    n = len(left)
    ties = math.fsum(count**3 - count for count in map(ranks.count, set(ranks)))
    variance = n * (n + 1) * (2 * n + 1) / 24 - ties / 48
    z = (positive - n * (n + 1) / 4) / math.sqrt(variance)
    return min(1.0, 2 * normal_cdf(-abs(z)))


def _exact_p(doubled_ranks: Sequence[int], doubled_sum: int) -> float:
    """Counts the sign patterns whose sum is as far from the middle."""
    # At most 2^50 patterns, so that 64 bits hold every count.
    ways = np.zeros(sum(doubled_ranks) + 1, dtype=np.int64)
    ways[0] = 1
    for rank in doubled_ranks:
        ways[rank:] += ways[:-rank].copy()
    tail = min(doubled_sum, len(ways) - 1 - doubled_sum)
    return min(1.0, 2 * int(ways[: tail + 1].sum()) / 2 ** len(doubled_ranks))


def holm(p_values: Sequence[float]) -> list[float]:
    """The p-values corrected for being several, by Holm's step-down method."""
    adjusted = [0.0] * len(p_values)
    highest = 0.0
    order = sorted(range(len(p_values)), key=lambda place: p_values[place])
    for done, place in enumerate(order):
        highest = max(highest, min(1.0, (len(order) - done) * p_values[place]))
        adjusted[place] = highest
    return adjusted


def friedman(rows: Sequence[Sequence[float]]) -> Friedman | None:
    """Friedman's test with Nemenyi's critical difference.

    Takes a row for each model with a number for each contender, the lower the better. None for
    fewer than two models or contenders. The p-value is that of the chi-squared approximation,
    corrected for ties; the critical difference rests on the studentized range at level 0.05.

    Source: J. Demšar, Statistical comparisons of classifiers over multiple data sets, 2006.
    """
    models = len(rows)
    contenders = len(rows[0]) if rows else 0
    if models < 2 or contenders < 2:
        return None
    ranks = [mean_ranks(row) for row in rows]
    means = [math.fsum(column) / models for column in zip(*ranks)]
    middle = (contenders + 1) / 2
    between = models * math.fsum((mean - middle) ** 2 for mean in means)
    within = math.fsum((rank - middle) ** 2 for row in ranks for rank in row)
    # Without ties `within` is models * k (k^2 - 1) / 12, which gives the usual formula.
    statistic = models * (contenders - 1) * between / within if within else 0.0
    return Friedman(
        models,
        means,
        statistic,
        chi_squared_tail(statistic, contenders - 1),
        critical_difference(contenders, models),
    )


def critical_difference(contenders: int, models: int) -> float:
    """What two mean ranks must differ by at level 0.05, by Nemenyi."""
    quantile = studentized_range_quantile(1 - LEVEL, contenders) / math.sqrt(2)
    return quantile * math.sqrt(contenders * (contenders + 1) / (6 * models))


def alike(mean: Sequence[float], difference: float) -> list[tuple[int, int]]:
    """Longest groups of mean ranks within the difference; places of their first and last.

    Takes the ranks in rising order. A group within another, or of one alone, is not given.
    """
    groups: list[tuple[int, int]] = []
    for first in range(len(mean)):
        last = max(p for p in range(first, len(mean)) if mean[p] - mean[first] <= difference)
        if last > first and (not groups or last > groups[-1][1]):
            groups.append((first, last))
    return groups


def performance_ratios(
    costs: Mapping[int, Sequence[float | None]], shift: float = 0.0
) -> dict[int, list[float]]:
    """Every contender's cost over the least cost of the same model; failures are infinite.

    Takes for each contender a cost for each model, None where it failed.

    Source: E. D. Dolan, J. J. Moré, Benchmarking optimization software with performance profiles,
    2002.
    """
    best = [
        min((cost for cost in column if cost is not None), default=None)
        for column in zip(*costs.values())
    ]
    return {
        contender: [
            math.inf if cost is None or least is None else (cost + shift) / (least + shift)
            for cost, least in zip(row, best)
        ]
        for contender, row in costs.items()
    }


def profile(ratios: Sequence[float], factor: float) -> float:
    """Share of the models on which the cost is at most `factor` times the least."""
    return sum(ratio <= factor for ratio in ratios) / len(ratios)

