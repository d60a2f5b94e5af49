"""Schemes of addresses at which a database may keep a plant's memory, and what speaks with each.

A package registers a class that keeps to `Databases` under the entry point group `arboleda.stores`, with the
scheme as its name. It is loaded when an address of that scheme is opened.
"""

from __future__ import annotations

from typing import Any, Protocol

from arboleda.host.packages import entry_points
from arboleda.model.errors import StartError
from arboleda.model.outside import text_of_error
from arboleda.model.packages import FLEET, MISSING
from arboleda.model.sentence import OWN

from .leadership import Leaders, Leadership
from .plant_memory import PlantMemory
from .task_rows import History

GROUP = "arboleda.stores"
PACKAGES = {"postgres": FLEET, "postgresql": FLEET}  # which one brings a scheme, where it is not installed
NO_ADDRESS = "must be postgresql://USER@HOST:PORT/DATABASE"
UNKNOWN = "nothing that is installed here keeps a memory at {scheme}://; there are {names}"
BROKEN = "what keeps a memory at {scheme}:// cannot be loaded: {why}"


class Databases(Protocol):
    """Databases of one scheme, as the plants that they keep need them; StartError for an address that is
    none, or where a library is missing."""

    def memory(self, address: str, plant: str) -> PlantMemory: ...
    def history(self, address: str, plant: str) -> History: ...
    def leadership(self, address: str, plant: str) -> Leadership: ...
    def leaders(self, address: str) -> Leaders: ...


def objection(address: str) -> str:
    """The reason for which no memory can be kept at an address, by its scheme; "" where one may be. It does
    not repeat the address, which may have a password in it."""
    scheme, sign, _ = address.partition("://")
    if not sign or not scheme.isalnum():
        return NO_ADDRESS
    names = sorted(each.name for each in entry_points(GROUP))
    if scheme in names:
        return ""
    if scheme in PACKAGES:
        return str(MISSING(what=OWN(text=f"{scheme}://"), package=PACKAGES[scheme]))
    return UNKNOWN.format(scheme=scheme, names=", ".join(names) or "none")


def databases(address: str) -> Databases:
    """The databases that an address belongs to; StartError where none can be used."""
    wrong = objection(address)
    if wrong:
        raise StartError(f"The address of a store {wrong}." if wrong == NO_ADDRESS else f"{wrong}.")
    scheme = address.partition("://")[0]
    point = next(each for each in entry_points(GROUP) if each.name == scheme)
    try:
        made: Any = point.load()()
    except StartError:
        raise
    except (Exception, SystemExit) as error:
        why = text_of_error(error)
        raise StartError(BROKEN.format(scheme=scheme, why=why)) from error
    found: Databases = made
    return found
