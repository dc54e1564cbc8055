"""Names: no two alike in a figure, and safe ones for files."""

from __future__ import annotations

import difflib
import hashlib
import re
import unicodedata
from collections import Counter
from collections.abc import Iterable, Sequence

_SLUG_LENGTH = 60
_HASH_LENGTH = 7


def distinct_labels(names: Sequence[tuple[str, str]]) -> list[str]:
    """Labels for (name, hash) pairs: the name, with its hash if need be.

    A name is not enough where a database holds, say, a contender with the
    parameters of last week and with those of today.
    """
    shown = [printable(name) for name, _ in names]
    counts = Counter(shown)
    labels = [
        name
        if counts[name] == 1
        else f"{name} [{digits[:_HASH_LENGTH]}]".strip()
        for name, (_, digits) in zip(shown, names)
    ]
    seen: Counter[str] = Counter()
    for place, label in enumerate(labels):
        seen[label] += 1
        if seen[label] > 1:
            labels[place] = f"{label} #{seen[label]}"
    return labels


def short_specs(specs: Iterable[str]) -> dict[str, str]:
    """A short name for each model: of a path the shortest end that no other one has.

    Parametric shapes and the meshes of packages keep their spec; so does what stands after a `?`.
    """
    parts = {spec: _ends(spec) for spec in dict.fromkeys(specs)}
    counts = Counter(end for ends in parts.values() for end in ends)
    return {
        spec: next((end for end in ends if counts[end] == 1), spec)
        for spec, ends in parts.items()
    }


def _ends(spec: str) -> list[str]:
    """The names that a spec might have, shortest first, itself last."""
    if re.match(r"[a-z]+:", spec):
        return [spec]
    path, mark, options = spec.partition("?")
    starts = [match.end() for match in re.finditer(r"/+(?=[^/])", path)]
    return [path[start:] + mark + options for start in reversed(starts)] + [spec]


def printable(text: str) -> str:
    """The text on one line, without what a page cannot show."""
    return " ".join(
        "".join(
            " " if unicodedata.category(char)[0] in "CZ" else char
            for char in text
        ).split()
    )


def nearest(name: str, known: Sequence[str]) -> str:
    """The end of a message about an unknown name: what was meant, or what there is."""
    near = difflib.get_close_matches(name, known, n=1)
    if near:
        return f"; did you mean '{near[0]}'?"
    return f"; it has {', '.join(known)}"


def file_slugs(labels: Sequence[str]) -> dict[str, str]:
    """A piece of a file name for each label; no two alike in any case."""
    plain = {label: _plain_slug(label) for label in labels}
    counts = Counter(slug.lower() for slug in plain.values())
    return {
        label: (
            slug
            if counts[slug.lower()] == 1 and len(slug) <= _SLUG_LENGTH
            else f"{slug[:_SLUG_LENGTH]}-{short_hash(label)}"
        )
        for label, slug in plain.items()
    }


def short_hash(text: str) -> str:
    """A few digits that tell one text from another."""
    return hashlib.sha256(text.encode()).hexdigest()[:_HASH_LENGTH]


def _plain_slug(label: str) -> str:
    slug = re.sub(r"[^A-Za-z0-9.=_]+", "-", label).strip("-.")
    return slug or "default"
