"""Controls of what a browser remembers: the language, light or dark, the sound, and who is logged in."""

from __future__ import annotations

from arboleda.web.languages import texts

from .tags import tag
from .wording import LANGUAGES, Words


def build(words: Words, role: str | None) -> None:
    """Draw them into a header; `role` is that of a person who logged in, None if nobody has to."""
    with tag("div", classes="tools"):
        languages(words)
        look(words)
        log_out(words, role)


def languages(words: Words) -> None:
    """Draw a button for each language."""
    for language in LANGUAGES:
        tag(
            "button",
            language.upper(),
            type="button",
            classes="tool",
            lang=language,
            title=texts(language, "page")["name"],
            data_language=language,
            aria_pressed="true" if language == words.language else "false",
        )


def look(words: Words) -> None:
    """Draw the button that turns the page dark or light."""
    does = words("page.look")
    tag("button", type="button", classes="tool look", title=does, aria_label=does)


def sound(words: Words) -> None:
    """Draw the button that has a sound tell of a cell that needs somebody."""
    tag(
        "button",
        "♪",
        type="button",
        classes="tool sound",
        title=words("js.sound_off"),
        aria_label=words("page.sound"),
        aria_pressed="false",
    )


def log_out(words: Words, role: str | None) -> None:
    """Draw the role of a person who logged in, as the button that ends that."""
    if role is None:
        return
    with tag("form", action="/logout", method="post"):
        tag("button", words(f"role.{role}"), type="submit", classes="tool", title=words("page.log_out"))
