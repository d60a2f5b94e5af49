"""Pages that were built and that no browser has opened yet: a limited number, for each costs a megabyte."""

from __future__ import annotations

from .toolkit import Client

MOST = 40  # a browser opens its page within a second or two


class PageBudget:
    """PageBudget: forgets the oldest page if too many wait. NiceGUI would keep each for a minute."""

    def __init__(self, most: int = MOST) -> None:
        self._most = most
        self._waiting: dict[str, Client] = {}

    def add(self, client: Client) -> None:
        """Add a page that was just built; its browser reports that it has opened it."""
        self._waiting[client.id] = client
        client.on_connect(lambda: self._forget(client.id))
        client.on_delete(lambda: self._forget(client.id))
        if len(self._waiting) > self._most:
            next(iter(self._waiting.values())).delete()

    def _forget(self, id: str) -> None:
        self._waiting.pop(id, None)
