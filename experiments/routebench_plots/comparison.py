"""Compares contenders pairwise, model by model, with the statistics that such claims need.

Only models on which both are valid count. Totals are exact, so that every difference is real and
only the choice of models is chance; times also carry noise, so that they must differ by more than
equal programs do before they count as different.
"""

from __future__ import annotations

import itertools
import math
import statistics
from collections.abc import Sequence
from dataclasses import dataclass

from .inference import (
    LEVEL,
    Friedman,
    Interval,
    friedman,
    geometric_mean,
    holm,
    median_interval,
    nested_median_interval,
    signed_rank_p,
)
from .results import TIMED_METRICS, Item, Metric, Results

COMPARED = (
    "travel_mm",
    "retractions",
    "strokes",
    "print_time_s",
    "plan_cpu_ns",
)
"""Metrics of comparisons; all of them are better when lower."""

SHIFT = 1.0
"""Added to both sides of a ratio: nothing at all is good, not infinitely so.

One millimetre, stroke, retraction, second or nanosecond.
"""

TIME_MARGIN = 0.05
"""Times whose medians differ by less are called equal.

Equal code measured twice on one machine differs by a few percent as a rule.
"""


@dataclass(frozen=True)
class Comparison:
    """One metric of a contender against a rival."""

    ratio: float
    """Geometric mean over the shared models."""
    median: float
    interval: Interval
    """Of the median, by bootstrap over the models."""
    worse: int
    shared: int
    p: float
    """Wilcoxon's signed-rank test, corrected by Holm for all pairs of contenders."""
    differs: bool
    """Whether that is a difference, and for times one that is worth the name."""


@dataclass(frozen=True)
class Ranking:
    """Mean ranks of the contenders on the models that all of them do."""

    contenders: list[Item]
    left_out: list[Item]
    """Valid on fewer than half of the models, or nowhere."""
    models: list[Item]
    test: Friedman


Values = dict[tuple[int, int], float]
"""By contender and model."""


class Comparisons:
    """All pairs of contenders on one metric under one setting."""

    def __init__(self, results: Results, setting: Item, metric: Metric) -> None:
        self.metric = metric
        self._results = results
        self._setting = setting
        self.values: Values = {}
        for contender in results.contenders:
            for model in results.models:
                slot = results.slot(setting, model, contender)
                value = results.value(slot, metric)
                if value is not None:
                    self.values[contender.row_id, model.row_id] = value.median
        self._p = self._corrected()

    def shared(self, *contenders: Item) -> list[Item]:
        """The models on which all of these are valid."""
        return [
            model
            for model in self._results.models
            if all((c.row_id, model.row_id) in self.values for c in contenders)
        ]

    def ratios(self, contender: Item, rival: Item) -> list[float]:
        """One for each shared model."""
        return [
            (self.values[contender.row_id, model.row_id] + SHIFT)
            / (self.values[rival.row_id, model.row_id] + SHIFT)
            for model in self.shared(contender, rival)
        ]

    def p(self, contender: Item, rival: Item) -> float:
        """The corrected p-value of a pair; 1 for a contender and itself."""
        return self._p.get(frozenset((contender.row_id, rival.row_id)), 1.0)

    def compare(self, contender: Item, rival: Item) -> Comparison | None:
        """The contender against the rival; None if they share no model."""
        ratios = self.ratios(contender, rival)
        if not ratios:
            return None
        middle = statistics.median(ratios)
        worse = sum(
            self._worse(contender, rival, model) for model in self.shared(contender, rival)
        )
        return Comparison(
            ratio=geometric_mean(ratios),
            median=middle,
            interval=self._interval(contender, rival, ratios),
            worse=worse,
            shared=len(ratios),
            p=self.p(contender, rival),
            differs=self.differs(contender, rival),
        )

    def differs(self, contender: Item, rival: Item) -> bool:
        """Whether the pair is told apart."""
        if self.p(contender, rival) >= LEVEL:
            return False
        if self.metric.name not in TIMED_METRICS:
            return True
        middle = math.log(statistics.median(self.ratios(contender, rival)))
        return abs(middle) > math.log(1 + TIME_MARGIN)

    @property
    def pairs(self) -> int:
        """How many pairs of contenders share a model."""
        return len(self._p)

    @property
    def least_p(self) -> float:
        """The smallest corrected p-value that so many models and pairs can give."""
        models = max(
            (
                len(self.shared(one, other))
                for one, other in itertools.combinations(self._results.contenders, 2)
            ),
            default=0,
        )
        return min(1.0, self.pairs * 2.0 ** (1 - models))

    def not_told_apart(self) -> list[tuple[Item, Item]]:
        """Pairs that share models but do not differ."""
        return [
            (one, other)
            for one, other in itertools.combinations(self._results.contenders, 2)
            if self.shared(one, other) and not self.differs(one, other)
        ]

    def ranking(self) -> Ranking | None:
        """Friedman's test over all contenders; None where there is too little for one.

        A contender that is valid on fewer than half of the models would cost the others too many
        of theirs, and is left out.
        """
        models = self._results.models
        taking, left_out = [], []
        for contender in self._results.contenders:
            valid = len(self.shared(contender))
            (taking if valid and 2 * valid >= len(models) else left_out).append(contender)
        shared = self.shared(*taking) if taking else []
        sign = -1 if self.metric.better == "higher" else 1
        test = friedman(
            [[sign * self.values[c.row_id, m.row_id] for c in taking] for m in shared]
        )
        return None if test is None else Ranking(taking, left_out, shared, test)

    def _worse(self, contender: Item, rival: Item, model: Item) -> bool:
        own = self.values[contender.row_id, model.row_id]
        other = self.values[rival.row_id, model.row_id]
        return own < other if self.metric.better == "higher" else own > other

    def _interval(self, contender: Item, rival: Item, ratios: Sequence[float]) -> Interval:
        if contender.row_id == rival.row_id:
            return Interval(1.0, 1.0)
        pairs = []
        for model in self.shared(contender, rival):
            own, base = (
                self._results.samples(
                    self._results.slot(self._setting, model, item), self.metric
                )
                for item in (contender, rival)
            )
            pairs.append((own, base))
        if all(sum(map(len, side)) == 1 for pair in pairs for side in pair):
            return median_interval(ratios)
        return nested_median_interval(pairs, SHIFT)

    def _corrected(self) -> dict[frozenset[int], float]:
        """Holm's correction over all pairs that share a model."""
        pairs = {}
        for one, other in itertools.combinations(self._results.contenders, 2):
            ratios = self.ratios(one, other)
            if ratios:
                pairs[frozenset((one.row_id, other.row_id))] = signed_rank_p(
                    [math.log(ratio) for ratio in ratios]
                )
        return dict(zip(pairs, holm(list(pairs.values()))))


def compared_metrics(results: Results, metrics: Sequence[Metric] | None = None) -> list[Metric]:
    """Those of COMPARED that the database has and, if some are given, that are among these."""
    return [
        metric
        for name in COMPARED
        if (metric := results.metric(name)) is not None and (metrics is None or metric in metrics)
    ]


def baseline_of(results: Results, setting: Item, name: str | None) -> Item:
    """The contender of that name, or the one that is valid on most models, the first of several."""
    if name is not None:
        return next(c for c in results.contenders if c.label == name)
    return max(results.contenders, key=lambda c: valid_models(results, setting, c))


def valid_models(results: Results, setting: Item, contender: Item) -> int:
    """Models on which all of the contender's cells are valid."""
    slots = (results.slot(setting, model, contender) for model in results.models)
    return sum(bool(slot.cells) and len(slot.valid) == len(slot.cells) for slot in slots)
