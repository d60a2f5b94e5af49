"""Things that the parts of a running plant offer each other, by kind; no part knows which one made them."""

from __future__ import annotations

from typing import Any, TypeVar

from arboleda.model.errors import ArboledaError

Thing = TypeVar("Thing")


class NotOffered(ArboledaError):
    """No part of this process offers what another one needs."""


class Offers:
    """One thing of each kind; a kind is a class, or a protocol that the thing keeps to.

    Parts are made one after the other: whoever needs a thing of a part that is made later asks when it uses
    the thing.
    """

    def __init__(self) -> None:
        self._things: dict[type[Any], Any] = {}

    def offer(self, kind: type[Thing], thing: Thing) -> None:
        """Offer a thing of this kind; ArboledaError where another part offers one already."""
        if kind in self._things:
            raise ArboledaError(f"another part offers a {kind.__name__} already")
        self._things[kind] = thing

    def ask(self, kind: type[Thing]) -> Thing | None:
        """The thing of this kind; None where no part offers one."""
        thing: Thing | None = self._things.get(kind)
        return thing

    def need(self, kind: type[Thing]) -> Thing:
        """The same, of what has to be there; raises NotOffered."""
        thing = self.ask(kind)
        if thing is None:
            raise NotOffered(f"no part of this process offers a {kind.__name__}")
        return thing
