"""Every link in the documents leads somewhere, and from a Spanish page to a Spanish one."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from ..documents import SITE

ROOT = Path(__file__).parents[2]
CODE = re.compile(r"^```.*?^```$|`[^`\n]*`", re.MULTILINE | re.DOTALL)
TARGET = re.compile(r"\]\((?!\w+:)([^)#\s]*)(?:#([^)\s]+))?\)")
READMES = ("src/*/README.md", "packages/*/README.md", "tools/**/README.md", "firmware/**/README*.md")
PAGES = sorted(
    [
        *ROOT.glob("*.md"),
        *(ROOT / "docs").rglob("*.md"),
        *(page for each in READMES for page in ROOT.glob(each)),
    ]
)


@cache
def anchors(page: Path) -> frozenset[str]:
    return frozenset(SITE.anchors(page.read_text("utf-8")))


def lost(page: Path) -> Iterator[str]:
    """The links of a page that lead nowhere, or to English where there is Spanish."""
    for link in TARGET.finditer(CODE.sub("", SITE.LANGUAGE.sub("", page.read_text("utf-8")))):
        path, anchor = link.groups()
        target = (page.parent / path).resolve() if path else page
        in_spanish = page.name.endswith(".es.md") and not target.name.endswith(".es.md")
        if (
            not target.exists()
            or (anchor and target.suffix == ".md" and anchor not in anchors(target))
            or (in_spanish and target.with_suffix(".es.md").exists())
        ):
            yield link[0]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_every_link_of_a_page_leads_somewhere(page: Path) -> None:
    assert list(lost(page)) == []


def test_lost_links_are_found(tmp_path: Path) -> None:
    (tmp_path / "a.md").write_text("# A\n\n## Try `it` at [home](b.md)\n\n```\n# no heading\n```\n")
    (tmp_path / "a.es.md").write_text("# A\n")
    page = tmp_path / "b.es.md"
    page.write_text("[1](a.es.md#a) [2](a.md) [3](c.md) [4](a.es.md#b) [5](https://a) `[6](c.md)` [7](#b)\n")
    assert list(lost(page)) == ["](a.md)", "](c.md)", "](a.es.md#b)", "](#b)"]
    page = tmp_path / "b.md"
    page.write_text("[1](a.md#try-it-at-home) [2](a.md#no-heading)\n")
    assert list(lost(page)) == ["](a.md#no-heading)"]


def test_a_spanish_page_of_the_site_has_the_anchors_of_the_english_one_too() -> None:
    english, spanish = "# One\n\n## Two things\n\n## API\n", "# Uno\n\n## Dos cosas\n\n## API\n"
    site = SITE.doubled(spanish, english)
    assert re.findall('<a id="([^"]+)">', site) == ["one", "two-things"]
    assert SITE.anchors(site) == SITE.anchors(spanish)
