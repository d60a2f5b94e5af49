"""Frame of the fuzzers: what a person types, how often which end came, and how long it took."""

from __future__ import annotations

import socket
import struct
import sys
import threading
import time
from collections import Counter
from collections.abc import Callable, Sequence
from contextlib import suppress
from random import Random
from typing import NoReturn

from arboleda.model.messages import Report
from arboleda_proofs.simulator.chance import Dice

from .words import words


def fuzz(run: Callable[[int, int], Counter[str]], usage: str | None, runs: int = 100_000) -> NoReturn:
    """Run it as often as is asked for, and say what came of it; `usage` answers any other words."""
    runs, seed = words(usage, runs, 1)
    began = time.perf_counter()
    for what, count in sorted(run(runs, seed).items()):
        print(f"{count:8} {what}")
    print(f"{runs} runs of seed {seed} in {time.perf_counter() - began:.0f} s: nothing went wrong")
    sys.exit()


def rounds(runs: int, seed: int, attempt: Callable[[Random, int], str]) -> Counter[str]:
    """Ends of so many attempts, counted; each has its number and a chance of its own.

    AssertionError with the number of the attempt that raised anything.
    """
    ends = Counter[str]()
    for number in range(runs):
        try:
            ends[attempt(Random(f"{seed}/{number}"), number)] += 1
        except Exception as error:  # noqa: BLE001 - whatever is raised fails the run
            fail(seed, number, error)
    return ends


def changed(
    data: bytes, chance: Random, odd: Sequence[bytes], *, head: int = 0, share: float = 0.0, most: int = 2048
) -> bytes:
    """At most `most` bytes of the data, with one to five changes: bytes lost, doubled or replaced.

    What replaces them is one of `odd`, or any bytes. That `share` of the changes is in the first `head`
    bytes, where a frame says what it is.
    """
    for _ in range(1 + int(chance.random() * 5)):
        at = int(chance.random() * (head if chance.random() < share else len(data) + 1))
        length = int(chance.random() * 9)
        kind = int(chance.random() * 4)
        if kind == 0:
            data = data[:at] + data[at + length :]
        elif kind == 1:
            data = data[:at] + data[at : at + length] + data[at:]
        elif kind == 2:
            data = data[:at] + chance.choice(odd) + data[at + length :]
        else:
            data = data[:at] + chance.randbytes(length) + data[at + length :]
    return data[:most]


def spoilt(dice: Dice, frame: bytes) -> bytes:
    """A frame with up to three mistakes: another byte or bit, bytes too many, or its end cut off."""
    changed = bytearray(frame)
    for _ in range(dice.below(4)):
        at = dice.below(len(changed))
        way = dice.below(4)
        if way == 0:
            changed[at] = dice.below(256)
        elif way == 1:
            changed = changed[: max(1, at)]
        elif way == 2:
            changed[at:at] = bytes(dice.below(256) for _ in range(4))
        else:
            changed[at] ^= 1 << dice.below(8)
    return bytes(changed)


class Liar:
    """Server that answers each request with what is `right`, spoilt; `sent` is what it answered last."""

    def __init__(
        self,
        dice: Dice,
        right: Callable[[bytes], bytes],
        greet: Callable[[socket.socket], None] = lambda _: None,
    ) -> None:
        self._dice, self._right, self._greet = dice, right, greet
        self._server = socket.create_server(("127.0.0.1", 0))
        self.port: int = self._server.getsockname()[1]
        self.request = self.sent = b""
        self._thread = threading.Thread(target=self._serve, daemon=True)
        self._thread.start()

    def close(self) -> None:
        with suppress(OSError):
            self._server.shutdown(socket.SHUT_RDWR)
        self._server.close()
        self._thread.join()

    def _serve(self) -> None:
        with suppress(OSError):
            while True:
                client, _ = self._server.accept()
                with client, suppress(OSError, struct.error):
                    self._greet(client)
                    while request := client.recv(512):
                        self.request = request
                        self.sent = spoilt(self._dice, self._right(request))
                        client.sendall(self.sent)
                        if self.sent != self._right(request):
                            break  # nothing more will come: who waits for the rest need not wait long


def picture(report: Report | None, said: Sequence[str]) -> tuple[object, ...]:
    """Values of a report under these names."""
    return tuple(getattr(report, name) for name in said)


def fail(seed: int, number: int, error: Exception) -> NoReturn:
    raise AssertionError(f"run {number} of seed {seed}: {type(error).__name__}: {error}") from error
