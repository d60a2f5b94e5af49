"""Former place of `arboleda.testing.storage_layout`: its names, with a warning, for one minor version."""

from __future__ import annotations

from warnings import warn

from arboleda.testing import Palletizing, StorageLayout

__all__ = ["Palletizing", "StorageLayout"]

warn("use `from arboleda.testing.storage_layout import ...`", DeprecationWarning, stacklevel=2)
