"""This machine: its addresses in its networks, its present boot, and its users."""

from __future__ import annotations

import getpass
import os
import socket
import struct
import sys
from pathlib import Path
from uuid import uuid4

try:
    import pwd
except ImportError:  # Windows
    pwd = None  # type: ignore[assignment]
if sys.platform == "linux":
    import fcntl

SIOCGIFADDR = 0x8915  # of linux/sockios.h: the address of an interface
ADDRESS_AT = slice(20, 24)  # in its struct ifreq
BOOT_ID = Path("/proc/sys/kernel/random/boot_id")


def interface_addresses() -> list[str]:
    """An IPv4 address of each interface that has one; off Linux, those to which this machine's name leads."""
    return _by_interface() if sys.platform == "linux" else by_name(socket.gethostname())


def by_name(host: str) -> list[str]:
    """The IPv4 addresses to which a name leads; none where it leads nowhere."""
    try:
        rows = socket.getaddrinfo(host, None, socket.AF_INET, socket.SOCK_STREAM)
    except OSError:
        return []
    return list(dict.fromkeys(str(address[0]) for *_, address in rows))


def _by_interface() -> list[str]:
    addresses = []
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as asks:
        for _, interface in socket.if_nameindex():
            request = struct.pack("256s", interface.encode()[:15])
            try:
                answer = fcntl.ioctl(asks.fileno(), SIOCGIFADDR, request)
            except OSError:  # the interface has no address
                continue
            addresses.append(socket.inet_ntoa(answer[ADDRESS_AT]))
    return addresses


def this_boot() -> str:
    """A name of this boot, by which a killed process differs from a host that lost its power.

    Where the system does not name its boots, each call returns another name.
    """
    try:
        return BOOT_ID.read_text("ascii").strip()
    except OSError:
        return f"unknown {uuid4()}"


def home_of(user: str) -> Path | None:
    """The home directory of a user; None if there is no such user, or the system lists none."""
    if pwd is None:
        return None
    try:
        return Path(pwd.getpwnam(user).pw_dir)
    except KeyError:
        return None


def own_mark() -> str:
    """A word that another user of this machine does not have, for names of files."""
    return str(os.getuid()) if hasattr(os, "getuid") else getpass.getuser()
