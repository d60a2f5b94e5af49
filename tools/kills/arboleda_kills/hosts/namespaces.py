"""Network namespaces of Linux: hosts of their own on one machine, as far as networks go. Needs root."""

from __future__ import annotations

import ctypes
import os
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

CLONE_NEWNET = 0x40000000
FOLDER = Path("/var/run/netns")
OWN = Path("/proc/thread-self/ns/net")


class NoNamespaces(Exception):
    """This machine, or this user, makes no network namespaces; the sentence says why."""


def add(name: str) -> None:
    """A host without links; NoNamespaces where there can be none."""
    _ip("netns", "add", name)
    _ip("-n", name, "link", "set", "lo", "up")


def join(name: str, device: str, address: str) -> None:
    """Give a device of a host its address; multicast leaves by it."""
    _ip("-n", name, "addr", "add", address, "dev", device)
    _ip("-n", name, "link", "set", device, "up")
    _ip("-n", name, "route", "add", "224.0.0.0/4", "dev", device)


def remove(name: str) -> None:
    """The host is gone, once its last process is; idempotent."""
    subprocess.run(["ip", "netns", "del", name], capture_output=True, check=False)


@contextmanager
def inside(name: str) -> Iterator[None]:
    """Sockets that this thread opens meanwhile are those of that host."""
    before = os.open(OWN, os.O_RDONLY)
    try:
        _enter(FOLDER / name)
        try:
            yield
        finally:
            _set(before)
    finally:
        os.close(before)


def _enter(path: Path) -> None:
    there = os.open(path, os.O_RDONLY)
    try:
        _set(there)
    finally:
        os.close(there)


def _set(namespace: int) -> None:
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.setns(namespace, CLONE_NEWNET):
        raise NoNamespaces(os.strerror(ctypes.get_errno()))


def _ip(*words: str) -> None:
    try:
        done = subprocess.run(["ip", *words], capture_output=True, text=True, check=False)
    except FileNotFoundError:
        raise NoNamespaces("iproute2 is not installed: apt-get install iproute2") from None
    if done.returncode:
        raise NoNamespaces(f"ip {' '.join(words)}: {done.stderr.strip()}")
