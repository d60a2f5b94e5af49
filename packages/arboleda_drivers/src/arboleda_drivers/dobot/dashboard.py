"""Session with the dashboard of a controller: lines that are said, their replies in turn; its tool output."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from arboleda.drivers import NotSent, SetEffector
from arboleda_drivers.connections.receipts import Receipts
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


ASK_S = 1.0  # period of queries of the output


class ToolOutput:
    """Output at the tool, the effector of an arm: it is asked for its state, as no frame has it.

    `is_on` is None where that is unknown.
    """

    def __init__(self, number: int | None, dashboard: Dashboard, receipts: Receipts, now: float) -> None:
        self.is_on: bool | None = None
        self._asked_at = now
        self._number, self._dashboard, self._receipts = number, dashboard, receipts

    @property
    def next_deadline(self) -> float:
        return self._asked_at + ASK_S if self._dashboard.due.is_empty else math.inf

    def pass_time(self, now: float) -> None:
        if now >= self.next_deadline:
            self.ask(now)

    def switch(self, now: float, command: SetEffector) -> None:
        if self._number is None:
            raise NotSent("it has no tool_output in the plant file")

        def take(now: float, reply: Reply) -> None:
            if reply.error == 0:
                self.ask(now, command)  # accepted once it has been read back
            else:
                self._receipts.reject(command.id, reply.word)

        self._dashboard.say(now, f"ToolDOInstant({self._number},{int(command.on)})", take)

    def ask(self, now: float, switched: SetEffector | None = None) -> None:
        """Ask for its state, which a command has switched just now."""
        self._asked_at = now
        if self._number is None:
            return

        def take(now: float, reply: Reply) -> None:
            on = reply.number == 1 if reply.error == 0 and reply.number in (0, 1) else None
            self._receipts.news = self._receipts.news or on is not self.is_on
            self.is_on = on
            if switched is not None and on is switched.on:
                self._receipts.tell(accepted=switched.id)
            elif switched is not None:
                unread = f"output_not_read_back {reply.word}"
                # It has left: what takes effect later is still this command's.
                word = "output_does_not_follow" if reply.error == 0 else unread
                self._receipts.tell(failed=switched.id, failure=word)

        self._dashboard.say(now, f"GetToolDO({self._number})", take)
