"""Hosts and the cable between them."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterable, Sequence
from contextlib import AbstractContextManager
from pathlib import Path

from ..processes import PATIENCE_S, environment
from . import namespaces
from .cable import DEVICE
from .clocks import Clocks


class Network:
    """`hosts` on one cable; `spoil` some of its directed links, and all others are perfect. Each has a wall
    clock of its own, whose file is in `folder`."""

    def __init__(self, hosts: Sequence[str], folder: Path) -> None:
        self.clocks = Clocks(folder, hosts)
        self._names = {host: f"arboleda-{os.getpid()}-{host}" for host in hosts}
        self._cable: subprocess.Popen[str] | None = None
        try:
            for name in self._names.values():
                namespaces.add(name)
            self._cable = self._start_cable()
            for number, name in enumerate(self._names.values(), start=1):
                namespaces.join(name, DEVICE, f"10.77.0.{number}/24")
        except BaseException:  # whatever it is, no namespace is left behind
            self.close()
            raise

    def address(self, host: str) -> str:
        """The address at which the others reach it."""
        return f"10.77.0.{list(self._names).index(host) + 1}"

    def on(self, host: str) -> tuple[str, ...]:
        """The beginning of a command that runs there."""
        return "ip", "netns", "exec", self._names[host], *self.clocks.before(host)

    def inside(self, host: str) -> AbstractContextManager[None]:
        """Sockets that this thread opens meanwhile are those of that host."""
        return namespaces.inside(self._names[host])

    def spoil(self, links: Iterable[tuple[str, str]], *, loss: float = 1.0, delay_s: float = 0.0) -> None:
        """These links, each in its one direction, lose so much, and are so late."""
        rows = [[self._names[source], self._names[to], loss, delay_s] for source, to in links]
        assert self._cable is not None and self._cable.stdin is not None
        self._cable.stdin.write(json.dumps(rows) + "\n")
        self._cable.stdin.flush()

    def heal(self) -> None:
        """All links are perfect."""
        self.spoil(())

    def close(self) -> None:
        """No namespace is left."""
        if self._cable is not None:
            assert self._cable.stdin is not None
            self._cable.stdin.close()
            self._cable.wait(PATIENCE_S)
            self._cable = None
        self.clocks.close()
        for name in self._names.values():
            namespaces.remove(name)

    def _start_cable(self) -> subprocess.Popen[str]:
        cable = subprocess.Popen(
            [sys.executable, "-m", "arboleda_kills.hosts.cable", *self._names.values()],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env=environment(),
        )
        assert cable.stdout is not None
        if not cable.stdout.readline():
            raise namespaces.NoNamespaces("the cable did not come up: are there TAP devices (/dev/net/tun)?")
        return cable
