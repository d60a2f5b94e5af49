"""Parts of installed packages, as factories: a package registers a Part, or factories of its own."""

from __future__ import annotations

from importlib.metadata import EntryPoint

from arboleda.host.pieces import THE_PARTS, Pieces, piece_of

from .extensions.making import factory_of
from .extensions.part import Part
from .registry import GROUP, Factory


def packaged(pieces: Pieces) -> list[tuple[EntryPoint, Factory]]:
    """The factories of packages, each with its entry point; what cannot be loaded is left out."""
    found: list[tuple[EntryPoint, Factory]] = []
    for point in pieces.registered(GROUP):
        with pieces.calling(piece_of(point, THE_PARTS)):
            found += [(point, each) for each in _factories(point)]
    return found


def _factories(point: EntryPoint) -> tuple[Factory, ...]:
    loaded = point.load()
    if isinstance(loaded, type) and issubclass(loaded, Part):
        return (factory_of(loaded, point),)
    factories = tuple(loaded)
    if not all(isinstance(each, Factory) for each in factories):
        raise TypeError(f"{point.value} is neither a Part nor a sequence of factories of parts")
    return factories
