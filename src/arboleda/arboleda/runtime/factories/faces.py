"""Factories of the HTTP server with its page, and of the notices to systemd."""

from __future__ import annotations

import logging
import os
from collections.abc import Iterator

from arboleda.adapters import descriptors
from arboleda.model.errors import ArboledaError
from arboleda.web.access.names import other_address

from ..parts.local_plant import LocalPlant
from ..parts.orchestrator import Orchestrator
from ..parts.part import PageAddress, Part
from ..parts.systemd import systemd_part
from ..registry import Assembly

LOG = logging.getLogger(__name__)


def web(assembly: Assembly) -> Iterator[Part]:
    """The HTTP server, with the page where one is wanted; a process has one page, so who leads makes it."""
    if "web" not in assembly.parts:
        return
    from ..parts import page  # its libraries take half a second, and nodes do without them
    from ..parts.metrics import Metrics
    from ..parts.web import WebPart

    running, held, options = assembly.need(Orchestrator), assembly.holdings, assembly.options
    paged = page.PagePlant(running, assembly) if options.page else None
    metrics = Metrics(running.screens.snapshot, assembly.links)
    part = WebPart(
        paged or assembly.need(LocalPlant),
        assembly.model.name,
        held.state.path,
        _Announcement(assembly),
        options.web,
        None if paged is None else paged.mount,
        connections=descriptors.shares(len(assembly.model.robots)).http,
        counts=metrics.text,
        pieces=assembly.pieces,
    )
    assembly.offer(PageAddress, part)
    assembly.notes.append(lambda: part.notes)
    running.screens.watchers += [part.plant.saw, metrics.saw]
    running.listeners.append(metrics.changed)
    running.reacted = metrics.reacted
    held.pace.observers.append(metrics.committed)
    yield part


class _Announcement:
    """Tells other processes and standbys where the page is."""

    def __init__(self, assembly: Assembly) -> None:
        self._held = assembly.holdings
        self._web = assembly.options.web

    def __call__(self, port: int, *, host: str, guarded: bool, certificate: str) -> None:
        self._held.state.announce(port, host=host, guarded=guarded, certificate=certificate)
        try:
            self._held.memory.lead.announce(self._web.origin(port, self._own_address))
        except ArboledaError as error:
            LOG.warning("standbys are not told where the page is: %s", error)

    def _own_address(self) -> str:
        """The address of this host that hosts which reach the memory may reach it by."""
        return self._held.memory.lead.own_address() or other_address()


def systemd(assembly: Assembly) -> Iterator[Part]:
    """The part that tells systemd that the plant runs, if systemd has started it."""
    running = assembly.ask(Orchestrator)
    if running is not None:
        part = systemd_part(os.environ, lambda: running.screens.stepped_at)
        yield from [part] if part else []
