"""Options of the HTTP server: its address and its access rules."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from arboleda.web.access.auth import Door
from arboleda.web.access.names import (
    DEFAULT_PORT,
    EVERY_NETWORK,
    LOCAL,
    is_loopback,
    listen_address,
    other_address,
    url_host,
)

from . import tokens

if TYPE_CHECKING:  # slow to load, and only needed for TLS
    from arboleda.adapters.server_tls import ServerTls


@dataclass(frozen=True, kw_only=True)
class WebOptions:
    """The address to listen on; `port` None is `usual_port` or a free one. `public_url` is the address of a
    proxy. With `tls` everybody speaks TLS. `door` is the one of the previous server there, with its sessions.
    """

    host: str = LOCAL
    port: int | None = None
    public_url: str | None = None
    tls: ServerTls | None = None
    usual_port: int = DEFAULT_PORT
    door: Door | None = None

    @property
    def scheme(self) -> str:
        """The scheme of the server itself."""
        return "https" if self.tls else "http"

    @property
    def guarded(self) -> bool:
        """True if everybody needs a token; StartError for a host that is no address."""
        return not is_loopback(self.host) or self.public_url is not None

    @property
    def address(self) -> str:
        """The IP address to listen on; StartError for a host that is none."""
        return listen_address(self.host)

    @property
    def near(self) -> str:
        """The host part of a URL that reaches the server from this machine."""
        return url_host(self.address)

    def origin(self, port: int, own_address: Callable[[], str] = other_address) -> str:
        """The address for people and other hosts, if any reach it."""
        return self.public_url or self.direct(port, own_address)

    def direct(self, port: int, own_address: Callable[[], str] = other_address) -> str:
        """The same past a proxy. A server that listens on every network has no address of its own: then
        `own_address()` is that of this host, "" for none."""
        own = own_address() if self.address in EVERY_NETWORK else ""
        return f"{self.scheme}://{url_host(own) if own else self.near}:{port}"

    def door_of(self, state: Path) -> Door:
        """The door that lets people in: with the tokens of that state directory, if everybody needs one."""
        return self.door or Door(tokens.TokenFile(state) if self.guarded else None)
