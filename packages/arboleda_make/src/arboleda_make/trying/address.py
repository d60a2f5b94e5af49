"""Address of what a driver reaches, as its settings have it."""

from __future__ import annotations

KEYS = ("host", "port", "serial", "url", "broker", "manufacturer", "action")


def address(settings: object) -> dict[str, str]:
    """The settings that say where a controller is, as text; empty where none does.

    Two devices of one address have the same controller: many take one connection only.
    """
    found = {key: getattr(settings, key, None) for key in KEYS}
    return {key: str(value) for key, value in found.items() if isinstance(value, str | int) and value != ""}
