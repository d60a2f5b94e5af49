"""Versions of the plant's files as the page shows them, the last first."""

from __future__ import annotations

from typing import Any

from arboleda.extension import Words


def face(listed: dict[str, Any], words: Words) -> dict[str, Any]:
    """The version at work, the cells that take another one later, and a row for each version."""
    number, at = listed["at_work"]["number"], _minute(listed["at_work"]["at"])
    now = words("versions.started", at=at) if number is None else words("versions.now", number=number, at=at)
    later = [each for each in listed["cells"] if each["following"] is not None]
    cells = [words("versions.later", cell=each["cell"], number=each["following"]) for each in later]
    restart = _restart(listed["restart"], words)
    return {
        "now": now,
        "cells": cells,
        "restart": restart,
        "rows": [_row(each, words) for each in reversed(listed["versions"])],
    }


def _restart(restart: dict[str, Any], words: Words) -> dict[str, Any] | None:
    """Sentence about a restart, and the button for it; None where the plant cannot restart itself."""
    if not restart["can"]:
        return None
    by = restart["by"]
    hint = words("versions.restarts", by=by) if by else words("versions.restart_how")
    return {
        "said": hint,
        "wanted": bool(by),
        "button": words(f"versions.{'no_restart' if by else 'restart'}"),
    }


def _row(version: dict[str, Any], words: Words) -> dict[str, Any]:
    by = version["by"] or "-"
    return {
        "number": version["number"],
        "title": words("versions.one", number=version["number"], at=_minute(version["at"]), by=by),
        "lines": [each for each in (version["note"], *version["changes"]) if each],
        "back": "" if version["is_at_work"] else words("versions.back_to", number=version["number"]),
    }


def _minute(at: str) -> str:
    return at.partition("+")[0].replace("T", " ") + " UTC"
