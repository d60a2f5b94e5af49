"""Fields of goals and requests of arboleda_interfaces, made into a task text."""

from __future__ import annotations


def compose(
    *, text: str = "", cell: str = "", recipe: str = "", path: str = "", station: str = "", id: str = ""
) -> str:
    """The text that filled-in fields spell, for `parse` to judge; without a recipe it is storage."""
    stored = recipe.strip().lower() in ("", "storage")
    number = id.strip() and f"#{id.strip().removeprefix('#')}"
    words = [text, cell, "" if stored else recipe, path, station, number]
    return " ".join(word.strip() for word in words if word.strip())
