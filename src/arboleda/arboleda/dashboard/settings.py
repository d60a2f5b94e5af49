"""The settings: what this browser remembers, and what packages add."""

from __future__ import annotations

from . import tools
from .page_part import Place, Put, put_nothing
from .tags import tag
from .wording import Words


def build(words: Words, role: str | None, put: Put = put_nothing) -> None:
    """Draw the settings; `role` is that of a person who logged in, None if nobody has to."""
    with tag("div", classes="box"):
        tag("h2", words("settings.browser"))
        with tag("div", classes="setting"):
            tools.languages(words)
            tag("span", words("settings.language"))
        with tag("div", classes="setting"):
            tools.look(words)
            tag("span", words("page.look"))
        with tag("div", classes="setting"):
            tools.sound(words)
            tag("span", words("page.sound"))
        if role is not None:
            with tag("div", classes="setting"):
                tools.log_out(words, role)
                tag("span", words("page.log_out"))
    put(Place.SETTINGS)
