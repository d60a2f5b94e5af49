"""Documents in two languages: where a page leads, whatever its language."""

from __future__ import annotations

import re
from pathlib import Path

from .scripts import load

SITE = load("docs_links.py")
ENGLISH = re.compile(r"\b(?:the|and|of|with|which|that|are|its|from|was|where|until|this|there|what)\b")
"""Words that no Spanish sentence has."""


def links(page: Path) -> list[str]:
    """Where a page leads, in English: the page, and the anchor of the same heading."""
    targets = re.findall(r"\]\((\S+?)\)", page.read_text("utf-8"))
    return [target if "://" in target else _in_english(page, target) for target in targets]


def _in_english(page: Path, target: str) -> str:
    path, _, anchor = target.partition("#")
    spanish = page.parent / path if path else page
    english = SITE.english_of(spanish)
    if anchor and english is not None:
        headings = (SITE.anchors(each.read_text("utf-8")) for each in (spanish, english))
        anchor = dict(zip(*headings, strict=True)).get(anchor, anchor)
    return f"{path.replace('.es.md', '.md')}#{anchor}"
