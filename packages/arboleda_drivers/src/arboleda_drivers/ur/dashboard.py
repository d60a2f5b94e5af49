"""Session with the dashboard of a controller: lines that are said, their answers, and who has control."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from arboleda.drivers import plain
from arboleda_drivers.connections.link import LinkBroken
from arboleda_drivers.connections.receipts import Receipts
from arboleda_drivers.connections.replies_due import RepliesDue

from .port_data import DASHBOARD, Send

ASK_S = 1.0  # period of the question whether it is in remote control
LOCAL = "local_control"
LONGEST_LINE = 4096
GREETING = "Universal Robots Dashboard Server"


def ignore(now: float, reply: str) -> None:
    """Does nothing with a reply: the next frames show its effect."""


class Dashboard:
    """Dashboard over one connection; with `is_read_only` programs are refused until there is another one."""

    def __init__(self, out: list[Any], receipts: Receipts, now: float) -> None:
        self.is_local = self.is_read_only = False
        self.due = RepliesDue[str]()
        self._out, self._receipts = out, receipts
        self._rest = b""
        self._asked_at = now

    @property
    def next_deadline(self) -> float:
        return self._asked_at + ASK_S if self.due.is_empty else self.due.deadline

    def greet(self, now: float) -> None:
        self.due.add(now, "the connection to its dashboard", _check_greeting)

    def say(self, now: float, text: str, take: Callable[[float, str], None] = ignore) -> None:
        self.due.add(now, text, take)
        self._out.append(Send(port=DASHBOARD, data=text.encode() + b"\n"))

    def hear(self, now: float, data: bytes) -> None:
        *lines, self._rest = (self._rest + data).split(b"\n")
        if len(self._rest) > LONGEST_LINE:
            raise LinkBroken("a reply of its dashboard does not end")
        for line in lines:
            text = plain(line.decode("utf-8", "replace").strip(), 200)
            due = self.due.pop()
            if due is None:
                raise LinkBroken(f"its dashboard says {text[:60]!r}, and nobody asked")
            due.take(now, text)

    def ask_control(self, now: float) -> None:
        """Ask whether it is in remote control, if that is due."""
        if now >= self._asked_at + ASK_S and self.due.is_empty:
            self._asked_at = now
            self.say(now, "is in remote control", self._take_control)

    def _take_control(self, now: float, reply: str) -> None:
        """Note whether it is in remote control; a CB3, which knows no such thing, always is."""
        was, self.is_local = self.is_local, reply.lower().startswith("false")
        self._receipts.news = self._receipts.news or was is not self.is_local
        if self.is_read_only and not self.is_local:
            raise LinkBroken("it is in remote control again, which takes a new connection")

    def rejects(self, id: str) -> bool:
        """True where a command is rejected, as the controller is in local control."""
        if self.is_local:
            self._receipts.reject(id, LOCAL)
        return self.is_local


def _check_greeting(now: float, reply: str) -> None:
    if GREETING not in reply:
        raise LinkBroken(f"its dashboard greets with {reply[:60]!r}")
