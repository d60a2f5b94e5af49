"""Toolkit of the pages: the names of NiceGUI that they use."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def without(*modules: str) -> Iterator[None]:
    """Context in which imports find these modules not installed, unless they are imported already.

    For packages that use such a module only where it is installed. Afterwards it can be imported.
    """
    absent = [name for name in modules if name not in sys.modules]
    sys.modules.update(dict.fromkeys(absent))  # type: ignore[arg-type]  # None: importing it fails
    try:
        yield
    finally:
        for name in absent:
            sys.modules.pop(name, None)


# engineio, over which NiceGUI serves, takes these for its clients and for another server where they are
# installed. aiohttp always is: 0.1 s of each start, and 10 MB of each plant.
with without("aiohttp", "requests", "tornado"):
    from nicegui import Client, app, ui
    from nicegui.client import HTML_ESCAPE_TABLE
    from nicegui.events import GenericEventArguments

__all__ = ["HTML_ESCAPE_TABLE", "Client", "GenericEventArguments", "app", "ui"]
