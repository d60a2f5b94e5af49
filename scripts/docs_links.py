"""What mkdocs does with links that make sense in a checkout only."""

from __future__ import annotations

import posixpath
import re
from typing import Any

LANGUAGE = re.compile(r"^\*(?:En español|In English): .*\*\n", re.MULTILINE)
LINK = re.compile(r"(?<!!)\[([^\]]+)\]\((?!https?:)([^)#]+)[^)]*\)")


def on_page_markdown(markdown: str, *, page: Any, **_: Any) -> str:
    """The page without its link to itself in the other language, for which the site has a menu. A link to a
    Spanish page leads to that of the reader's language; one that leaves the documentation is its text and the
    path in a checkout."""
    folder = posixpath.dirname(page.file.src_uri)

    def on_site(link: re.Match[str]) -> str:
        target = posixpath.normpath(posixpath.join(folder, link[2]))
        if target.startswith("../"):
            return f"{link[1]} (`{target.removeprefix('../')}`)"
        return link[0].replace(".es.md", ".md")

    return LINK.sub(on_site, LANGUAGE.sub("", markdown))
