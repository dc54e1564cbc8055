"""A sweep of the printer's retraction policy: who retracts least, and where that flips."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, NullLocator

from .axis import axis_label, format_ticks, set_range
from .curves import curve
from .quantities import Scale, counted, format_number, scale_for, with_unit
from .results import Item, Metric, Results
from .sheet import MARGIN, LegendEntry, Sheet, even_columns
from .style import PAGE_WIDTH, TEXT_SIZE, looks
from .tally import Tally
from .text import wrapped

METRIC = "retractions"
_PREFIX = "retract_"
_AXIS = "retract_over_mm"
"""Runs along the figure if it is swept."""
_LOG_FROM = 8.0
"""Largest over smallest swept number from which on the axis is logarithmic."""
_LOG_TOTALS_FROM = 3.0
"""The same for the totals: where lines cross they have to be told apart."""
_MOST_COLUMNS = 3
_PANEL_HEIGHT = 2.4
_MOST_FLIPS = 8
_FLIP_COLOUR = "#F3E3B3"


@dataclass(frozen=True)
class Group:
    """Settings that differ in the key along the axis alone."""

    label: str
    """The other swept keys; empty if there are none."""
    values: list[object]
    """Of the key along the axis, rising if they are numbers."""
    settings: list[Item]
    """One for each of the values."""


@dataclass(frozen=True)
class Sweep:
    """All settings of an experiment, which differ in retract_* keys alone."""

    key: str
    """Along the axis."""
    numeric: bool
    groups: list[Group]
    contenders: list[Item]
    """Those compared."""
    left_out: list[Item]
    """Contenders that are valid on fewer than half of the models."""
    models: list[Item]
    """On which all contenders compared are valid under every setting."""
    totals: dict[tuple[int, int], float]
    """Retractions over these models, by setting and contender."""


@dataclass(frozen=True)
class Flip:
    """Two contenders change places between two neighbouring settings of a group."""

    group: Group
    before: int
    after: int
    """Places among the group's values."""
    loser: Item
    """Fewer retractions before, more after."""
    winner: Item


def find(results: Results) -> Sweep | None:
    """The sweep, if the settings are one of the retraction policy and nothing else."""
    swept = _swept_keys(results)
    metric = results.metric(METRIC)
    if not swept or metric is None:
        return None
    key = _axis_key(results, swept)
    numeric = _is_numeric(results, key)
    by_label: dict[str, list[tuple[object, Item]]] = {}
    for setting in results.settings:
        printer = results.printer(setting)
        label = ", ".join(f"{k}={_shown(printer[k])}" for k in swept if k != key)
        by_label.setdefault(label, []).append((printer[key], setting))
    groups = []
    for label, members in by_label.items():
        if numeric:
            members.sort(key=lambda member: float(str(member[0])))
        groups.append(Group(label, [v for v, _ in members], [s for _, s in members]))

    values = {
        (setting.row_id, model.row_id, contender.row_id): value.median
        for setting in results.settings
        for model in results.models
        for contender in results.contenders
        if (value := results.value(results.slot(setting, model, contender), metric)) is not None
    }
    done = {
        contender.row_id: [
            model
            for model in results.models
            if all((s.row_id, model.row_id, contender.row_id) in values for s in results.settings)
        ]
        for contender in results.contenders
    }
    compared = [
        c
        for c in results.contenders
        if done[c.row_id] and 2 * len(done[c.row_id]) >= len(results.models)
    ]
    models = [m for m in results.models if all(m in done[c.row_id] for c in compared)]
    totals = {
        (setting.row_id, contender.row_id): sum(
            values[setting.row_id, model.row_id, contender.row_id] for model in models
        )
        for setting in results.settings
        for contender in compared
    }
    left_out = [c for c in results.contenders if c not in compared]
    return Sweep(key, numeric, groups, compared, left_out, models if compared else [], totals)


def flips(sweep: Sweep) -> list[Flip]:
    """Where the order of two contenders turns round along the axis; ties turn nothing."""
    found = []
    for group in sweep.groups:
        for one, other in itertools.combinations(sweep.contenders, 2):
            last: tuple[int, bool] | None = None
            for place, setting in enumerate(group.settings):
                lead = (
                    sweep.totals[setting.row_id, one.row_id]
                    - sweep.totals[setting.row_id, other.row_id]
                )
                if lead == 0:
                    continue
                if last is not None and last[1] != (lead < 0):
                    loser, winner = (one, other) if last[1] else (other, one)
                    found.append(Flip(group, last[0], place, loser, winner))
                last = (place, lead < 0)
    return sorted(found, key=lambda flip: (sweep.groups.index(flip.group), flip.before))


def flips_between_groups(sweep: Sweep) -> list[tuple[Group, Group, Item, Item, list[object]]]:
    """Pairs of contenders whose order differs between two groups, and at which values."""
    found = []
    for first, second in itertools.combinations(sweep.groups, 2):
        shared = [v for v in first.values if v in second.values]
        for one, other in itertools.combinations(sweep.contenders, 2):
            places = []
            for value in shared:
                before, after = (
                    sweep.totals[group.settings[group.values.index(value)].row_id, one.row_id]
                    - sweep.totals[group.settings[group.values.index(value)].row_id, other.row_id]
                    for group in (first, second)
                )
                if before * after < 0:
                    places.append(value)
            if places:
                found.append((first, second, one, other, places))
    return found


def flip_text(sweep: Sweep, flip: Flip) -> str:
    """A flip as a sentence has it."""
    before, after = (_shown(flip.group.values[p]) for p in (flip.before, flip.after))
    where = f"{flip.group.label}: " if flip.group.label else ""
    return (
        f"{where}{flip.winner.label} overtakes {flip.loser.label} between "
        f"{sweep.key}={before} and {after}"
    )


def group_flip_text(
    sweep: Sweep, found: tuple[Group, Group, Item, Item, list[object]]
) -> str:
    """The same for a flip between groups."""
    first, second, one, other, values = found
    at = ", ".join(map(_shown, values))
    return (
        f"{one.label} and {other.label} change places between {first.label} and {second.label} "
        f"at {sweep.key}={at}"
    )


def ranked(sweep: Sweep, setting: Item) -> list[tuple[Item, float]]:
    """The contenders under a setting with their totals, the fewest retractions first."""
    return sorted(
        ((c, sweep.totals[setting.row_id, c.row_id]) for c in sweep.contenders),
        key=lambda entry: entry[1],
    )


def draw(results: Results, metric: Metric, sweep: Sweep, title: str) -> Sheet:
    """A panel for each group, a line for each contender, bands where the ranking flips."""
    found = flips(sweep)
    columns = even_columns(len(sweep.groups), _MOST_COLUMNS)
    rows = -(-len(sweep.groups) // columns)
    scale = scale_for(metric, sweep.totals.values())
    contender_looks = looks(results.contenders)
    width = PAGE_WIDTH if columns > 1 else 5.2
    sheet = Sheet(
        width=width,
        body_height=rows * _PANEL_HEIGHT,
        title=title,
        notes=_notes(results, sweep, found),
        legend=[
            LegendEntry(curve(contender_looks[c.row_id]), c.label) for c in sweep.contenders
        ],
    )
    panel_width = (width - 2 * MARGIN) / columns
    panels = sheet.row_by_row(len(sweep.groups), columns)
    everything = [scale(v) for v in sweep.totals.values()]
    for axes, group in zip(panels, sweep.groups):
        _set_key_axis(axes, sweep, group, panel_width)
        for flip in (f for f in found if f.group is group):
            axes.axvspan(
                _position(sweep, group, flip.before),
                _position(sweep, group, flip.after),
                color=_FLIP_COLOUR,
                linewidth=0,
                zorder=0,
            )
        for contender in sweep.contenders:
            line = _line(sweep, group, contender, scale, curve(contender_looks[contender.row_id]))
            axes.add_line(line)
        axes.grid(True)
        set_range(axes, "y", everything, _LOG_TOTALS_FROM)
        for flip in (f for f in found if f.group is group):
            _mark_crossing(axes, sweep, flip, scale)
        if group.label:
            axes.set_title(wrapped(group.label, panel_width - 0.6, TEXT_SIZE))
    for axes in panels[::columns]:
        axes.set_ylabel(axis_label(metric, scale, _PANEL_HEIGHT - 0.7))
    return sheet


def _line(
    sweep: Sweep, group: Group, contender: Item, scale: Scale, line: Line2D
) -> Line2D:
    line.set_data(
        [_position(sweep, group, place) for place in range(len(group.values))],
        [scale(sweep.totals[s.row_id, contender.row_id]) for s in group.settings],
    )
    return line


def _mark_crossing(axes: Axes, sweep: Sweep, flip: Flip, scale: Scale) -> None:
    """A ring where the two lines meet, on the axes as they are by now."""
    settings = flip.group.settings

    def point(place: int, contender: Item) -> tuple[float, float]:
        total = sweep.totals[settings[place].row_id, contender.row_id]
        return _position(sweep, flip.group, place), scale(total)

    if flip.after > flip.before + 1:
        meeting = point(flip.before + 1, flip.winner)  # a tie
    else:
        to_paper = axes.transScale
        (x0, one0), (x1, one1), (_, other0), (_, other1) = to_paper.transform(
            [
                point(place, contender)
                for contender in (flip.winner, flip.loser)
                for place in (flip.before, flip.after)
            ]
        )
        share = (one0 - other0) / ((one0 - other0) - (one1 - other1))
        on_paper = (x0 + share * (x1 - x0), one0 + share * (one1 - one0))
        meeting = to_paper.inverted().transform(on_paper)
    axes.plot(
        [meeting[0]],
        [meeting[1]],
        linestyle="none",
        marker="o",
        markersize=9,
        markerfacecolor="none",
        markeredgecolor="black",
        markeredgewidth=0.9,
        zorder=5,
        gid="flip",
    )


def _position(sweep: Sweep, group: Group, place: int) -> float:
    return float(str(group.values[place])) if sweep.numeric else float(place)


def _set_key_axis(axes: Axes, sweep: Sweep, group: Group, width: float) -> None:
    positions = [_position(sweep, group, place) for place in range(len(group.values))]
    low, high = min(positions), max(positions)
    if sweep.numeric and low > 0 and high >= _LOG_FROM * low:
        axes.set_xscale("log")
        axes.set_xlim(low / 1.25, high * 1.25)
    else:
        room = 0.08 * ((high - low) or 1.0)
        axes.set_xlim(low - room, high + room)
    axes.xaxis.set_major_locator(FixedLocator(positions))
    axes.xaxis.set_minor_locator(NullLocator())
    if sweep.numeric:
        format_ticks(axes.xaxis)
    else:
        step = (width - 0.6) / len(positions)
        axes.set_xticks(positions, [wrapped(_shown(v), step, TEXT_SIZE) for v in group.values])
    name, _, unit = sweep.key.rpartition("_mm")
    label = with_unit(name, f"mm{unit.replace('_', '/')}") if name else sweep.key
    axes.set_xlabel(wrapped(label, width - 0.6, TEXT_SIZE))


def _notes(results: Results, sweep: Sweep, found: Sequence[Flip]) -> list[str]:
    tally = Tally()
    kept = {model.row_id for model in sweep.models}
    compared = {contender.row_id for contender in sweep.contenders}
    for setting, model, contender in itertools.product(
        results.settings, results.models, results.contenders
    ):
        why = None
        if contender.row_id not in compared:
            why = "of contenders valid on fewer than half of the models"
        elif model.row_id not in kept:
            why = "on models that some contender does not do"
        tally.add(results.slot(setting, model, contender), why)
    notes = [
        f"Totals over the {counted(len(sweep.models), 'model')} on which all contenders shown are "
        "valid under every setting."
    ]
    if found:
        notes.append("Shaded and ringed: the order of two contenders turns round.")
        notes += [f"{flip_text(sweep, flip)}." for flip in found[:_MOST_FLIPS]]
        if len(found) > _MOST_FLIPS:
            notes.append(f"{counted(len(found) - _MOST_FLIPS, 'more flip')}: see summary.md.")
    else:
        notes.append("Nowhere along the axis does the order of two contenders turn round.")
    return [*notes, tally.sentence()]


def _swept_keys(results: Results) -> list[str]:
    """The printer's keys that differ; none if anything but retract_* does."""
    tasks = [results.task(setting) for setting in results.settings]
    printers = [results.printer(setting) for setting in results.settings]
    if any(task != tasks[0] for task in tasks):
        return []
    keys = list(dict.fromkeys(key for printer in printers for key in printer))
    swept = [k for k in keys if any(p.get(k) != printers[0].get(k) for p in printers)]
    sound = all(k.startswith(_PREFIX) and all(k in p for p in printers) for k in swept)
    return swept if sound else []


def _axis_key(results: Results, swept: Sequence[str]) -> str:
    if _AXIS in swept:
        return _AXIS
    return next((key for key in swept if _is_numeric(results, key)), swept[0])


def _is_numeric(results: Results, key: str) -> bool:
    values = [results.printer(setting)[key] for setting in results.settings]
    return all(isinstance(v, (int, float)) and not isinstance(v, bool) for v in values)


def _shown(value: object) -> str:
    if isinstance(value, (int, float)):
        return format_number(float(value))
    return str(value)
