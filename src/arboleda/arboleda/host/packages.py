"""Entry points of installed packages, which are read again once a package was installed or removed."""

from __future__ import annotations

import os
import sys
from functools import lru_cache
from importlib import metadata
from typing import Any

from arboleda.model.packages import MISSING, PackageMissing

EXTRAS = "arboleda.extras"
Folders = tuple[tuple[str, int], ...]  # each with the time of its last change


def entry_points(group: str) -> metadata.EntryPoints:
    """The entry points of a group; an installation or removal changes the time of a folder of packages."""
    points: metadata.EntryPoints = _all(tuple((each, _changed_at(each)) for each in sys.path)).select(
        group=group
    )
    return points


def registered(group: str) -> list[metadata.EntryPoint]:
    """The entry points of a group in the order of their names; none is loaded."""
    return sorted(entry_points(group), key=lambda each: each.name)


def extra(name: str, package: str, what: str) -> Any:
    """An object that `package` brings for a command of the runner; PackageMissing where it is not installed.

    `name` is that of its entry point in the group EXTRAS; `what` is what a person asked for.
    """
    for each in entry_points(EXTRAS):
        if each.name == name:
            return each.load()
    raise PackageMissing(MISSING(what=what, package=package))


def package_of(point: metadata.EntryPoint) -> str:
    """The package that registers an entry point, which is named PACKAGE or PACKAGE.NAME."""
    return point.name.partition(".")[0]


@lru_cache(maxsize=1)
def _all(_: Folders) -> Any:
    """Every entry point: to read one group takes as long, as all packages are read."""
    return metadata.entry_points()


def _changed_at(folder: str) -> int:
    """The time of a folder's last change, ns; 0 if there is no such folder."""
    try:
        return os.stat(folder or os.curdir).st_mtime_ns
    except OSError:
        return 0
