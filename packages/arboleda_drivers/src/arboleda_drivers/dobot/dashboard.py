"""Session with the dashboard of a controller: lines that are said, and their replies in turn."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from arboleda_drivers.connections.replies_due import RepliesDue

from .replies import NotAReply, Reply, ReplyReader

Take = Callable[[float, Reply], None]


@dataclass(frozen=True, kw_only=True)
class SendLine:
    """Message: send this text to the dashboard."""

    text: str


def ignore(now: float, reply: Reply) -> None:
    """Does nothing with a reply: the next frames show its effect."""


class Dashboard:
    """Dashboard over one connection."""

    def __init__(self, out: list[Any]) -> None:
        self.due = RepliesDue[Reply]()
        self._out, self._replies = out, ReplyReader()

    def say(self, now: float, text: str, take: Take = ignore) -> None:
        self.due.add(now, text.partition("(")[0], take)
        self._out.append(SendLine(text=text))

    def hear(self, now: float, data: bytes) -> None:
        for reply in self._replies.feed(data):
            first = self.due.pop()
            if first is None:
                raise NotAReply(f"nobody asked for an answer to {reply.command}")
            if reply.command and reply.command.lower() != first.name.lower():
                raise NotAReply(self._out_of_turn(first.name, reply.command))
            first.take(now, reply)

    def _out_of_turn(self, first: str, answered: str) -> str:
        """The objection to an answer that is not to the first line without one."""
        if answered.lower() in (each.lower() for each in self.due.names):
            return f"it has not answered {first}, and has answered {answered}, which it was told later"
        return f"it answers {answered} where {first} was said"
