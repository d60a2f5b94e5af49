"""IPv4 addresses of this machine, as Linux reports them."""

from __future__ import annotations

import fcntl
import socket
import struct

from .names import LOCAL

SIOCGIFADDR = 0x8915  # of linux/sockios.h: the address of an interface
ADDRESS_AT = slice(20, 24)  # in its struct ifreq


def other_address() -> str:
    """An address by which others may reach this machine; "" if there is none."""
    return next((each for each in own_addresses() if each != LOCAL), "")


def own_addresses() -> list[str]:
    """An address of each interface that has any, 127.0.0.1 first."""
    found = []
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as asks:
        for _, interface in socket.if_nameindex():
            request = struct.pack("256s", interface.encode()[:15])
            try:
                answer = fcntl.ioctl(asks.fileno(), SIOCGIFADDR, request)
            except OSError:  # it has none
                continue
            found.append(socket.inet_ntoa(answer[ADDRESS_AT]))
    return [LOCAL, *(each for each in found if each != LOCAL)]
