"""Where the HTTP server listens, and for whom."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from arboleda.adapters.web.names import LOCAL, is_loopback, listen_address, url_host

if TYPE_CHECKING:  # it takes a while to load, and only who speaks TLS needs it
    from arboleda.adapters.server_tls import ServerTls


@dataclass(frozen=True, kw_only=True)
class WebOptions:
    """Where to listen; `port` None is 8080 or a free one. `public_url` is how a proxy is reached. With `tls`
    everybody speaks TLS."""

    host: str = LOCAL
    port: int | None = None
    public_url: str | None = None
    tls: ServerTls | None = None

    @property
    def scheme(self) -> str:
        """That of the server itself."""
        return "https" if self.tls else "http"

    @property
    def guarded(self) -> bool:
        """Whether everybody needs a token; StartError for a host that is no address."""
        return not is_loopback(self.host) or self.public_url is not None

    @property
    def address(self) -> str:
        """The IP address to listen on; StartError for a host that is none."""
        return listen_address(self.host)

    @property
    def near(self) -> str:
        """The host part of a URL that reaches the server from this machine."""
        return url_host(self.address)
