"""Folders in which plants of this user keep their state."""

from __future__ import annotations

import os
from pathlib import Path


def state_root() -> Path:
    """`$XDG_STATE_HOME`, else `~/.local/state`."""
    base = os.environ.get("XDG_STATE_HOME", "")
    return Path(base) if os.path.isabs(base) else Path.home() / ".local" / "state"


def plants_root() -> Path:
    """The folder with the default state directories of all plants."""
    return state_root() / "arboleda"


def default_state(plant: str) -> Path:
    """`$XDG_STATE_HOME/arboleda/<plant>`, else `~/.local/state/arboleda/<plant>`."""
    return plants_root() / plant
