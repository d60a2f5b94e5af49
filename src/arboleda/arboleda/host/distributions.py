"""Installed distributions that add to Arboleda, and which of them are left out whole, before any import.

A distribution is left out that a person has put off, one that is written for another API than this, which it
says by an entry point `1 = its_module` of the group `arboleda.api`, and one whose name for its parts, routes
and the like is another's already.
"""

from __future__ import annotations

import os
import sys
from collections import defaultdict
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from importlib import metadata
from pathlib import Path
from typing import Any, NamedTuple

from .state_folders import plants_root

API = 1
"""The number of what `arboleda.extension` offers. It grows where a package has to be changed for it."""
OURS, APIS = "arboleda", "arboleda.api"
OF_PACKAGES = ("client", "commands", "languages", "page", "parts", "routes")  # groups of names of packages
OF_THINGS = (
    "checks",
    "drivers",
    "kinds",
    "recipes",
    "stores",
)  # groups in which names are not those of packages
OFF = "ARBOLEDA_EXTENSIONS_OFF"  # names with commas between
OTHER_API = (
    "Arboleda goes on without {package}: it is written for API {theirs}, and here is API {ours}; "
    "type pip install -U {outdated}"
)
NAMED_ALIKE = (
    "Arboleda goes on without {package}: {other} is registered as {name}, too; "
    "remove one of them, or give one another name"
)
IS_OFF = "{package} is off: type arboleda extension on {name}"
Folders = tuple[tuple[str, int], ...]  # each with the time of its last change
Groups = Mapping[str, tuple[str, ...]]  # the names that a distribution registers, by group


class Installed(NamedTuple):
    """Every entry point, and the distributions that are left out, each with the sentence that says why."""

    points: Any
    barred: Mapping[metadata.Distribution, str]
    off: Mapping[metadata.Distribution, str]


@dataclass(frozen=True, kw_only=True)
class Added:
    """Distribution that adds something: the names that it registers by group, as `kinds`, and `names` by
    which it is called. `left_out` is the sentence that it is left out, "" where it is not."""

    name: str
    version: str
    adds: Groups
    names: frozenset[str]
    is_off: bool
    left_out: str


def installed() -> Installed:
    """The distributions that are there now; an installation or removal changes the time of their folder."""
    by_variable = {called(each) for each in os.environ.get(OFF, "").split(",") if each.strip()}
    return _read(tuple((each, _changed_at(each)) for each in sys.path), kept_off() | by_variable)


def added() -> list[Added]:
    """The distributions that add something, by name; those that are left out, too."""
    found = installed()
    rows = _by_distribution(found.points)
    return sorted((_added(found, *each) for each in rows.items()), key=lambda each: each.name)


def called(name: str) -> str:
    """The name of a distribution or package as it is compared."""
    return name.strip().lower().replace("-", "_")


def off_file() -> Path:
    """The file with the packages that are off for every plant of this user, a name in each line."""
    return plants_root() / "extensions.off"  # no plant can have this name


def kept_off() -> frozenset[str]:
    """The packages that are off for every plant of this user."""
    with suppress(OSError, ValueError):
        return frozenset(called(each) for each in off_file().read_text("utf-8").splitlines() if each.strip())
    return frozenset()


@lru_cache(maxsize=1)
def _read(_: Folders, off: frozenset[str]) -> Installed:
    """Every entry point: to read one group takes as long, as all packages are read."""
    points = metadata.entry_points()
    numbers = defaultdict[Any, set[str]](set)
    for each in points.select(group=APIS):
        numbers[each.dist].add(each.name)
    others = {dist: _other_api(dist, each) for dist, each in numbers.items() if str(API) not in each}
    are_off = _off(points, off) if off else {}
    named = {
        dist: groups
        for dist, groups in _by_distribution(points).items()
        if dist not in others and dist not in are_off
    }
    return Installed(points, {**others, **_named_alike(named)}, are_off)


def _other_api(dist: metadata.Distribution, numbers: set[str]) -> str:
    is_newer = any(each.isdecimal() and int(each) > API for each in numbers)
    return OTHER_API.format(
        package=f"{dist.name} {dist.version}",
        theirs=", ".join(sorted(numbers)),
        ours=API,
        outdated=OURS if is_newer else dist.name,
    )


def _named_alike(named: Mapping[metadata.Distribution, Groups]) -> dict[metadata.Distribution, str]:
    """The distributions with a name that one before them, in the order of their own names, has."""
    owners: dict[str, metadata.Distribution] = {}
    found: dict[metadata.Distribution, str] = {}
    for dist, groups in sorted(named.items(), key=lambda each: each[0].name):
        names = {each.partition(".")[0] for group in OF_PACKAGES for each in groups.get(group, ())}
        if taken := sorted(names & owners.keys()):
            other, name = owners[taken[0]], taken[0]
            package, theirs = (f"{each.name} {each.version}" for each in (dist, other))
            found[dist] = NAMED_ALIKE.format(package=package, other=theirs, name=name)
        else:
            owners |= dict.fromkeys(names, dist)
    return found


def _off(points: Any, off: frozenset[str]) -> dict[metadata.Distribution, str]:
    return {
        dist: IS_OFF.format(package=f"{dist.name} {dist.version}", name=dist.name)
        for dist, groups in _by_distribution(points).items()
        if off & _names(dist, groups)
    }


def _by_distribution(points: Any) -> dict[metadata.Distribution, Groups]:
    found: dict[metadata.Distribution, dict[str, tuple[str, ...]]] = {}
    for group in points.groups:
        named = group.removeprefix(f"{OURS}.")
        for each in points.select(group=group) if named != group else ():
            if each.dist is not None and each.dist.name != OURS:
                groups = found.setdefault(each.dist, {})
                groups[named] = (*groups.get(named, ()), each.name)
    return {**found}


def _names(dist: metadata.Distribution, groups: Groups) -> frozenset[str]:
    """The names by which a person may call a distribution: its own, and those under which it registers."""
    packages = (each for group, names in groups.items() if group not in (*OF_THINGS, "api") for each in names)
    return frozenset([called(dist.name), *(each.partition(".")[0] for each in packages)])


def _added(found: Installed, dist: metadata.Distribution, groups: Groups) -> Added:
    return Added(
        name=dist.name,
        version=dist.version,
        adds=groups,
        names=_names(dist, groups),
        is_off=dist in found.off,
        left_out=found.off.get(dist) or found.barred.get(dist, ""),
    )


def _changed_at(folder: str) -> int:
    """The time of a folder's last change, ns; 0 if there is no such folder."""
    try:
        return os.stat(folder or os.curdir).st_mtime_ns
    except OSError:
        return 0
