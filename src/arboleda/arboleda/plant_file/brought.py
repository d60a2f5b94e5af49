"""Parts of a plant that installed packages bring, with the name and version of each package."""

from __future__ import annotations

from collections.abc import Iterator

from arboleda.drivers.port import GROUP as DRIVERS
from arboleda.host.packages import entry_points, package_of
from arboleda.store.schemes import GROUP as STORES

from . import drivers, extensions, own_kinds
from .document import Document
from .sections import STORE

Brought = dict[str, dict[str, str]]


def by_packages(document: Document) -> Brought:
    """By group of entry points and by name: the distribution, with its version, that brings it."""
    found: Brought = {}
    for group, name in _named(document):
        for point in entry_points(group):
            called = package_of(point) if group == extensions.PARTS else point.name
            if called == name and point.dist is not None:
                found.setdefault(group, {})[name] = f"{point.dist.name} {point.dist.version}"
    return found


def _named(document: Document) -> Iterator[tuple[str, str]]:
    """Names in a plant file that stand for packages, each with its group of entry points."""
    for name, _ in own_kinds.named(document):
        yield own_kinds.GROUP, name
    for _, place in drivers.named(document):
        value = document.value(place)
        yield DRIVERS, str(next(iter(value)) if isinstance(value, dict) and value else value)
    for name in extensions.named(document):
        yield extensions.PARTS, name
    if document.has(STORE):
        yield STORES, str(document.value(STORE)).partition("://")[0]
