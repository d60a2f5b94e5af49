"""State machine of one robot of joints: its link, the commands to it, and when the plant hears of it.

What is said over the link is its maker's: a `Controller`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from arboleda.drivers import Command, Home, MoveJoints, NotSent, SetEffector, Stop, StopMode, lost

from .controller import Controller
from .link import Close, Closed, CommandNotSent, CommandRequest, LinkBroken, Open, Opened

AGAIN_S = 0.5  # between two tries to open the link
REPORT_S = 0.1  # a report at least so often


class ControllerMachine:
    """State machine of one robot behind its controller; `step` takes events, returns actions and reports."""

    def __init__(self, controller: Controller, *, report_s: float = REPORT_S) -> None:
        self._controller, self._report_s = controller, report_s
        self._open, self._open_at = False, -math.inf
        controller.forget(0.0)

    @property
    def next_deadline(self) -> float:
        """The time (s) at which `step` is due even without events."""
        return self._controller.next_deadline if self._open else self._open_at

    def step(self, now: float, events: Sequence[Any]) -> list[Any]:
        """Take events and the time, and return messages to act on; at most one is a report of the robot."""
        controller = self._controller
        for event in events:
            with self._closing(now):
                self._take(now, event)
        with self._closing(now):
            self._pass_time(now)
        if self._open and controller.is_known and controller.receipts.is_due(now, self._report_s):
            controller.out.append(controller.receipts.on(now, controller.report(now)))
        out = controller.out.copy()
        controller.out.clear()
        return out

    @contextmanager
    def _closing(self, now: float) -> Iterator[None]:
        """Context after which a link that broke is closed."""
        try:
            yield
        except LinkBroken as error:
            self._controller.out.append(Close())
            self._lose(now, str(error))

    def _take(self, now: float, event: Any) -> None:
        if isinstance(event, CommandRequest):
            try:
                self._command(now, event.command)
            except NotSent as error:
                self._controller.out.append(CommandNotSent(why=str(error)))
        elif isinstance(event, Opened):
            self._controller.forget(now)
            self._open = True
            self._controller.greet(now)
        elif isinstance(event, Closed):
            if self._open or self._open_at == math.inf:  # else it was closed from here
                self._lose(now, event.why)
        elif self._open:
            self._controller.hear(now, event)

    def _pass_time(self, now: float) -> None:
        if self._open:
            self._controller.pass_time(now)
        elif self._open_at <= now:
            self._open_at = math.inf
            self._controller.out.append(Open())

    def _lose(self, now: float, why: str) -> None:
        controller = self._controller
        controller.has_leftover = controller.has_leftover or controller.may_move_on
        self._open, self._open_at = False, now + AGAIN_S
        controller.forget(now)
        controller.out.append(lost(controller.robot.name, at=now, why=f"{controller.peer}: {why}"))

    def _command(self, now: float, command: Command) -> None:
        controller = self._controller
        if not self._open and isinstance(command, Stop) and self._open_at < math.inf:
            self._open_at = now  # the link waits for its next try; what was left at work is stopped by that
        if not self._open or not controller.takes_commands:
            raise NotSent(f"{controller.peer} is not connected")
        if isinstance(command, Stop):
            self._stop(now, command)
        elif isinstance(command, SetEffector) and controller.effector is not None:
            controller.effector.switch(now, command)
        elif controller.is_busy:
            controller.receipts.reject(command.id, "busy")
        elif isinstance(command, MoveJoints):
            controller.move(now, command)
        elif isinstance(command, Home):
            controller.home(now, command)
        else:
            raise NotSent(f"{controller.kind} has no word for {type(command).__name__}")

    def _stop(self, now: float, command: Stop) -> None:
        controller = self._controller
        if command.mode is not StopMode.HALT:
            controller.is_latched = command.mode is StopMode.LATCH
            controller.receipts.news = True
        if command.mode is StopMode.CLEAR:
            controller.clear(now, command.id)
        else:
            controller.stop(now, command.id)
