"""The versions of the plant's files: which is at work, who put which to work, and a way back."""

from __future__ import annotations

from .tags import tag
from .wording import Words


def build(words: Words) -> None:
    """Draw the box; the script fills and shows it where the plant has files of its own."""
    texts = {"data_by": words("versions.from_page"), "data_sure": words("versions.sure")}
    lost = words("js.not_sent")
    with tag("div", id="versions-box", classes="box", hidden="true", data_lost=lost, **texts):
        tag("h2", words("versions.title"))
        tag("p", id="versions-now", classes="fact")
        tag("ul", id="versions-cells")
        with tag("p", id="versions-restart", hidden="true"):
            tag("span", classes="hint")
            tag("button", type="button", classes="act")
        tag("ul", id="versions", aria_label=words("versions.list"))
        tag("p", id="versions-said", role="status", classes="hint")
