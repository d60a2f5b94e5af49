"""Base of machines of arms behind TCP connections: their link, commands, stops, rest and reports."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Any

from arboleda.drivers.port import lost
from arboleda.kinds.arm import Arm, SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.model.commands import Command, Home, Stop, StopMode
from arboleda.model.messages import MotionState, Report
from arboleda.model.plant_model import Robot

from .link import Close, Closed, CommandNotSent, CommandRequest, Open, Opened

AGAIN_S = 0.5  # between two tries to connect
SILENT_S = 1.0  # without a new frame
REPORT_S = 0.1  # a report at least so often
SETTLE_S = 0.3  # an arm that has not moved for so long stands still
CLOCK_S = 2  # the moment of switching on is known to this


class TcpArm(ABC):
    """State machine of one arm of six joints behind one controller; a maker's machine fills in its protocol.

    `step` takes events and returns actions and reports.
    """

    def __init__(self, devices: Sequence[Robot], *, host: str, kind: str) -> None:
        """Raises ValueError unless the device is one arm of six joints; `kind` names the controller."""
        if len(devices) != 1 or not isinstance(devices[0], Arm) or len(devices[0].joints) != 6:
            raise ValueError(f"{kind} is one arm of six joints")
        self._arm, self._host, self._kind = devices[0], host, kind
        self._out: list[Any] = []
        self._open = False
        self._open_at = -math.inf
        self._latched = False
        self._left_at_work = False
        self._news = False
        self._reported_at = -math.inf
        self._ids: dict[str, str] = {}
        self._forget_arm(0.0)
        self._forget_link(0.0)

    @property
    def next_deadline(self) -> float:
        """The time (s) at which `step` is due even without events."""
        return min(self._link_deadline, self._last_data_at + SILENT_S) if self._open else self._open_at

    def step(self, now: float, events: Sequence[Any]) -> list[Any]:
        """Take events and the time, and return messages to act on; at most one is a report of the arm."""
        for event in events:
            self._take(now, event)
        if not self._open:
            if self._open_at <= now:
                self._open_at = math.inf
                self._out.append(Open())
        elif why := self._overdue(now) or self._silence(now):
            self._close(now, why)
        else:
            self._poll(now)
        if self._open and self._is_known and (self._news or now >= self._reported_at + REPORT_S):
            self._news, self._reported_at = False, now
            self._out.append(self._report(now).again(now, **self._ids))
        out, self._out = self._out, []
        return out

    def _take(self, now: float, event: Any) -> None:
        if isinstance(event, CommandRequest):
            self._ask(now, event.command)
        elif isinstance(event, Opened):
            self._opened(now)
        elif isinstance(event, Closed):
            if self._open or self._open_at == math.inf:  # else it was closed from here
                self._lose(now, event.why)
        elif self._open:
            self._hear(now, event)

    # The link.

    def _opened(self, now: float) -> None:
        self._forget(now)
        self._open = True
        self._greet(now)

    def _stop_what_was_left(self, now: float) -> None:
        """Stop the work of an earlier connection: nobody waits for it any more."""
        if self._left_at_work:
            self._stop(now)
        self._left_at_work = False

    def _close(self, now: float, why: str) -> None:
        self._out.append(Close())
        self._lose(now, why)

    def _silence(self, now: float) -> str:
        silent = now >= self._last_data_at + SILENT_S
        return f"its feedback has stood still for {SILENT_S:g} s" if silent else ""

    def _lose(self, now: float, why: str) -> None:
        self._left_at_work = self._left_at_work or self._is_at_work
        self._open, self._open_at = False, now + AGAIN_S
        self._forget(now)
        self._out.append(lost(self._arm.name, at=now, why=f"{self._host}: {why}"))

    def _forget(self, now: float) -> None:
        self._forget_arm(now)
        self._forget_link(now)

    def _forget_arm(self, now: float) -> None:
        self._rest_since: float | None = None
        self._stopping_since: float | None = None  # inf: the stop is not answered yet
        self._last_data_at = now

    # Commands.

    def _ask(self, now: float, command: Command) -> None:
        if not self._open:
            self._out.append(CommandNotSent(why=f"{self._host} is not connected"))
        elif isinstance(command, Stop):
            self._ask_stop(now, command)
        elif isinstance(command, SetEffector):
            self._switch(now, command)
        elif self._is_at_work:
            self._reject(command.id, "busy")
        elif isinstance(command, MoveJoints):
            self._move(now, command)
        elif isinstance(command, Home):
            self._ready(now, command)
        else:
            self._out.append(CommandNotSent(why=f"{self._kind} has no word for {type(command).__name__}"))

    def _ask_stop(self, now: float, command: Stop) -> None:
        if command.mode is not StopMode.HALT:
            self._latched = command.mode is StopMode.LATCH
            self._news = True
        if command.mode is StopMode.CLEAR:
            self._clear(now, command.id)
        else:
            self._drop_work()
            self._stop(now, command.id)

    # What its frames show.

    def _see_rest(self, now: float, *, still: bool, broken: bool) -> None:
        """Note whether the arm stands still; one that is broken off stands still at once."""
        self._rest_since = (self._rest_since or now) if still else None
        if self._stopping_since is None:
            return
        rests = self._rest_since is not None and now - max(self._rest_since, self._stopping_since) >= SETTLE_S
        if rests or broken:
            self._stopping_since, self._news = None, True

    # What the plant hears.

    def _tell(self, **ids: str) -> None:
        self._ids |= {name: id for name, id in ids.items() if id}
        self._news = True

    def _reject(self, id: str, word: str) -> None:
        if id:
            self._tell(rejected=id, refusal=word)

    def _shown(self, state: MotionState, *, readies: bool) -> MotionState:
        """The state for the plant of an arm in this one; `readies`: it is being made ready."""
        if state is MotionState.FAULT and readies:
            return MotionState.NOT_HOMED
        if state is MotionState.FAULT and self._latched:
            return MotionState.STOP_LATCHED  # so that the stop can be cleared, and the fault after it
        if state is not MotionState.STOPPED:
            return state
        if self._is_at_work or self._stopping_since is not None:
            return MotionState.MOVING  # it may begin to move at any moment, or has not come to rest
        return MotionState.STOP_LATCHED if self._latched else state

    # What is the maker's.

    @property
    @abstractmethod
    def _link_deadline(self) -> float:
        """The time (s) of the next deadline of an open link, beside that of silence."""

    @property
    @abstractmethod
    def _is_known(self) -> bool:
        """True once a frame has shown the arm."""

    @property
    @abstractmethod
    def _is_at_work(self) -> bool:
        """True while the arm does what it was commanded."""

    @abstractmethod
    def _greet(self, now: float) -> None:
        """Say what is said first over new connections."""

    @abstractmethod
    def _hear(self, now: float, event: Any) -> None:
        """Take bytes of the controller."""

    @abstractmethod
    def _overdue(self, now: float) -> str:
        """The reason to give the link up, as what was awaited has not come; "" for none."""

    @abstractmethod
    def _poll(self, now: float) -> None:
        """Say what is due while the link is open."""

    @abstractmethod
    def _forget_link(self, now: float) -> None:
        """Forget all that was heard and said over the connections."""

    @abstractmethod
    def _drop_work(self) -> None:
        """Forget the work, which is being stopped."""

    @abstractmethod
    def _move(self, now: float, command: MoveJoints) -> None:
        """Begin a move."""

    @abstractmethod
    def _ready(self, now: float, command: Home) -> None:
        """Begin to make the arm ready."""

    @abstractmethod
    def _switch(self, now: float, command: SetEffector) -> None:
        """Switch the output that is the effector."""

    @abstractmethod
    def _stop(self, now: float, id: str = "") -> None:
        """Stop the arm; `id` is the command's that asked for it, if any did."""

    @abstractmethod
    def _clear(self, now: float, id: str) -> None:
        """Accept that the latched stop is cleared."""

    @abstractmethod
    def _report(self, now: float) -> Report:
        """The arm as its last frame shows it, without ids."""
