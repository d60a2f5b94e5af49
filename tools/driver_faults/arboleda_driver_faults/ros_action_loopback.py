"""Driver and virtual action server, connected without ROS 2, under a clock that is moved by hand."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from arboleda.model.commands import Command
from arboleda.model.messages import Report
from arboleda_drivers.connections.link import CommandNotSent, CommandRequest
from arboleda_drivers.nav2.localisation import MapPose
from arboleda_drivers.ros_action.events import (
    CancelAll,
    CancelAnswer,
    Event,
    GoalAnswer,
    GoalList,
    GoalResult,
    ListedGoal,
    Measurement,
    SendGoal,
    ServersFound,
)
from arboleda_drivers.ros_action.events import Message as Told
from arboleda_drivers.ros_action.machine import Machine
from arboleda_drivers.ros_action.virtual.machine import (
    CancelDecision,
    CancelRequest,
    GoalRequest,
    VirtualServer,
)

LOOK_S = 0.1  # as often as the driver looks which servers there are


class Loopback:
    """Driver and virtual action server, connected: each gets the other's messages at once.

    `read` makes of a goal of the driver what the server's body takes, as the message between them does.
    `listed` are the goals that the server accepted, by the ids of their messages, and `measured` the last
    measurement of each kind, which topics of ROS 2 may retain: both outlive the driver.
    """

    def __init__(
        self,
        driver: Machine,
        server: VirtualServer,
        read: Callable[[Any], Any],
        hear: Callable[[Report], None],
        now: float,
        listed: dict[str, ListedGoal],
        measured: dict[type, Measurement],
    ) -> None:
        self.now, self.goals = now, 0
        self._driver, self._server, self._read, self._hear = driver, server, read, hear
        self._look_at = now
        self._starts, self._was_off = 1, False
        self._open: dict[str, bool] = {}  # goals that have no end, and whether they are accepted
        self._early: dict[str, GoalResult] = {}  # ends of goals that are not yet accepted
        self._listed, self._uuids = listed, dict[str, bytes]()
        self._measured = measured
        self._to_driver: deque[Event] = deque([self._list(), *self._retained()])

    @property
    def next_deadline(self) -> float:
        return max(self.now, min(self._look_at, self._server.next_deadline))

    def ask(self, command: Command) -> str | None:
        """Command the device; returns the reason why the command could not leave, or None."""
        out = self._step_driver(CommandRequest(command=command))
        self._settle()
        return next((each.why for each in out if isinstance(each, CommandNotSent)), None)

    def pass_time(self, now: float) -> None:
        """Let both do everything due by now."""
        self.now = now
        if self._server.is_off and not self._was_off:
            self._starts += 1
            self._open.clear()
            self._early.clear()
            self._to_driver.clear()
            self._listed.clear()
        self._was_off = self._server.is_off
        self._step_server()
        if self.now >= self._look_at:
            self._look_at = self.now + LOOK_S
            self._to_driver.append(ServersFound(servers=self._servers()))
        self._settle()

    def _servers(self) -> tuple[int, ...]:
        if self._server.is_off:
            return ()
        return (self._starts, 1000 + self._starts) if self._server.is_doubled else (self._starts,)

    def _settle(self) -> None:
        while self._to_driver:
            self._step_driver(self._to_driver.popleft())

    def _step_driver(self, *events: Event) -> list[Told]:
        out = self._driver.step(self.now, events)
        for message in out:
            if isinstance(message, Report):
                self._hear(message)
            elif isinstance(message, SendGoal) and not self._server.is_off:
                self.goals += 1
                self._open[message.id], self._uuids[message.id] = False, message.uuid
                self._step_server(GoalRequest(id=message.id, goal=self._read(message.goal)))
            elif isinstance(message, CancelAll) and not self._server.is_off:
                self._cancel()
        return out

    def _cancel(self) -> None:
        """Cancel as action servers in C++ do: accepted goals only; no goal counts as no refusal."""
        accepted = [id for id, is_accepted in self._open.items() if is_accepted]
        accepted += [
            id for id, goal in self._listed.items() if goal.status is None and id not in self._uuids
        ]  # of an earlier driver
        decided = self._step_server(*(CancelRequest(id=id) for id in accepted))
        refused = bool(decided) and not any(each.accepted for each in decided)
        self._to_driver.append(CancelAnswer(refused=refused))

    def _step_server(self, *events: GoalRequest | CancelRequest) -> list[CancelDecision]:
        decided = []
        for message in self._server.step(self.now, events):
            self._note(message)
            if isinstance(message, CancelDecision):
                decided.append(message)
                continue
            if isinstance(message, GoalAnswer | GoalResult):
                self._tell(message)
            else:
                self._to_driver.append(message)
        return decided

    def _note(self, message: object) -> None:
        """Keep the server's list of goals as its middleware does, and show it to the driver."""
        if isinstance(message, GoalAnswer) and message.accepted:
            uuid, s = self._uuids[message.id], int(self.now)
            stamp = (s, int((self.now - s) * 1e9))
            self._listed[message.id] = ListedGoal(uuid=uuid, stamp=stamp, status=None)
        elif isinstance(message, GoalResult) and message.id in self._listed:
            self._listed[message.id] = replace(self._listed[message.id], status=message.status)
        else:
            if isinstance(message, Measurement):
                self._measured[type(message)] = message
            return
        self._to_driver.append(self._list())

    def _retained(self) -> list[Event]:
        """The measurements that a new driver is told at once: localisation speaks seldom."""
        return [each for kind, each in self._measured.items() if kind is MapPose]

    def _list(self) -> GoalList:
        return GoalList(goals=tuple(self._listed.values()))

    def _tell(self, message: GoalAnswer | GoalResult) -> None:
        """Pass a message; a client asks for the end of a goal only once that is accepted."""
        if isinstance(message, GoalResult) and self._open.get(message.id) is False:
            self._early[message.id] = message
            return
        self._to_driver.append(message)
        if isinstance(message, GoalAnswer) and message.accepted and message.id in self._open:
            self._open[message.id] = True
            if (end := self._early.pop(message.id, None)) is not None:
                self._tell(end)
        else:
            self._open.pop(message.id, None)
