"""The error of what reads records."""

from __future__ import annotations

from arboleda.model.errors import ArboledaError


class NoRecord(ArboledaError):
    """What was read is no record of a plant, or one that this version does not understand."""
