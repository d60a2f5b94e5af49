"""Installed packages: what they register for others, read again only where something was installed since."""

from __future__ import annotations

import os
import sys
from functools import lru_cache
from importlib import metadata

Folders = tuple[tuple[str, int], ...]  # each with the time of its last change
GROUPS = 8  # that are remembered


def entry_points(group: str) -> metadata.EntryPoints:
    """The entry points of a group; who installs or removes a package changes the folder that it is in."""
    return _entry_points(group, tuple((each, _changed_at(each)) for each in sys.path))


@lru_cache(maxsize=GROUPS)
def _entry_points(group: str, _: Folders) -> metadata.EntryPoints:
    return metadata.entry_points(group=group)


def _changed_at(folder: str) -> int:
    """In nanoseconds; 0 if there is no such folder."""
    try:
        return os.stat(folder or os.curdir).st_mtime_ns
    except OSError:
        return 0
