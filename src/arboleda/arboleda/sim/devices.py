"""Machine of all virtual boards of a plant."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from typing import Any

from arboleda.kinds.arm import Arm
from arboleda.kinds.declared import Device
from arboleda.kinds.joints import Jointed
from arboleda.kinds.mobile import Mobile
from arboleda.model.by_class import nearest
from arboleda.model.plant_model import Cell, Link, PlantModel, Robot
from arboleda.model.whole_cells import whole_cell
from arboleda.wire.transport import Connection, Delivery, Publication

from .arm import ArmBody, AxesBody
from .board import Board
from .body import Body
from .machine import MachineBody
from .mobile import MobileBody
from .starts import start_of, supplies_of


@dataclass(frozen=True, kw_only=True)
class ToBoard:
    """Event of a board's own MQTT client; `board` is the MQTT name."""

    board: str
    event: Delivery | Connection


@dataclass(frozen=True, kw_only=True)
class Reboot:
    """Event: a board loses power and comes back at once."""

    at: float
    board: str


@dataclass(frozen=True, kw_only=True)
class Alarm:
    """Event: a motor driver of a board reports an alarm, or its end."""

    at: float
    board: str
    is_on: bool


@dataclass(frozen=True, kw_only=True)
class FromBoard:
    """Message that a board publishes with its own MQTT client."""

    board: str
    publication: Publication


class Devices:
    """The boards of every robot with `link: mqtt`; `boot_ids` gives each boot its id (uint32).

    The robots named `elsewhere` have boards of another kind.
    """

    def __init__(
        self,
        model: PlantModel,
        *,
        now: float,
        boot_ids: Callable[[], int],
        elsewhere: Collection[str] = (),
    ) -> None:
        self._boot_ids = boot_ids
        self.boards: dict[str, Board] = {
            robot.mqtt: Board(robot, _body(model, robot), boot_id=boot_ids(), now_us=_us(now))
            for robot in model.robots.values()
            if robot.link is Link.MQTT and robot.name not in elsewhere
        }
        self._due_us: dict[str, float] = {}  # time of the next step of each board
        self._paused: set[str] = set()
        for name in self.boards:
            self._plan(name)

    def subscriptions(self, board: str) -> tuple[str, ...]:
        """The topics that a board listens to."""
        return self.boards[board].subscriptions

    @property
    def next_deadline(self) -> float | None:
        due = self._due_us if not self._paused else self._awake
        due_us = min(due.values(), default=math.inf)
        return due_us / 1e6 if due_us < math.inf else None

    @property
    def _awake(self) -> dict[str, float]:
        return {name: due_us for name, due_us in self._due_us.items() if name not in self._paused}

    def next_boot_id(self) -> int:
        """The id of a boot that somebody else brings about."""
        return self._boot_ids()

    def pause(self, board: str) -> None:
        """Have no time pass for a board until it goes on; it must get no events meanwhile."""
        self._paused.add(board)

    def go_on(self, board: str) -> None:
        """Have time pass for a board, from the next step on, which is due."""
        self._paused.discard(board)
        self.wake(board)

    def wake(self, board: str) -> None:
        """Have a board step at once, as something was done to it."""
        self._due_us[board] = -math.inf

    def step(self, now: float, events: Sequence[ToBoard | Reboot | Alarm]) -> list[FromBoard]:
        """Feed the events in order, let the time pass, and collect what the boards publish."""
        now_us, out = _us(now), []
        for event in events:
            self._feed(event)
            self._due_us[event.board] = now_us
        awake = self._due_us if not self._paused else self._awake
        for name in [name for name, due_us in awake.items() if due_us <= now_us]:
            board = self.boards[name]
            board.advance(now_us)
            out += [FromBoard(board=name, publication=publication) for publication in board.take()]
            self._plan(name)
        return out

    def _plan(self, name: str) -> None:
        due_us = self.boards[name].next_deadline_us
        self._due_us[name] = math.inf if due_us is None else due_us

    def _feed(self, event: ToBoard | Reboot | Alarm) -> None:
        board = self.boards[event.board]
        if isinstance(event, Reboot):
            board.reboot(_us(event.at), self._boot_ids())
        elif isinstance(event, Alarm):
            (board.fail if event.is_on else board.repair)(_us(event.at))
        elif isinstance(event.event, Connection):
            board.connect(_us(event.event.at), event.event.up)
        else:
            board.receive(_us(event.event.at), event.event)


def _body(model: PlantModel, robot: Robot) -> Body:
    """The body of a robot at the start position in its cell, or of a device with its first facts."""
    body = nearest(BODIES, type(robot))
    if body is None:
        raise TypeError(f"{robot.name} has no virtual board: nothing says how a {robot.kind_name} moves")
    return body(robot, whole_cell(model, robot.name))


def _arm(arm: Arm, cell: Cell) -> Body:
    start, pickups = start_of(cell, arm.name), [pose.joints for pose in supplies_of(cell, arm.name)]
    return ArmBody(arm, start=start if isinstance(start, tuple) else arm.reference, pickups=pickups)


def _jointed(robot: Jointed, cell: Cell) -> Body:
    start = start_of(cell, robot.name)
    return AxesBody(robot, start=start if isinstance(start, tuple) else robot.reference, pickups=())


def _mobile(mobile: Mobile, cell: Cell) -> Body:
    start = start_of(cell, mobile.name)
    return MobileBody(mobile, start_node=start if isinstance(start, int) else 0)


def _machine(device: Device, cell: Cell) -> Body:
    return MachineBody(device.kind)


BODIES: dict[type[Robot], Callable[[Any, Cell], Body]] = {
    Jointed: _jointed,
    Arm: _arm,
    Mobile: _mobile,
    Device: _machine,
}


def _us(seconds: float) -> int:
    return round(seconds * 1e6)
