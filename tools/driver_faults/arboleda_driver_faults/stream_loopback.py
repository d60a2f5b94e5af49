"""Driver and virtual device at one stream of bytes, connected without a line, under a clock moved by hand."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable

from arboleda.kinds.joints import MoveJoints
from arboleda.model.commands import Command
from arboleda.model.messages import Report
from arboleda_drivers.connections.link import Close, Closed, CommandNotSent, CommandRequest, Open, Opened
from arboleda_drivers.connections.stream import Event, Message, Received, StreamMachine, Write
from arboleda_drivers.virtual.pty_line import LineMachine


class Loopback:
    """Driver and virtual device, connected: each gets the other's bytes at once.

    `hear` takes the reports that the plant would get; `written` keeps what the driver wrote, `given` counts
    the moves that it was given.
    """

    def __init__(
        self, driver: StreamMachine, far: LineMachine, hear: Callable[[Report], None], now: float
    ) -> None:
        self.driver, self.far, self.now = driver, far, now
        self.written: list[bytes] = []
        self.given = 0
        self._hear = hear
        self._to_far: deque[bytes] = deque()
        self._to_driver: deque[Event] = deque()
        self._connected = False

    @property
    def next_deadline(self) -> float:
        return max(self.now, min(self.far.next_deadline, self.driver.next_deadline))

    def ask(self, command: Command) -> str | None:
        """Command the device; returns the reason why the command could not leave, or None."""
        self.given += isinstance(command, MoveJoints)
        out = self._step_driver(CommandRequest(command=command))
        self._settle()
        return next((each.why for each in out if isinstance(each, CommandNotSent)), None)

    def hear(self, data: bytes) -> None:
        """Have the driver hear bytes that the virtual device did not say."""
        self._to_driver.append(Received(data=data))
        self._settle()

    def pass_time(self, now: float) -> None:
        """Let both do everything due by now."""
        self.now = now
        self._step_far(b"")
        self._step_driver()
        self._settle()

    def _settle(self) -> None:
        """Pass bytes in order until neither has any left."""
        while self._to_far or self._to_driver:
            while self._to_far:
                self._step_far(self._to_far.popleft())
            while self._to_driver:
                self._step_driver(self._to_driver.popleft())

    def _step_driver(self, *events: Event) -> list[Message]:
        out = self.driver.step(self.now, events)
        for message in out:
            self._do(message)
        return out

    def _do(self, message: Message) -> None:
        if isinstance(message, Report):
            self._hear(message)
        elif isinstance(message, Open):
            self._connected = not self.far.is_unplugged
            self._to_driver.append(Opened() if self._connected else Closed(why="no such file"))
        elif isinstance(message, Close):
            self._connected = False
            self._to_driver.clear()
        elif isinstance(message, Write) and self._connected:
            self.written.append(message.data)
            self._to_far.append(message.data)

    def _step_far(self, data: bytes) -> None:
        answer = self.far.step(self.now, data)
        if self._connected and self.far.is_unplugged:
            self._connected = False
            self._to_driver.append(Closed(why="the line is gone"))
        elif self._connected and answer:
            self._to_driver.append(Received(data=answer))
