"""Names and addresses of this server: Host that it answers to, Origin of pages that may use it."""

from __future__ import annotations

import ipaddress
import re
import socket
from dataclasses import dataclass

from arboleda.host.machine import interface_addresses
from arboleda.model.errors import StartError

LOCAL = "127.0.0.1"
DEFAULT_PORT = 8080
LOOPBACK = {LOCAL, "localhost", "[::1]"}
EVERY_NETWORK = {
    "0.0.0.0": LOCAL,
    "::": "::1",
}  # the wildcard addresses, and the address of each for this machine
DEFAULT_PORTS = {"http": ":80", "https": ":443"}


@dataclass(frozen=True, kw_only=True)
class Names:
    """A page of another site may make a browser send requests here, under its own name (Origin) or, with a
    name that suddenly resolves to this machine, under ours (Host). `public` is the origin before a proxy,
    `scheme` that of the server itself."""

    hosts: frozenset[str]
    any_address: bool = False
    public: str | None = None
    scheme: str = "http"

    def knows_host(self, host: str) -> bool:
        """True if a Host header names this server; on a network any IP address does, as none can be
        redirected."""
        name = host_name(host)
        return name in self.hosts or (self.any_address and is_address(name))

    def knows_origin(self, origin: str, host: str) -> bool:
        """True if an Origin header names a page that this server sent.

        A page of the public name counts under its public scheme only: without TLS anybody on the way may have
        made it.
        """
        origin = origin.lower()
        direct = host_name(host) != self._public_name
        return origin == self.public or (direct and origin == f"{self.scheme}://{host.lower()}")

    @property
    def _public_name(self) -> str | None:
        return host_name(self.public.partition("//")[2]) if self.public else None


def names_for(host: str, public_url: str | None, *, scheme: str = "http") -> Names:
    """The names of a server that is bound to `host` and speaks `scheme`.

    Raises StartError for an address or URL that cannot be used.
    """
    public = public_origin(public_url) if public_url else None
    hosts = LOOPBACK | {url_host(host)} | ({host_name(public.partition("//")[2])} if public else set())
    if not is_loopback(host):
        hosts |= own_names()
    return Names(hosts=frozenset(hosts), any_address=not is_loopback(host), public=public, scheme=scheme)


def own_names() -> set[str]:
    """The names of this machine, as it and others of its network call it."""
    own = socket.gethostname().lower()
    return {own, own.partition(".")[0], f"{own.partition('.')[0]}.local"}


def listen_address(host: str) -> str:
    """The IP address that `host` stands for, in its one usual spelling: `::1` for `[0::1]`, 127.0.0.1 for
    `localhost`. StartError for another name, and for an address that no URL can have (`fe80::1%eth0`)."""
    address = str(_address(host))
    if "%" in address:
        raise _no_address(host)
    return address


def url_host(host: str) -> str:
    """The host part of a URL that reaches a server on `host` from this machine."""
    address = EVERY_NETWORK.get(host, host)
    return f"[{address}]" if ":" in address else address


def is_loopback(host: str) -> bool:
    """True if only this machine can reach `host`; raises StartError if it is no address."""
    return _address(host).is_loopback


def is_near_only(origin: str) -> bool:
    """True if a server at this origin can be reached from its own machine only."""
    name = host_name(origin.partition("//")[2])
    return name == "localhost" or (is_address(name) and is_loopback(name))


def _address(host: str) -> ipaddress.IPv4Address | ipaddress.IPv6Address:
    bare = host[1:-1] if host.startswith("[") and host.endswith("]") else host
    try:
        return ipaddress.ip_address(LOCAL if bare == "localhost" else bare)
    except ValueError:
        raise _no_address(host) from None


def _no_address(host: str) -> StartError:
    return StartError(
        f"'{host}' is not an address to listen on; write e.g. 0.0.0.0 for every network of this machine"
    )


def public_origin(url: str) -> str:
    """The origin of a URL, such as `https://plant.example`; StartError if the URL has more than that."""
    found = re.fullmatch(r"(https?)://([a-z0-9.-]+|\[[0-9a-f:]+\])(:[0-9]{1,5})?/?", url.lower())
    if found is None:
        raise StartError(f"'{url}' is not the address of a plant; write one like https://plant.example")
    scheme, name, port = found.groups(default="")
    return f"{scheme}://{name}{'' if port == DEFAULT_PORTS[scheme] else port}"


def host_name(host: str) -> str:
    """A Host header without its port, in lower case."""
    name, _, port = host.rpartition(":")
    return name.lower() if name and port.isascii() and port.isdigit() else host.lower()


def is_address(name: str) -> bool:
    """True if a name in a Host header is an IP address in its one usual spelling."""
    bare = name[1:-1] if name.startswith("[") and name.endswith("]") else name
    try:
        usual = str(ipaddress.ip_address(bare)) == bare and "%" not in bare
        return usual and (":" in bare) == (bare != name)
    except ValueError:
        return False


def other_address() -> str:
    """An address by which others may reach this machine; "" if there is none."""
    return next((each for each in own_addresses() if each != LOCAL), "")


def own_addresses() -> list[str]:
    """An address of each interface that has any, 127.0.0.1 first."""
    return [LOCAL, *(each for each in interface_addresses() if each != LOCAL)]
