"""Where the HTTP server listens, and for whom."""

from __future__ import annotations

from dataclasses import dataclass

from arboleda.adapters.web.names import is_loopback


@dataclass(frozen=True, kw_only=True)
class WebOptions:
    """Where to listen; `port` None is 8080 or a free one. `public_url` is how a proxy is reached."""

    host: str = "127.0.0.1"
    port: int | None = None
    public_url: str | None = None

    @property
    def guarded(self) -> bool:
        """Whether everybody needs a token; StartError for a host that is no address."""
        return not is_loopback(self.host) or self.public_url is not None

    @property
    def near(self) -> str:
        """The host part of a URL that reaches the server from this machine."""
        host = {"0.0.0.0": "127.0.0.1", "::": "::1"}.get(self.host, self.host)
        return f"[{host}]" if ":" in host else host
