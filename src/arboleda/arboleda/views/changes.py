"""What of flat plain data is new: of the page's faces, of the rows of a snapshot, of the fields of a row."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def changed(before: Mapping[str, Any], after: Mapping[str, Any]) -> dict[str, Any]:
    """What of `after` who knows `before` has to be told."""
    missing = object()
    return {key: value for key, value in after.items() if before.get(key, missing) != value}
