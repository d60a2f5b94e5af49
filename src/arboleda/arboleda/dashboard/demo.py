"""Welcome to the visitors of a demonstration: three lines, and the button that ends it."""

from __future__ import annotations

from .tags import live, tag
from .wording import Words

END = "end_demo"
LINES = ("cells", "trouble", "more")


def build(words: Words) -> None:
    """Draw the welcome: its lines stay until they were read, the button until the demonstration ends."""
    with tag("aside", id="demo", aria_label=words("demo.title")):
        live("span", "demo", hidden="true")
        tag("p", words("demo.title"), classes="demo-title")
        with tag("ol", id="demo-lines", hidden="true"):
            for line in LINES:
                tag("li", words(f"demo.{line}"))
        with tag("div", classes="demo-acts"):
            tag("button", words("demo.seen"), type="button", id="demo-seen", classes="act", hidden="true")
            does = words("demo.end_does")
            tag("button", words("demo.end"), type="button", id="demo-end", classes="act", title=does)
