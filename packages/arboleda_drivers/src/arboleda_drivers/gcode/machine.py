"""State machine of the driver `gcode`, without a line: the connection, the commands, what the plant hears.

What a firmware says and hears is its dialect's: `grbl.py`, `marlin.py`, `moonraker.py`.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence

from arboleda.drivers.port import lost
from arboleda.kinds.joints import Jointed, MoveJoints
from arboleda.model.commands import Command, Home, Stop, StopMode
from arboleda.model.messages import Report
from arboleda.model.plant_model import Robot
from arboleda_drivers.connections.link import Close, Closed, CommandNotSent, CommandRequest, Open, Opened
from arboleda_drivers.connections.stream import Event, Message, Write

from .settings import MM, Settings

AGAIN_S = 0.5  # between two tries to open the line
ANSWER_S = 3.0  # to a line, while nothing else is under way
HOMING_S = 120.0


class Machine(ABC):
    """State machine of one machine of axes; `step` takes events and returns actions and reports."""

    def __init__(self, devices: Sequence[Robot], settings: Settings) -> None:
        """Raises ValueError unless the device is one robot of axes, each with its letter."""
        if len(devices) != 1 or not isinstance(devices[0], Jointed):
            raise ValueError("a machine with G-code is one robot of axes")
        for _, problem in settings.problems(devices[0]):
            raise ValueError(problem)
        self._robot, self._settings = devices[0], settings
        self._out: list[Message] = []
        self._open, self._open_at = False, -math.inf
        self._boot = 1
        self._latched = self._left_at_work = self._news = False
        self._reported_at = -math.inf
        self._receipts: dict[str, str] = {}
        self._forget_link(0.0)

    @property
    def next_deadline(self) -> float:
        """The time (s) at which `step` is due even without events."""
        return self._query_at if self._open else self._open_at

    def step(self, now: float, events: Sequence[Event]) -> list[Message]:
        """Take events and the time, and return messages to act on; at most one is a report."""
        for event in events:
            self._take(now, event)
        self._pass_time(now)
        due = self._news or now >= self._reported_at + self._settings.poll_s
        if self._open and self._is_heard and due:
            self._news, self._reported_at = False, now
            self._out.append(self._report(now).again(now, **self._receipts))
        out, self._out = self._out, []
        return out

    # What is the dialect's.

    @abstractmethod
    def _forget_link(self, now: float) -> None:
        """Begin with a new line, of which nothing is known."""
        self._last_data_at, self._query_at = now, now
        self._is_heard = False  # has told a position on this line
        self._stop_id = ""

    def _greet(self, now: float) -> None:  # noqa: B027 - a controller that answers queries needs none
        """Begin to speak on a line that was opened just now."""

    @property
    @abstractmethod
    def _at_work(self) -> bool:
        """True while it moves, homes or is being stopped."""

    @abstractmethod
    def _listen(self, now: float, data: bytes) -> None:
        """Take what it says."""

    @abstractmethod
    def _wait(self, now: float) -> None:
        """Do what is due while the line is open."""

    @abstractmethod
    def _move(self, now: float, command: MoveJoints) -> None:
        """Begin a move, or refuse it."""

    @abstractmethod
    def _home(self, now: float, command: Home) -> None:
        """Begin to home, or refuse it."""

    @abstractmethod
    def _halt(self, now: float) -> None:
        """Bring it to a stop, and have nothing go on after that."""

    @abstractmethod
    def _report(self, now: float) -> Report:
        """The report of its present state, without the ends of commands."""

    # The connection.

    def _take(self, now: float, event: Event) -> None:
        if isinstance(event, CommandRequest):
            self._command(now, event.command)
        elif isinstance(event, Opened):
            self._forget_link(now)
            self._open = True
            self._greet(now)
        elif isinstance(event, Closed):
            if self._open or self._open_at == math.inf:  # else it was closed from here
                self._lose(now, event.why)
        elif self._open:
            self._listen(now, event.data)

    def _pass_time(self, now: float) -> None:
        if self._open:
            self._wait(now)
        elif self._open_at <= now:
            self._open_at = math.inf
            self._out.append(Open())

    def _close(self, now: float, why: str) -> None:
        self._out.append(Close())
        self._lose(now, why)

    def _lose(self, now: float, why: str) -> None:
        self._left_at_work = self._left_at_work or self._at_work
        self._open, self._open_at = False, now + AGAIN_S
        self._forget_link(now)
        self._out.append(lost(self._robot.name, at=now, why=f"{self._settings.peer}: {why}"))

    def _write(self, line: str) -> None:
        self._out.append(Write(data=line.encode("ascii") + b"\n"))

    # Commands.

    def _command(self, now: float, command: Command) -> None:
        if not self._is_heard:
            self._out.append(CommandNotSent(why=f"{self._settings.peer} is not connected"))
        elif isinstance(command, Stop):
            self._stop(now, command)
        elif self._at_work:
            self._reject(command.id, "busy")
        elif isinstance(command, MoveJoints):
            self._move(now, command)
        elif isinstance(command, Home):
            self._home(now, command)
        else:
            self._out.append(CommandNotSent(why=f"G-code has no word for {type(command).__name__} here"))

    def _stop(self, now: float, command: Stop) -> None:
        if command.mode is not StopMode.HALT:
            self._latched = command.mode is StopMode.LATCH
            self._news = True
        if command.mode is StopMode.CLEAR:
            self._tell(accepted=command.id)
            return
        self._stop_id = command.id
        self._halt(now)

    def _feed(self, start: Sequence[float], goal: Sequence[float]) -> float:
        """The speed of a straight move, mm/min, at which no axis is faster than it may be."""
        ways = [abs(there - here) for here, there in zip(start, goal, strict=True)]
        share = self._settings.model_speed_share
        time_s = max(way / (joint.speed * share) for way, joint in zip(ways, self._robot.joints, strict=True))
        return max(math.hypot(*ways) * MM / time_s * 60 if time_s > 0 else 60.0, 1.0)

    # What the plant hears.

    def _tell(self, **ids: str) -> None:
        self._receipts |= {name: id for name, id in ids.items() if id}
        self._news = True

    def _confirm_stop(self) -> None:
        """Tell that the last stop has come to its end."""
        self._tell(accepted=self._stop_id)
        self._stop_id = ""

    def _reject(self, id: str, word: str) -> None:
        if id:
            self._tell(rejected=id, refusal=word)
