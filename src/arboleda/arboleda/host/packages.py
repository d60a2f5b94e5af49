"""Entry points of installed packages, which are read again once a package was installed or removed.

A distribution that says for which API it is written, by an entry point `1 = its_module` of the group
`arboleda.api`, is left out whole where that is another one: nothing of it is imported.
"""

from __future__ import annotations

import os
import sys
from collections import defaultdict
from collections.abc import Mapping
from functools import lru_cache
from importlib import import_module, metadata
from typing import Any, NamedTuple
from warnings import warn

from arboleda.model.packages import MISSING, PackageMissing

API = 1
"""The number of what `arboleda.extension` offers. It grows where a package has to be changed for it."""
EXTRAS, APIS = "arboleda.extras", "arboleda.api"
OTHER_API = (
    "Arboleda goes on without {package}: it is written for API {theirs}, and here is API {ours}; "
    "type pip install -U {outdated}"
)
Folders = tuple[tuple[str, int], ...]  # each with the time of its last change


class _Installed(NamedTuple):
    points: Any
    left_out: Mapping[metadata.Distribution, str]  # each with the sentence that says why


def entry_points(group: str) -> metadata.EntryPoints:
    """The entry points of a group, of all distributions that are not left out."""
    found = _installed()
    points = found.points.select(group=group)
    return metadata.EntryPoints(each for each in points if each.dist not in found.left_out)


def left_out() -> tuple[str, ...]:
    """A sentence for each distribution that is left out whole."""
    return tuple(_installed().left_out.values())


def why_left_out(group: str, name: str) -> str:
    """The sentence that a distribution is left out which has this name in a group; "" where there is none."""
    found = _installed()
    points = (each for each in found.points.select(group=group) if name in (each.name, package_of(each)))
    return next((found.left_out[each.dist] for each in points if each.dist in found.left_out), "")


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


def moved(name: str, here: str, there: str, package: str) -> Any:
    """A name of the module `here` that a package has now, for one minor version and with a warning."""
    warn(f"use `from {there} import {name}`", DeprecationWarning, stacklevel=3)
    try:
        return getattr(import_module(there), name)
    except ModuleNotFoundError as error:
        if error.name != there.partition(".")[0]:
            raise
        raise ImportError(str(MISSING(what=here, package=package))) from error


def package_of(point: metadata.EntryPoint) -> str:
    """The package that registers an entry point, which is named PACKAGE or PACKAGE.NAME."""
    return point.name.partition(".")[0]


def _installed() -> _Installed:
    """What is installed now; an installation or removal changes the time of a folder of packages."""
    return _read(tuple((each, _changed_at(each)) for each in sys.path))


@lru_cache(maxsize=1)
def _read(_: Folders) -> _Installed:
    """Every entry point: to read one group takes as long, as all packages are read."""
    points = metadata.entry_points()
    numbers = defaultdict[Any, set[str]](set)
    for each in points.select(group=APIS):
        numbers[each.dist].add(each.name)
    others = {dist: _other_api(dist, each) for dist, each in numbers.items() if str(API) not in each}
    return _Installed(points, others)


def _other_api(dist: metadata.Distribution, numbers: set[str]) -> str:
    is_newer = any(each.isdecimal() and int(each) > API for each in numbers)
    return OTHER_API.format(
        package=f"{dist.name} {dist.version}",
        theirs=", ".join(sorted(numbers)),
        ours=API,
        outdated="arboleda" if is_newer else dist.name,
    )


def _changed_at(folder: str) -> int:
    """The time of a folder's last change, ns; 0 if there is no such folder."""
    try:
        return os.stat(folder or os.curdir).st_mtime_ns
    except OSError:
        return 0
