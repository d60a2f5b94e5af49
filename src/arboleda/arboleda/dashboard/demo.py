"""What a visitor of a demonstration reads first, and what ends it."""

from __future__ import annotations

from .tags import live, tag
from .wording import Words

END = "end_demo"
LINES = ("cells", "trouble", "more")


def build(words: Words) -> None:
    """Three lines until somebody has seen them; the button stays while the demonstration goes on."""
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
