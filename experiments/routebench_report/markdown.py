"""The little Markdown that summaries are written in, as HTML."""

from __future__ import annotations

import html
import re
from collections.abc import Iterator

_RULE = re.compile(r"\|?\s*:?-+:?\s*(\|\s*:?-+:?\s*)*\|?\s*")


def to_html(text: str) -> str:
    """Headings (two levels down), tables, lists, pictures left out, paragraphs."""
    return "\n".join(_blocks(text.split("\n")))


def _blocks(lines: list[str]) -> Iterator[str]:
    at = 0
    while at < len(lines):
        line = lines[at]
        if not line.strip():
            at += 1
        elif heading := re.match(r"(#+)\s+(.*)", line):
            level = min(6, len(heading[1]) + 2)
            yield f"<h{level}>{_inline(heading[2])}</h{level}>"
            at += 1
        else:
            kind = _kind(line)
            end = at + 1
            while (
                end < len(lines)
                and lines[end].strip()
                and not lines[end].startswith("#")
                and _kind(lines[end]) == kind
            ):
                end += 1
            yield _MAKERS[kind](lines[at:end])
            at = end


def _kind(line: str) -> str:
    if line.startswith("|"):
        return "table"
    return "list" if re.match(r"\s*[-*] ", line) else "paragraph"


def _paragraph(lines: list[str]) -> str:
    return f"<p>{_inline(' '.join(lines))}</p>"


def _list(lines: list[str]) -> str:
    items = (re.sub(r"^\s*[-*] ", "", line) for line in lines)
    return "<ul>" + "".join(f"<li>{_inline(i)}</li>" for i in items) + "</ul>"


def _table(lines: list[str]) -> str:
    aligns = [""] * len(_cells(lines[0]))
    if len(lines) > 1 and _RULE.fullmatch(lines[1]):
        aligns = [
            ' class="number"' if cell.endswith(":") else ""
            for cell in _cells(lines[1])
        ]
    rows = [line for line in lines if not _RULE.fullmatch(line)]
    head, *body = ([_inline(c) for c in _cells(row)] for row in rows)
    return (
        '<div class="scroller"><table><thead><tr>'
        + "".join(
            f'<th scope="col"{a}>{c}</th>' for a, c in zip(aligns, head)
        )
        + "</tr></thead><tbody>"
        + "".join(
            "<tr>"
            + "".join(f"<td{a}>{c}</td>" for a, c in zip(aligns, row))
            + "</tr>"
            for row in body
        )
        + "</tbody></table></div>"
    )


def _cells(line: str) -> list[str]:
    """A row's cells; a backslash keeps a bar from ending one."""
    inner = line.strip().removeprefix("|").removesuffix("|")
    return [cell.strip() for cell in re.split(r"(?<!\\)\|", inner)]


def _inline(text: str) -> str:
    """Bold, emphasis, code and what a backslash escapes."""
    made = html.escape(text)
    made = re.sub(r"(?<!\\)`([^`]+)`", r"<code>\1</code>", made)
    made = re.sub(r"(?<!\\)\*\*(.+?)(?<!\\)\*\*", r"<strong>\1</strong>", made)
    made = re.sub(r"(?<!\\)\*(\S[^*]*?)(?<!\\)\*", r"<em>\1</em>", made)
    return re.sub(r"\\([!-/:-@\[-`{-~])", r"\1", made)


_MAKERS = {"table": _table, "list": _list, "paragraph": _paragraph}
