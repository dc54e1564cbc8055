"""Quantiles and tails of the distributions that the tests need."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache

import numpy as np

_STEP = 1 / 64
"""Of the trapezium rule, which is exact to the last digits for such smooth functions."""
_TAIL = 9.0
"""Beyond so many standard deviations the normal density is nothing."""


def normal_cdf(z: float) -> float:
    """Share of the standard normal distribution below z."""
    return 0.5 * math.erfc(-z / math.sqrt(2))


def chi_squared_tail(x: float, freedom: int) -> float:
    """Share of the chi-squared distribution above x.

    Source: the closed forms of the regularised incomplete gamma function for whole and half
    parameters (Abramowitz and Stegun 1964, 26.4.4 and 26.4.5).
    """
    if x <= 0:
        return 1.0
    half = x / 2
    if freedom % 2:
        tail = math.erfc(math.sqrt(half))
        term = math.exp(-half) * math.sqrt(half) / math.gamma(1.5)
        start = 1.5
    else:
        tail = 0.0
        term = math.exp(-half)
        start = 1.0
    for step in range(freedom // 2):
        tail += term
        term *= half / (start + step)
    return min(1.0, tail)


def student_cdf(t: float, freedom: int) -> float:
    """Share of Student's distribution below t.

    Source: the closed forms for whole degrees of freedom (Abramowitz and Stegun 1964, 26.7.3 and
    26.7.4).
    """
    angle = math.atan(t / math.sqrt(freedom))
    sine, cosine_squared = math.sin(angle), math.cos(angle) ** 2
    total, term = 0.0, 1.0
    start = 1 + freedom % 2
    for step in range(start, freedom, 2):
        total += term
        term *= cosine_squared * step / (step + 1)
    if freedom % 2 == 0:
        return 0.5 + sine * total / 2
    return 0.5 + (angle + sine * math.cos(angle) * total) / math.pi


@lru_cache(maxsize=None)
def student_quantile(share: float, freedom: int) -> float:
    """The t below which the given share, at least a half, of Student's distribution lies."""
    return _quantile(lambda t: student_cdf(t, freedom), share)


def studentized_range_cdf(q: float, groups: int) -> float:
    """Probability that the range of so many standard normal numbers is at most q.

    That is the studentized range with infinitely many degrees of freedom, by numerical integration
    over the smallest of the numbers.
    """
    if q <= 0:
        return 0.0
    low = np.arange(-_TAIL - q, _TAIL, _STEP)
    density = np.exp(-(low**2) / 2) / math.sqrt(2 * math.pi)
    below = _normal_cdf(low)
    within = _normal_cdf(low + q) - below
    return float(groups * np.sum(density * within ** (groups - 1)) * _STEP)


@lru_cache(maxsize=None)
def studentized_range_quantile(share: float, groups: int) -> float:
    """The q up to which the given share of the ranges lies; for any number of groups above 1."""
    if not 0 < share < 1 or groups < 2:
        raise ValueError(f"no quantile {share} of the range of {groups}")
    return _quantile(lambda q: studentized_range_cdf(q, groups), share)


def _quantile(cdf: Callable[[float], float], share: float) -> float:
    """Where a distribution function reaches the share, from zero on, by bisection."""
    low, high = 0.0, 2.0
    while cdf(high) < share:
        high *= 2
    while high - low > 1e-12 * high:
        middle = (low + high) / 2
        if cdf(middle) < share:
            low = middle
        else:
            high = middle
    return (low + high) / 2


_normal_cdf = np.vectorize(normal_cdf, otypes=[float])
