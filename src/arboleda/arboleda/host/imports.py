"""Imports of packages that take more with them than is wanted."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def without(*modules: str) -> Iterator[None]:
    """Have what is imported meanwhile find these modules not installed, but for those that are there already.

    For packages that use them only where they are; afterwards they can be imported as ever.
    """
    absent = [name for name in modules if name not in sys.modules]
    sys.modules.update(dict.fromkeys(absent))  # type: ignore[arg-type]  # None: importing it fails
    try:
        yield
    finally:
        for name in absent:
            sys.modules.pop(name, None)
