"""The comparison as Markdown, short enough for a pull request."""

from __future__ import annotations

import math
from collections.abc import Sequence

from routebench_plots.markdown import markdown_table, markdown_text
from routebench_plots.quantities import counted, format_number, scale_for
from routebench_plots.results import Cell, Results

from .compare import Change, Comparison, Pair, Place, Verdict
from .limits import is_noisy, is_share

_MOST_LINES = 20


def to_markdown(made: Comparison, old: Results, new: Results, missing_fails: bool) -> str:
    """What became worse first, then what changed, then what could not be compared."""
    lines = [
        _headline(made, missing_fails),
        "",
        f"{markdown_text(new.experiment)}, {_run_text(old)} → {_run_text(new)}: "
        f"{counted(made.paired, 'cell')} compared"
        + (f", {len(made.missing)} missing now" if made.missing else "")
        + (f", {len(made.added)} new" if made.added else "")
        + ".",
    ]
    lines += _regressions(made, missing_fails)
    lines += _changes(made.verdicts)
    lines += _listed("Valid now, not before", [_pair_text(pair) for pair in made.won])
    lines += _listed("Not valid, in another way", [_pair_text(pair) for pair in made.otherwise])
    if not missing_fails:
        lines += _listed("Missing now", [_place_text(place) for place in made.missing])
    lines += _listed("New cells", [_place_text(place) for place in made.added])
    lines += _listed("Notes", [markdown_text(note) for note in made.notes])
    return "\n".join(lines) + "\n"


def regressions(made: Comparison, missing_fails: bool) -> int:
    """How many things fail the gate."""
    return (
        len(made.lost)
        + sum(verdict.is_regression for verdict in made.verdicts)
        + (len(made.missing) if missing_fails else 0)
    )


def _headline(made: Comparison, missing_fails: bool) -> str:
    """The verdict, then the worst of what led to it."""
    number = regressions(made, missing_fails)
    if not number:
        return "## PASSED, no regression"
    head = f"## FAILED, {counted(number, 'regression')}" + (", worst" if number > 1 else "")
    failed = [verdict for verdict in made.verdicts if verdict.is_regression]
    if made.lost:
        return f"{head}: {_pair_text(made.lost[0])}"
    if not failed:
        return f"{head}: {_place_text(made.missing[0])}: missing"
    # What is exact goes before what is noisy.
    worst = max(failed, key=lambda v: (not is_noisy(v.metric), _worst(v).worsening))
    place = _worst(worst).place
    return (
        f"{head}: {markdown_text(worst.metric.label)} of {_place_text(place)}: "
        f"{_change_text(worst, _worst(worst))}"
    )


def _worst(verdict: Verdict) -> Change:
    """The cell that lost most."""
    return max(verdict.changes, key=lambda change: change.worsening)


def _run_text(results: Results) -> str:
    """Which program made the results, as far as they say."""
    run = results.last_run()
    version, commit = run.get("routebench_version"), run.get("git_commit")
    words = [str(version)] if version else []
    if commit:
        words.append(f"`{str(commit)[:10]}`" + (" with changes" if run.get("git_dirty") else ""))
    started = str(run.get("started_utc") or "")
    if started:
        words.append(f"of {markdown_text(started)}")
    return " ".join(words) or markdown_text(str(results.database))


def _regressions(made: Comparison, missing_fails: bool) -> list[str]:
    lines = [f"**{_pair_text(pair)}**" for pair in made.lost]
    lines += [_verdict_text(verdict) for verdict in made.verdicts if verdict.is_regression]
    if missing_fails:
        lines += [f"{_place_text(place)}: missing" for place in made.missing]
    return _listed("Regressions", lines)


def _verdict_text(verdict: Verdict) -> str:
    """Who is worse at what, on how many cells, and where most."""
    where = [markdown_text(verdict.contender)]
    if verdict.setting:
        where.append(markdown_text(verdict.setting))
    text = (
        f"**{', '.join(where)}: {markdown_text(verdict.metric.label)}** worse on "
        f"{verdict.worse} of {counted(len(verdict.changes), 'cell')}"
    )
    if verdict.interval is not None and verdict.interval.low > 1 + verdict.limit:
        text += (
            f", {_mean_text(verdict)} (95 % interval of the median "
            f"{verdict.interval.low:.3g} to {verdict.interval.high:.3g} times, limit "
            f"{1 + verdict.limit:.3g})"
        )
    elif verdict.over:
        worst = max(verdict.over, key=lambda change: change.worsening)
        text += (
            f", {len(verdict.over)} beyond the limit of {_share_text(verdict, verdict.limit)}; "
            f"most on {markdown_text(worst.place.model)}: {_change_text(verdict, worst)}"
        )
    return text


def _changes(verdicts: Sequence[Verdict]) -> list[str]:
    """A row for each comparison in which anything differs; how many do not."""
    moved = [v for v in verdicts if v.worse or v.better]
    lines = []
    if moved:
        rows = [
            [
                "**worse**" if v.is_regression else _mild_verdict(v),
                markdown_text(v.contender),
                markdown_text(v.setting or "–"),
                markdown_text(v.metric.label),
                _mean_text(v),
                f"{v.worse} of {len(v.changes)}",
                f"{v.better} of {len(v.changes)}",
                _extreme_text(v),
            ]
            for v in sorted(moved, key=lambda v: not v.is_regression)
        ]
        heads = [
            "verdict",
            "contender",
            "setting",
            "metric",
            "change",
            "worse on",
            "better on",
            "worst cell",
        ]
        if all(not v.setting for v in moved):
            heads.pop(2)
            rows = [[*row[:2], *row[3:]] for row in rows]
        lines += ["", *markdown_table(heads, rows, left=heads.index("metric") + 1)]
    exact = [v for v in verdicts if not is_noisy(v.metric)]
    equal = sum(not (v.worse or v.better) for v in exact)
    if exact:
        lines += [
            "",
            f"{equal} of {len(exact)} comparisons of quality are equal in every digit.",
        ]
    return lines


def _mild_verdict(verdict: Verdict) -> str:
    if is_noisy(verdict.metric):
        faster = verdict.interval is not None and verdict.interval.high < 1 / (1 + verdict.limit)
        return "better" if faster else "within noise"
    if not verdict.worse:
        return "better"
    return "within the limit" if not verdict.better else "mixed, within the limit"


def _mean_text(verdict: Verdict) -> str:
    """The change over all cells."""
    if verdict.ratio is not None:
        return _signed_percent(verdict.ratio - 1)
    if is_share(verdict.metric):
        mean = math.fsum(c.new - c.old for c in verdict.changes) / len(verdict.changes)
        return f"{_signed(100 * mean)} points"
    total = math.fsum(c.new - c.old for c in verdict.changes)
    scale = scale_for(verdict.metric, [total])
    return f"{_signed(scale(total))} {scale.unit}".strip()


def _extreme_text(verdict: Verdict) -> str:
    """The cell that lost most, if any lost."""
    worst = _worst(verdict)
    if worst.worsening <= 0:
        return "–"
    return f"{markdown_text(worst.place.model)}: {_change_text(verdict, worst)}"


def _change_text(verdict: Verdict, change: Change) -> str:
    scale = scale_for(verdict.metric, [change.old, change.new])
    before, after = _told_apart(scale(change.old), scale(change.new))
    text = f"{before} → {after} {scale.unit}".strip()
    if is_share(verdict.metric) or not math.isfinite(change.worsening):
        return text
    return f"{text} ({_signed_percent((change.new - change.old) / abs(change.old))})"


def _told_apart(old: float, new: float) -> tuple[str, str]:
    """Numbers with as many digits as it takes to see that they differ."""
    before, after = format_number(old), format_number(new)
    digits = 5
    while before == after and digits < 18:
        before, after = f"{old:.{digits}g}", f"{new:.{digits}g}"
        digits += 1
    return before, after


def _share_text(verdict: Verdict, share: float) -> str:
    unit = " points" if is_share(verdict.metric) else " %"
    return f"{format_number(100 * share)}{unit}"


def _signed_percent(share: float) -> str:
    return f"{_signed(100 * share)} %"


def _signed(value: float) -> str:
    """With a sign, and never a zero for what is none."""
    if value == 0:
        return "0"
    text = format_number(float(f"{abs(value):.3g}"))
    return f"{'+' if value > 0 else '−'}{text}"


def _listed(title: str, entries: Sequence[str]) -> list[str]:
    if not entries:
        return []
    lines = ["", f"### {title}", "", *(f"- {entry}" for entry in entries[:_MOST_LINES])]
    if len(entries) > _MOST_LINES:
        lines.append(f"- and {len(entries) - _MOST_LINES} more")
    return lines


def _pair_text(pair: Pair) -> str:
    reason = f" ({markdown_text(pair.new.reason)})" if pair.new.reason else ""
    return f"{_place_text(pair.place)}: {_outcome(pair.old)} → {_outcome(pair.new)}{reason}"


def _outcome(cell: Cell) -> str:
    return cell.outcome.replace("_", " ")


def _place_text(place: Place) -> str:
    setting = f", {markdown_text(place.setting)}" if place.setting else ""
    seed = f", seed {place.seed}" if place.seed != 1 else ""
    return f"{markdown_text(place.contender)} on {markdown_text(place.model)}{setting}{seed}"
