"""Links for mkdocs that make sense in a checkout only."""

from __future__ import annotations

import posixpath
import re
from pathlib import Path
from typing import Any

LANGUAGE = re.compile(r"^\*(?:En español|In English): .*\*\n", re.MULTILINE)
LINK = re.compile(r"(?<!!)\[([^\]]+)\]\((?!https?:)([^)#]+)[^)]*\)")
LINE = re.compile(r"^```.*?^```$|^#+ ([^\n]+)$", re.MULTILINE | re.DOTALL)


def on_page_markdown(markdown: str, *, page: Any, **_: Any) -> str:
    """The page without its link to itself in the other language, for which the site has a menu. A link to a
    Spanish page leads to that of the reader's language; one that leaves the documentation is its text and the
    path in a checkout. A Spanish page also has the anchors of the English one, which English pages use."""
    folder = posixpath.dirname(page.file.src_uri)

    def on_site(link: re.Match[str]) -> str:
        target = posixpath.normpath(posixpath.join(folder, link[2]))
        if target.startswith("../"):
            return f"{link[1]} (`{target.removeprefix('../')}`)"
        return link[0].replace(".es.md", ".md")

    english = english_of(Path(page.file.abs_src_path))
    with_anchors = markdown if english is None else doubled(markdown, english.read_text("utf-8"))
    return LINK.sub(on_site, LANGUAGE.sub("", with_anchors))


def english_of(page: Path) -> Path | None:
    """The English page of a Spanish one, None of any other."""
    return page.with_name(page.name.replace(".es.md", ".md")) if page.name.endswith(".es.md") else None


def anchors(markdown: str) -> list[str]:
    """The anchors of all headings, in order."""
    return [slug(heading[1]) for heading in LINE.finditer(markdown) if heading[1] is not None]


def slug(heading: str) -> str:
    """The anchor of a heading, as forges and the site make it."""
    words = re.sub(r"\[([^\]]+)\]\([^)]*\)", r"\1", heading)
    return re.sub(r"[^\w\- ]", "", words).strip().lower().replace(" ", "-")


def doubled(markdown: str, english: str) -> str:
    """A page whose headings have the anchors of the same headings in English besides."""
    others = iter(anchors(english))

    def both(heading: re.Match[str]) -> str:
        if heading[1] is None:
            return heading[0]
        other = next(others, "")
        return heading[0] if other in ("", slug(heading[1])) else f'<a id="{other}"></a>\n\n{heading[0]}'

    return LINE.sub(both, markdown)
