"""The meter, played by hand: a server that is told what to say."""

from __future__ import annotations

import queue
import socket
import threading
from contextlib import suppress
from typing import Any

RESULTS = {"good": "0", "bad": "1"}
MEANS = {"RES": "work", "VOLT": "other", "CONT": "ask"}


class PlayedMeter:
    """It measures nothing; its registers show what the test says."""

    def __init__(self) -> None:
        self.orders: queue.Queue[tuple[str, Any]] = queue.Queue()
        self.port = 0
        self._events = self._condition = self._number = 0
        self._open = 0  # the order that it works on
        self._error, self._result, self._function = '0,"No error"', "0", "RES"
        self._lock = threading.Lock()
        self._quiet = threading.Event()
        self.come_back()

    def accepts(self, ref: int) -> None:
        self._condition = 16

    def finishes(self, ref: int, *, there: bool = True) -> None:
        self.answers(ref, "good")

    def answers(self, ref: int, word: str) -> None:
        if ref == self._open:  # it says an answer once
            self._show(1, result=RESULTS[word])

    def rejects(self, ref: int) -> str:
        self._show(16, error='-221,"Settings conflict"')
        return "Settings conflict"

    def gives_up(self, ref: int) -> str:
        self._show(8, error='-240,"Hardware error"')
        return "Hardware error"

    def rests(self) -> None:
        self._show(1 if self._condition else 0)  # it ends what nobody waits for any more

    def latches(self) -> None:
        self._show(0)

    def boots(self) -> None:
        self._show(128)

    def hush(self) -> None:
        self._quiet.set()

    def vanish(self) -> None:
        for each in (self._client, self._server):
            with suppress(OSError):
                each.shutdown(socket.SHUT_RDWR)
        self._thread.join()
        self._server.close()
        self._show(0)

    def come_back(self) -> None:
        self._server = self._client = socket.create_server(("127.0.0.1", self.port))
        self.port = self._server.getsockname()[1]
        self._thread = threading.Thread(target=self._serve, name="played meter", daemon=True)
        self._thread.start()

    def close(self) -> None:
        self.vanish()

    def _show(self, event: int, error: str = '0,"No error"', result: str = "0") -> None:
        with self._lock:
            self._events |= event
            self._condition, self._open, self._error, self._result = 0, 0, error, result

    def _serve(self) -> None:
        with suppress(OSError):  # it vanished
            while True:
                self._client, _ = self._server.accept()
                with suppress(OSError), self._client, self._client.makefile("rw", encoding="ascii") as line:
                    for text in line:
                        self._obey(text.strip(), line)

    def _obey(self, text: str, line: Any) -> None:
        with self._lock:
            said = [answer for each in text.split(";") if (answer := self._do(each.lstrip(":"))) is not None]
        if said and not self._quiet.is_set():
            line.write(";".join(said) + "\n")
            line.flush()

    def _do(self, word: str) -> str | None:
        if word == "*ESR?":
            events, self._events = self._events, 0
            return str(events)
        if word == "INIT":
            self._number = self._open = self._number + 1
            self.orders.put((MEANS[self._function], self._number))
        elif word == "ABOR":
            self.orders.put(("halt", None))
        elif word == "*CLS":
            self._events = 0
        self._function = word.removeprefix("CONF:") if word.startswith("CONF:") else self._function
        shown = {"STAT:OPER:COND?": str(self._condition), "SYST:ERR?": self._error}
        return {**shown, "CALC:LIM:FAIL?": self._result}.get(word)
