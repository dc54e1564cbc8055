"""Pairs the cells of two results and judges every metric of every contender."""

from __future__ import annotations

import math
import statistics
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from routebench_plots.errors import PlotError
from routebench_plots.inference import Interval, geometric_mean, nested_median_interval
from routebench_plots.results import VALID, Cell, Item, Metric, Results, Slot

from .limits import Limits, is_noisy, is_share

NOT_INSTALLED = "not_installed"
"""An outcome that says something about the machine, not about the contender."""

FEWEST_REPETITIONS = 3
"""Of either side, for a cell's time to count on its own."""
LEAST_TIME_NS = 1e6
"""Times below are too short to count on their own."""


@dataclass(frozen=True)
class Place:
    """Where a cell stands, by names, which are what two databases share."""

    setting: str
    contender: str
    model: str
    seed: int


@dataclass(frozen=True)
class Pair:
    """A cell of the old results and the same of the new."""

    place: Place
    old: Cell
    new: Cell


@dataclass(frozen=True)
class Change:
    """A metric of one cell."""

    place: Place
    old: float
    new: float
    worsening: float
    """Share of the old value, or difference of shares; negative where it became better."""


@dataclass(frozen=True)
class Verdict:
    """A metric of one contender under one setting."""

    setting: str
    contender: str
    metric: Metric
    changes: list[Change]
    """Of all pairs that are valid on both sides and have the metric."""
    limit: float
    over: list[Change]
    """Cells that are worse by more than the limit; of times, beyond any noise."""
    ratio: float | None
    """Geometric mean of new over old; None for shares and where a value is 0."""
    interval: Interval | None
    """Of the median ratio of times."""

    @property
    def is_regression(self) -> bool:
        """Whether this alone fails the gate."""
        slower = self.interval is not None and self.interval.low > 1 + self.limit
        return bool(self.over) or slower

    @property
    def worse(self) -> int:
        """Cells that became worse at all."""
        return sum(change.worsening > 0 for change in self.changes)

    @property
    def better(self) -> int:
        """Cells that became better at all."""
        return sum(change.worsening < 0 for change in self.changes)


@dataclass(frozen=True)
class Comparison:
    """All that differs between two results of one experiment."""

    paired: int
    lost: list[Pair]
    """Valid before and not any more."""
    won: list[Pair]
    """Valid now and not before."""
    otherwise: list[Pair]
    """Not valid before nor now, in another way."""
    missing: list[Place]
    """Cells of the old results that the new ones lack."""
    added: list[Place]
    """The reverse."""
    verdicts: list[Verdict]
    notes: list[str] = field(default_factory=list)


def compare(
    old: Results, new: Results, metrics: Sequence[Metric], limits: Limits, times: str
) -> Comparison:
    """Compares cell by cell.

    `times` is auto (only if both ran on one kind of processor), always or never.
    """
    _check_alike(old, new)
    meshes = _meshes(old, {})
    names = _names_before(meshes, _meshes(new, {}))
    before, after = _cells(old, {}), _cells(new, names)
    pairs = [Pair(place, before[place], after[place]) for place in before if place in after]
    missing = [place for place in before if place not in after]
    notes = []
    changed = {
        label
        for label, hashes in _meshes(new, names).items()
        if label in meshes and meshes[label] != hashes
    }
    if changed:
        notes.append(f"not compared, for the model itself differs: {', '.join(sorted(changed))}")
        pairs = [pair for pair in pairs if pair.place.model not in changed]
    if not pairs:
        raise PlotError(
            f"{new.database}: no cell of {old.database} is in it; a gate compares two results of "
            "one experiment"
        )
    timed = _compares_times(old, new, times, notes)
    valid = [p for p in pairs if p.old.outcome == VALID and p.new.outcome == VALID]
    return Comparison(
        paired=len(pairs),
        lost=[p for p in pairs if p.old.outcome == VALID != p.new.outcome],
        won=[p for p in pairs if p.new.outcome == VALID != p.old.outcome],
        otherwise=[p for p in pairs if VALID not in (p.old.outcome, p.new.outcome) and _differ(p)],
        missing=missing,
        added=[place for place in after if place not in before],
        verdicts=[
            verdict
            for metric in metrics
            if timed or not is_noisy(metric)
            for verdict in _verdicts(old, new, valid, metric, limits)
        ],
        notes=notes,
    )


def _differ(pair: Pair) -> bool:
    return pair.old.outcome != pair.new.outcome


def _cells(results: Results, names: Mapping[str, str]) -> dict[Place, Cell]:
    """By place; `names` are those of models that are to be called otherwise."""
    return {
        Place(
            setting.label, contender.label, names.get(model.label, model.label), cell.seed
        ): cell
        for setting, model, contender in _slots(results)
        for cell in results.slot(setting, model, contender).cells
        if cell.outcome != NOT_INSTALLED
    }


def _slots(results: Results) -> Iterator[tuple[Item, Item, Item]]:
    for setting in results.settings:
        for contender in results.contenders:
            for model in results.models:
                yield setting, model, contender


def _check_alike(old: Results, new: Results) -> None:
    """Refuses what cannot be compared: another experiment, or other demands of the same name."""
    if old.experiment != new.experiment:
        raise PlotError(
            f"{new.database}: holds the experiment '{new.experiment}', but {old.database} "
            f"'{old.experiment}'; a gate compares two results of one experiment"
        )
    theirs = {setting.label: setting for setting in old.settings}
    for setting in new.settings:
        if setting.label not in theirs:
            continue
        before = theirs[setting.label]
        for table, was, now in (
            ("task", old.task(before), new.task(setting)),
            ("printer", old.printer(before), new.printer(setting)),
        ):
            for key in was.keys() & now.keys():
                if was[key] != now[key]:
                    raise PlotError(
                        f"{new.database}: [{table}] {key} is {now[key]}, but {was[key]} in "
                        f"{old.database}; a gate compares results of equal settings"
                    )


def _meshes(results: Results, names: Mapping[str, str]) -> dict[str, set[str]]:
    """The hashes of each model's mesh, by the model's name."""
    found: dict[str, set[str]] = defaultdict(set)
    for setting in results.settings:
        for model in results.models:
            found[names.get(model.label, model.label)].add(results.mesh_hash(setting, model))
    return {label: hashes - {""} for label, hashes in found.items()}


def _names_before(
    before: Mapping[str, set[str]], after: Mapping[str, set[str]]
) -> dict[str, str]:
    """What models were called whose names are new: a name is as short as tells the models of one
    experiment apart, so another model may make it longer. Their meshes tell which they are, where
    no two have the same."""

    def only_here(here: Mapping[str, set[str]], there: Mapping[str, set[str]]) -> dict[str, str]:
        by_mesh: dict[str, list[str]] = defaultdict(list)
        for label, hashes in here.items():
            if label not in there and len(hashes) == 1:
                by_mesh[min(hashes)].append(label)
        return {mesh: labels[0] for mesh, labels in by_mesh.items() if len(labels) == 1}

    old, new = only_here(before, after), only_here(after, before)
    return {new[mesh]: old[mesh] for mesh in old.keys() & new.keys()}


def _compares_times(old: Results, new: Results, times: str, notes: list[str]) -> bool:
    was, now = (results.last_run().get("cpu") for results in (old, new))
    if times == "auto" and was != now:
        notes.append(
            f"times not compared, for the processors differ: {was}, {now} (`--times always` "
            "compares them all the same)"
        )
        return False
    return times != "never"


def _verdicts(
    old: Results, new: Results, valid: Sequence[Pair], metric: Metric, limits: Limits
) -> list[Verdict]:
    groups: dict[tuple[str, str], list[Pair]] = defaultdict(list)
    for pair in valid:
        groups[pair.place.setting, pair.place.contender].append(pair)
    found = []
    for (setting, contender), pairs in groups.items():
        changes = []
        samples = []
        over = []
        for pair in pairs:
            was, now = Slot((pair.old,)), Slot((pair.new,))
            before, after = old.value(was, metric), new.value(now, metric)
            if before is None or after is None:
                continue
            change = Change(
                pair.place,
                before.median,
                after.median,
                _worsening(metric, before.median, after.median),
            )
            changes.append(change)
            if is_noisy(metric):
                samples.append((new.samples(now, metric), old.samples(was, metric)))
                if _is_beyond_noise(samples[-1], limits.of(metric), metric):
                    over.append(change)
            elif change.worsening > limits.of(metric):
                over.append(change)
        if changes:
            found.append(
                Verdict(
                    setting=setting,
                    contender=contender,
                    metric=metric,
                    changes=changes,
                    limit=limits.of(metric),
                    over=over,
                    ratio=_ratio(metric, changes),
                    interval=nested_median_interval(samples) if _positive(samples) else None,
                )
            )
    return found


def _worsening(metric: Metric, old: float, new: float) -> float:
    step = new - old if metric.better == "lower" else old - new
    if step == 0 or is_share(metric):
        return step
    return step / abs(old) if old else math.copysign(math.inf, step)


def _ratio(metric: Metric, changes: Sequence[Change]) -> float | None:
    if is_share(metric) or any(c.old <= 0 or c.new <= 0 for c in changes):
        return None
    return geometric_mean([c.new / c.old for c in changes])


Samples = list[list[float]]


def _positive(samples: Sequence[tuple[Samples, Samples]]) -> bool:
    """Whether there are any, none of them zero."""
    return bool(samples) and all(v > 0 for pair in samples for one in pair for s in one for v in s)


def _is_beyond_noise(pair: tuple[Samples, Samples], limit: float, metric: Metric) -> bool:
    """Whether every new repetition is far above every old one.

    A single cell's time wobbles more than a median over cells, so that it must go over the limit
    twice.
    """
    new, old = ([value for one in side for value in one] for side in pair)
    if min(len(new), len(old)) < FEWEST_REPETITIONS:
        return False
    if metric.unit == "ns" and statistics.median(new) < LEAST_TIME_NS:
        return False
    return min(new) > max(old) * (1 + limit) ** 2
