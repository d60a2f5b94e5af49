"""Errors of recipes."""

from __future__ import annotations

from arboleda.model.errors import ArboledaError
from arboleda.model.outside import among, quoted


class RecipeError(ArboledaError):
    """A recipe that cannot be built."""


class RoleError(RecipeError):
    """A recipe that needs a device in a role that its cell does not have."""


class Offers:
    """Base of objects whose methods a recipe calls: the error for a misspelled name lists the right names.

    `str` of such an object is its name in sentences.
    """


def misspelled(error: AttributeError) -> str | None:
    """The sentence for a method that a cell or a device does not have; None for any other error."""
    if not isinstance(error.obj, Offers) or error.name is None:
        return None
    offered = [name for name in dir(error.obj) if not name.startswith("_")]
    return f"{error.obj} has no step {quoted(error.name)}; {among(error.name, offered)}"
