"""Puts a page together: one file that needs nothing else."""

from __future__ import annotations

import html
import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from .content import Content
from .libraries import own_script, style, three_js, viewer_markup

# Nothing is ever fetched: the browser is told to refuse it.
_POLICY = (
    "default-src 'none'; script-src 'unsafe-inline'; "
    "style-src 'unsafe-inline'; img-src data: blob:"
)


@dataclass(frozen=True)
class Section:
    """A part of the page under a heading; `anchor` leads to it."""

    anchor: str
    title: str
    markup: str


def viewer_section() -> Section:
    """The route viewer."""
    return Section("viewer", "Route viewer", viewer_markup())


def page(content: Content, sections: Sequence[Section]) -> str:
    """The page as HTML; with one section only, that fills the window."""
    alone = len(sections) == 1
    content.data["viewer_only"] = alone
    return "\n".join(_parts(content, sections, alone)) + "\n"


def _parts(
    content: Content, sections: Sequence[Section], alone: bool
) -> Iterator[str]:
    title = html.escape(str(content.data["title"]))
    yield '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">'
    yield f'<meta http-equiv="Content-Security-Policy" content="{_POLICY}">'
    yield '<meta name="viewport" content="width=device-width">'
    yield '<link rel="icon" href="data:,">'
    yield f"<title>{title} · routebench</title>\n<style>{style()}</style>"
    yield "</head>\n<body" + (' class="alone">' if alone else ">")
    yield f'<header class="top"><h1>{title}</h1>'
    if not alone:
        yield '<nav aria-label="Parts of the page">'
        for section in sections:
            yield f'<a href="#{section.anchor}">{section.title}</a>'
        yield "</nav>"
    yield '</header>\n<main class="page">'
    for section in sections:
        if not alone:
            yield f"<h2>{section.title}</h2>"
        yield section.markup
    yield "</main>"
    data = json.dumps(content.data, ensure_ascii=False, separators=(",", ":"))
    yield '<script type="application/json" id="data">'
    yield data.replace("<", "\\u003c") + "</script>"
    for name, block in content.blocks.items():
        yield f'<script type="text/plain" id="block-{name}">{block}</script>'
    yield _script(three_js())
    yield _script(own_script())
    yield "</body>\n</html>"


def _script(text: str) -> str:
    """A script element; its text must not hold what would end it."""
    text = text.replace("</script", "<\\/script").replace("<!--", "<\\!--")
    return f"<script>{text}</script>"
