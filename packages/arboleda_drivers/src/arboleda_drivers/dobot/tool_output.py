"""Output at the tool that is the effector of an arm: it is asked for its state, as no frame has it."""

from __future__ import annotations

from arboleda.drivers import NotSent, SetEffector
from arboleda_drivers.connections.receipts import Receipts

from .dashboard import Dashboard
from .replies import Reply

ASK_S = 1.0  # period of queries of the output


class ToolOutput:
    """Output of this number; `is_on` is None where that is unknown."""

    def __init__(self, number: int | None, dashboard: Dashboard, receipts: Receipts, now: float) -> None:
        self.is_on: bool | None = None
        self._asked_at = now
        self._number, self._dashboard, self._receipts = number, dashboard, receipts

    @property
    def next_deadline(self) -> float:
        return self._asked_at + ASK_S

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
                self._receipts.reject(switched.id, "output_does_not_follow" if reply.error == 0 else unread)

        self._dashboard.say(now, f"GetToolDO({self._number})", take)
