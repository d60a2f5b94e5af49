"""The cable between all hosts, as a process: frames of Ethernet from one to the others, some late, some lost.

`python -m arboleda_kills.hosts.cable NAMESPACE...`. It makes a device `eth0` in each, prints a line once they
are there, reads lines of JSON, `[[FROM, TO, LOSS, DELAY_S], ...]`: all directed links that are not perfect,
and ends with its input. `tc netem` does the same in kernels that have it; this needs only TAP devices.
"""

from __future__ import annotations

import fcntl
import heapq
import json
import os
import random
import selectors
import struct
import sys
import time
from collections.abc import Iterable, Sequence
from contextlib import suppress
from itertools import count

from .namespaces import inside

DEVICE = "eth0"
TUNSETIFF, IFF_TAP, IFF_NO_PI = 0x400454CA, 0x0002, 0x1000
LONGEST = 2048
MAC = 6
Link = tuple[str, str]


class Cable:
    """Reads frames, decides what becomes of each copy, writes them when they are due."""

    def __init__(self, hosts: Sequence[str], dice: random.Random) -> None:
        self.ends = {host: _tap(host) for host in hosts}
        self.links: dict[Link, tuple[float, float]] = {}  # (loss, delay_s) of those that are not perfect
        self._dice = dice
        self._at: dict[bytes, str] = {}  # by MAC address, the host that it was heard from
        self._late: list[tuple[float, int, str, bytes]] = []
        self._order = count()

    @property
    def wait_s(self) -> float | None:
        """Until the next late frame is due."""
        return max(0.0, self._late[0][0] - time.monotonic()) if self._late else None

    def read(self, host: str) -> None:
        """All that waits at this end."""
        while True:
            try:
                frame = os.read(self.ends[host], LONGEST)
            except BlockingIOError:
                return
            self._at[frame[MAC : 2 * MAC]] = host
            for other in self._to(host, frame[:MAC]):
                self._carry(host, other, frame)

    def deliver(self) -> None:
        """Deliver the frames that are due."""
        now = time.monotonic()
        while self._late and self._late[0][0] <= now:
            _, _, host, frame = heapq.heappop(self._late)
            self._write(host, frame)

    def _to(self, host: str, address: bytes) -> Iterable[str]:
        known = self._at.get(address)
        return [each for each in self.ends if each != host] if known is None else [known]

    def _carry(self, host: str, other: str, frame: bytes) -> None:
        loss, delay_s = self.links.get((host, other), (0.0, 0.0))
        if loss and self._dice.random() < loss:
            return
        if delay_s:
            heapq.heappush(self._late, (time.monotonic() + delay_s, next(self._order), other, frame))
        else:
            self._write(other, frame)

    def _write(self, host: str, frame: bytes) -> None:
        with suppress(OSError):  # a host that is down, or does not keep up: as with any switch
            os.write(self.ends[host], frame)


def _tap(host: str) -> int:
    with inside(host):
        end = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
        fcntl.ioctl(end, TUNSETIFF, struct.pack("16sH22x", DEVICE.encode(), IFF_TAP | IFF_NO_PI))
        return end


def main() -> None:
    cable = Cable(sys.argv[1:], random.Random(1))
    waiting = selectors.DefaultSelector()
    for host, end in cable.ends.items():
        waiting.register(end, selectors.EVENT_READ, host)
    waiting.register(sys.stdin, selectors.EVENT_READ, None)
    print("there", flush=True)
    while True:
        for key, _ in waiting.select(cable.wait_s):
            if key.data is not None:
                cable.read(key.data)
                continue
            line = sys.stdin.readline()
            if not line:
                return
            cable.links = {(source, to): (loss, delay_s) for source, to, loss, delay_s in json.loads(line)}
        cable.deliver()


if __name__ == "__main__":
    main()
