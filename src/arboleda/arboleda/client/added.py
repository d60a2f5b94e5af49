"""Methods that packages add to a plant: classes of Routes, registered under the entry point group
`arboleda.client`."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from arboleda.host.packages import registered
from arboleda.host.pieces import Pieces, piece_of
from arboleda.model.packages import FLEET, MAKE, MISSING, PROOFS

from .calls import Routes
from .errors import MethodMissing

GROUP = "arboleda.client"
PIECES = Pieces()
OF_PACKAGES = {
    FLEET: {"oee"},
    MAKE: {
        *("draft", "versions", "put", "restart", "trees", "palette", "check_tree", "copy_tree", "edit_tree"),
        *("proposals", "proposal_base", "proposal", "propose", "prove_proposal", "simulate_proposal"),
        *("withdraw", "approve", "reject", "give"),
    },
    PROOFS: {"report", "faults", "provoke", "end_faults"},
}
"""Methods of our packages, so that a client without one says what to install."""


class Added(Routes):
    """Methods of the installed packages, as if a plant had their classes among its bases: `plant.draft()`.

    They are looked up when one is used: a route that a package adds changes nothing here, and whoever uses
    none loads none. Type checkers see none of them, so that a wrong name is an error to them; for these a
    package has a class with types, as `arboleda_make.client.Make(plant).draft()`.
    """

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            for kind in () if name.startswith("_") else added():
                if hasattr(kind, name):
                    return getattr(kind, name).__get__(self, type(self))
            for package, names in OF_PACKAGES.items():
                if name in names:
                    raise MethodMissing(MISSING(what=f"Plant.{name}", package=package))
            raise AttributeError(f"A plant has no {name!r}.", name=name, obj=self)

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *(name for kind in added() for name in dir(kind))})


def added() -> Iterator[type[Routes]]:
    """The classes that packages bring, in the order of their names; one that breaks is left out."""
    for point in registered(GROUP):
        with PIECES.sparing(piece_of(point, "the client")):
            kind = point.load()
            if not issubclass(kind, Routes):
                raise TypeError(f"{point.value} is no class of Routes")
            yield kind
