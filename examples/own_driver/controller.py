"""The virtual controller of the press: what it is told and says, one JSON object in a line over TCP.

    python controller.py --port 4711

To the controller: {"id": "9-3", "do": "press", "with": {"strokes": 2}}, {"id": "9-4", "stop": "halt"}.
From it, at each change and five times a second: {"boot": 17, "state": "moving", "accepted": "9-3",
"done": "9-2", "facts": {"guard": "closed", "strokes": 0}}; more where there is more to say: "rejected" and
"failed", each a pair of an id and a word, "answered", a pair of an id and the answer.
"""

from __future__ import annotations

import argparse
import json
import random
import socket
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from typing import Any

BEAT_S = 0.2
SECONDS = {"open": 0.5, "close": 0.5, "press": 1.0, "measure": 0.2}
GUARD = {"open": "open", "close": "closed"}


class Line:
    """Listens on 127.0.0.1 and has one client at a time; `told` gets each line, in the line's own thread."""

    def __init__(self, told: Callable[[dict[str, Any]], None], port: int = 0) -> None:
        self._told = told
        self._server = socket.create_server(("127.0.0.1", port))
        self._client: socket.socket | None = None
        self._lock = threading.Lock()
        self.port = self._server.getsockname()[1]
        self._thread = threading.Thread(target=self._serve, name="line", daemon=True)
        self._thread.start()

    def say(self, said: dict[str, Any]) -> None:
        """Say something to whoever is there."""
        with self._lock, suppress(OSError):
            if self._client is not None:
                self._client.sendall(json.dumps(said).encode() + b"\n")

    def hang_up(self) -> None:
        """Close the connection that there is; the next one is welcome."""
        with self._lock, suppress(OSError):
            if self._client is not None:
                self._client.shutdown(socket.SHUT_RDWR)

    def close(self) -> None:
        self.hang_up()
        with suppress(OSError):
            self._server.shutdown(socket.SHUT_RDWR)
        self._server.close()
        self._thread.join()

    def _serve(self) -> None:
        with suppress(OSError):  # it was closed
            while True:
                client, _ = self._server.accept()
                with client:
                    self._client = client
                    with suppress(OSError), client.makefile("rb") as lines:
                        for line in lines:
                            self._told(json.loads(line))
                    with self._lock:
                        self._client = None


class Press:
    """The press itself: one motion or stroke at a time, which a halt ends half way."""

    def __init__(self, port: int) -> None:
        self._changed = threading.Condition()
        self._facts: dict[str, Any] = {"guard": "open", "strokes": 0}
        self._said: dict[str, Any] = {"boot": random.getrandbits(31)}
        self._work: tuple[dict[str, Any], float] | None = None  # what it does, and when that is done
        self._question: tuple[str, float] | None = None
        self._latched = False
        self.line = Line(self._told, port)

    def run(self) -> None:
        """Work and speak, for ever."""
        while True:
            with self._changed:
                self._pass_time(time.monotonic())
                self.line.say(self._words())
                self._changed.wait(min(BEAT_S, max(0.0, self._due() - time.monotonic())))

    def _due(self) -> float:
        due = [each[1] for each in (self._work, self._question) if each is not None]
        return min([*due, time.monotonic() + BEAT_S])

    def _pass_time(self, now: float) -> None:
        if self._work is not None and self._work[1] <= now:
            order, _ = self._work
            self._facts |= {"guard": GUARD[order["do"]]} if order["do"] in GUARD else order["with"]
            self._said["done"] = order["id"]
            self._work = None
        if self._question is not None and self._question[1] <= now:
            self._said["answered"] = (self._question[0], "good")
            self._question = None

    def _words(self) -> dict[str, Any]:
        state = "moving" if self._work else "latched" if self._latched else "stopped"
        return {**self._said, "state": state, "facts": self._facts}

    def _told(self, order: dict[str, Any]) -> None:
        with self._changed:
            word = self._stop(order["stop"]) if "stop" in order else self._take(order)
            if word is None:
                self._said["accepted"] = order["id"]
            else:
                self._said["rejected"] = (order["id"], word)
            self._changed.notify()

    def _stop(self, how: str) -> None:
        self._work = None
        self._latched = how == "latch" or (how == "halt" and self._latched)

    def _take(self, order: dict[str, Any]) -> str | None:
        due = time.monotonic() + SECONDS.get(order["do"], 0.0)
        if order["do"] not in SECONDS:
            return "unknown"
        if order["do"] == "measure":
            self._question = (order["id"], due)
            return None
        if self._work is not None:
            return "busy"
        if self._latched:
            return "paro"
        if order["do"] == "press" and self._facts["guard"] != "closed":
            return "guard_open"
        self._work = (order, due)
        return None


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--port", type=int, default=4711)
    press = Press(parser.parse_args().port)
    print(f"the press listens on port {press.line.port}", flush=True)
    with suppress(KeyboardInterrupt):
        press.run()
