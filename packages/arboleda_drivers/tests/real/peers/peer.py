"""A device by other authors, in a process of its own, that says what it does and when."""

from __future__ import annotations

import os
import subprocess
import threading
from contextlib import suppress
from dataclasses import dataclass

from tests.patience import PATIENCE_S, until

BEGIN, END, DROP, BOOT = "begin", "end", "drop", "boot"
READY = "ready"
ENDS_S = 1.0


@dataclass(frozen=True)
class Did:
    """Deed of a peer with an order, and its time by the clock of this machine."""

    word: str
    order: str
    at: float


class Peer:
    """A program that prints `ready PORT`, then `WORD ORDER AT` for what it does; `say` tells its input."""

    def __init__(self, *command: str, **environment: str) -> None:
        self.did: list[Did] = []
        self.port = -1
        self._process = subprocess.Popen(
            command,
            env=os.environ | environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        self._thread = threading.Thread(target=self._read, name="peer", daemon=True)
        self._thread.start()
        until(lambda: self.port >= 0 or not self._thread.is_alive())
        assert self.port >= 0, "it has ended"

    def say(self, *words: object) -> None:
        assert self._process.stdin is not None
        print(*words, file=self._process.stdin, flush=True)

    def close(self) -> None:
        assert self._process.stdin is not None and self._process.stdout is not None
        self._process.stdin.close()
        with suppress(subprocess.TimeoutExpired):  # it may not look at its input
            self._process.wait(ENDS_S)
        self._process.kill()
        self._process.wait(PATIENCE_S)
        self._thread.join()
        self._process.stdout.close()

    def _read(self) -> None:
        assert self._process.stdout is not None
        for line in self._process.stdout:
            word, *values = line.split() or [""]
            if word == READY:
                self.port = int(values[0])
            elif word in (BEGIN, END, DROP, BOOT):
                self.did.append(Did(word, values[0], float(values[1])))
