"""Toolkit of the pages: the names of NiceGUI that they use."""

from __future__ import annotations

from arboleda.host.imports import without

# engineio, over which NiceGUI serves, takes these for its clients and for another server where they are
# installed. aiohttp always is: 0.1 s of each start, and 10 MB of each plant.
with without("aiohttp", "requests", "tornado"):
    from nicegui import Client, app, ui
    from nicegui.events import GenericEventArguments

__all__ = ["Client", "GenericEventArguments", "app", "ui"]
