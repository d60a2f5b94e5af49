"""Error of readers of records."""

from __future__ import annotations

from arboleda.model.errors import ArboledaError


class NoRecord(ArboledaError):
    """Error: a file is no record of a plant, or has a format that this version does not understand."""
