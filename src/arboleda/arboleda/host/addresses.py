"""Addresses of this machine in its networks."""

from __future__ import annotations

import socket
import struct
import sys

if sys.platform == "linux":
    import fcntl

SIOCGIFADDR = 0x8915  # of linux/sockios.h: the address of an interface
ADDRESS_AT = slice(20, 24)  # in its struct ifreq


def interface_addresses() -> list[str]:
    """An IPv4 address of each interface that has any; off Linux those that this machine's name leads to."""
    return _by_interface() if sys.platform == "linux" else by_name(socket.gethostname())


def by_name(host: str) -> list[str]:
    """The IPv4 addresses that a name leads to; none where it leads nowhere."""
    try:
        found = socket.getaddrinfo(host, None, socket.AF_INET, socket.SOCK_STREAM)
    except OSError:
        return []
    return list(dict.fromkeys(str(address[0]) for *_, address in found))


def _by_interface() -> list[str]:
    found = []
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as asks:
        for _, interface in socket.if_nameindex():
            request = struct.pack("256s", interface.encode()[:15])
            try:
                answer = fcntl.ioctl(asks.fileno(), SIOCGIFADDR, request)
            except OSError:  # it has none
                continue
            found.append(socket.inet_ntoa(answer[ADDRESS_AT]))
    return found
