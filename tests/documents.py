"""Documents in two languages: where a page leads, whatever its language."""

from __future__ import annotations

import re
from pathlib import Path

from .scripts import load

SITE = load("docs_links.py")
ENGLISH = re.compile(r"\b(?:the|and|of|with|which|that|are|its|from|was|where|until|this|there|what)\b")
"""Words that no Spanish sentence has."""
BOXES = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
TYPED = re.compile(r"^\$ .*\n", re.MULTILINE)


def boxes(text: str) -> list[tuple[str, str]]:
    """The boxes of a page by their kind; of a console only what is typed: its output is translated."""
    found = BOXES.findall(text)
    return [(kind, "".join(TYPED.findall(box)) if kind == "console" else box) for kind, box in found]


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
