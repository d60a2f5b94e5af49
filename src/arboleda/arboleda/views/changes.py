"""Difference of flat plain data: faces of the page, rows of a snapshot, fields of a row."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def changed(before: Mapping[str, Any], after: Mapping[str, Any]) -> dict[str, Any]:
    """The entries of `after` that are new or other than in `before`."""
    missing = object()
    return {key: value for key, value in after.items() if before.get(key, missing) != value}
