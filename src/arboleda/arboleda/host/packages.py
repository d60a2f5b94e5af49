"""Entry points of installed packages, without those of distributions that are left out whole."""

from __future__ import annotations

from importlib import import_module, metadata
from typing import Any
from warnings import warn

from arboleda.model.packages import MISSING, PackageMissing

from .distributions import installed

EXTRAS = "arboleda.extras"


def entry_points(group: str) -> metadata.EntryPoints:
    """The entry points of a group, of all distributions that are not left out."""
    found = installed()
    points = found.points.select(group=group)
    return metadata.EntryPoints(
        each for each in points if each.dist not in found.barred and each.dist not in found.off
    )


def left_out() -> tuple[str, ...]:
    """A sentence for each distribution that is left out, though nobody has put it off."""
    found = installed()
    return tuple(why for dist, why in found.barred.items() if dist not in found.off)


def why_left_out(group: str, name: str) -> str:
    """The sentence that a distribution is left out which has this name in a group; "" where there is none."""
    found = installed()
    why = {**found.barred, **found.off}
    points = (each for each in found.points.select(group=group) if name in (each.name, package_of(each)))
    return next((why[each.dist] for each in points if each.dist in why), "")


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
