"""Errors of recipes."""

from __future__ import annotations

from arboleda.model.errors import ArboledaError


class RecipeError(ArboledaError):
    """A recipe that cannot be built."""


class RoleError(RecipeError):
    """A recipe that needs a device in a role that its cell does not have."""
