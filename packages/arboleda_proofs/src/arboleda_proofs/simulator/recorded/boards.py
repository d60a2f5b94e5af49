"""Record of the messages that reached boards and bridge, and of the commands that boards carried out.

`nothing_late_has_effect` finds by it a board that takes whatever telemetry a command names for fresh.
"""

from __future__ import annotations

import json
import math
from collections import deque
from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache
from typing import Any, NamedTuple

from arboleda.drivers import Joint, Robot
from arboleda.engine import Belief
from arboleda.rig.moment import Moment
from arboleda.rig.network import Client
from arboleda.rig.world import World
from arboleda.sim.board import Board
from arboleda.wire.epochs import can_follow
from arboleda.wire.payloads import Goal, StopGoal
from arboleda.wire.topics import Channel, topic
from arboleda.wire.transport import Delivery, Publication

from ..commands import goal as goal_of

RECENT = 512  # telemetry messages, more than the bridge or a line keep
DECIMALS = 4
EXACT = 0.6e-4
KEPT = 4096  # angles; arms go the same ways all day
Numbers = tuple[int, int]  # (epoca, seq)


class ExecutedCommand(NamedTuple):
    """A command that a board carried out, with the number of the one `before`; `delivered`: it had arrived.

    `beat` is the newest epoch of which the board had heard a beat, `reported_at` when it sent the telemetry
    that the command names, None if it did not lately.
    """

    board: str
    goal: Goal
    before: Numbers | None
    delivered: bool
    beat: int | None
    reported_at: float | None


class KnownBoard:
    """One board: its numbers since it booted, what is new in its inbox, what the bridge heard of it."""

    def __init__(self, robot: Robot, board: Board) -> None:
        self.robot = robot
        self.board = board
        self.boot = board.boot_id
        self.last: Numbers | None = None
        self.beat: int | None = None  # the newest epoch in the beats that it has read since it booted
        self.published: deque[tuple[bytes, float]] = deque(
            maxlen=RECENT
        )  # telemetry since it booted, and when
        self.inbox: list[Delivery] = []
        self.telemetry: deque[Delivery] = deque(maxlen=RECENT)
        self.legal: set[tuple[float, ...]] = set()  # goals and paths on the wire that the robot can follow
        self._written: tuple[tuple[float, ...] | int | None, bytes] | None = None
        joints = robot.joints
        self._axes = board.body.axes
        self._degrees = tuple(on_wire(joint, 1.0) for joint in joints)
        self._keys = tuple(f"q{number}_mov" for number in range(1, len(joints) + 1)) or ("nodo",)
        self._form = "{" + "".join(f'"{key}":%s,' for key in self._keys)

    def take_over(self, at: float, belief: Belief) -> None:
        """Take over what the board said before this record began, as far as the plant has heard it."""
        q, node = belief.q, belief.node
        if belief.number is not None:
            self.published.append((b'"seq":%d' % belief.number, at))
        if q is not None or node is not None:
            words = self._words(q, node) + b'"estado":0}'
            self.telemetry.append(Delivery(at=at, topic="", payload=words))

    def carried_out(self, goal: Goal) -> ExecutedCommand:
        """The record of a command that the board carries out now."""
        self.notice_boot()
        before, delivered = self.last, self._was_delivered(goal)
        if goal.seq is not None and goal.epoch is not None:
            self.last = (goal.epoch, goal.seq)
        reported_at = None if isinstance(goal, StopGoal) else self._reported_at(goal.heard)
        return ExecutedCommand(self.robot.mqtt, goal, before, delivered, self.beat, reported_at)

    def _reported_at(self, number: int | None) -> float | None:
        if number is None:
            return None
        wanted = b"%d" % number
        for report, at in reversed(self.published):
            if parts(report)[1] == wanted:
                return at
        return None

    def forget_read(self, unread: list[Any]) -> None:
        """Forget messages that left the board's inbox, read or lost: they are no longer new to it."""
        waiting = set(map(id, unread))
        read = [each for each in self.inbox if id(each) not in waiting]
        self.inbox = [each for each in self.inbox if id(each) in waiting]
        if not self.notice_boot():
            for delivery in read:
                self._read(delivery)

    def notice_boot(self) -> bool:
        """True if the board has booted since the last look; forgets what the board forgot by that."""
        booted = self.boot != self.board.boot_id
        if booted:
            self.boot, self.last, self.beat = self.board.boot_id, None, None
            self.published.clear()
        return booted

    def _read(self, delivery: Delivery) -> None:
        epoch = fields(delivery.payload).get("epoca") if delivery.topic.endswith("/latido") else None
        if type(epoch) is not int or delivery.retain:
            return
        known = [each for each in (self.beat, self.last and self.last[0]) if each is not None]
        if can_follow(epoch, max(known, default=None)):
            self.beat = max(epoch, self.beat or 0)

    def has_reported(self, q: tuple[float, ...] | None, node: int | None, since: float) -> bool:
        """True if valid telemetry with this place reached the bridge at `since` or later."""
        if not self.telemetry:
            return False
        last = self.telemetry[-1]
        position, written = node if q is None else q, self._written
        words = self._words(q, node) if written is None or written[0] != position else written[1]
        if last.at >= since and last.payload.startswith(words):
            return True
        there = dict(zip(self._keys, map(float, self._on_wire(q, node)), strict=True))
        return any(each.at >= since and _says(each.payload, there) for each in reversed(self.telemetry))

    def remembers(self, at: float) -> bool:
        """True if all telemetry since then is kept here."""
        return len(self.telemetry) < RECENT or self.telemetry[0].at <= at

    def _words(self, q: tuple[float, ...] | None, node: int | None) -> bytes:
        """The beginning of our boards' telemetry for this place."""
        words = (self._form % self._on_wire(q, node)).encode()
        self._written = node if q is None else q, words
        return words

    def _on_wire(self, q: tuple[float, ...] | None, node: int | None) -> tuple[Any, ...]:
        if q is None:
            return (node,)
        return tuple([_angle(value, degrees) for value, degrees in zip(q, self._degrees, strict=True)])

    def _was_delivered(self, goal: Goal) -> bool:
        """True if the goal was delivered; not as a retained message, whose age nobody knows."""
        for delivery in self.inbox:
            self._read(delivery)
            if not delivery.retain and goal_of(delivery.topic, delivery.payload, self._axes) == goal:
                self.inbox.remove(delivery)
                return True
        return False


class Boards:
    """All boards by name; `executed`: the commands carried out in this step."""

    def __init__(self, world: World) -> None:
        robots = {robot.mqtt: robot for robot in world.model.robots.values()}
        boards = {name: KnownBoard(robots[name], board) for name, board in world.boards.items()}
        self.by_name = boards
        self.of_robot = {board.robot.name: board for board in boards.values()}
        self.executed: list[ExecutedCommand] = []
        self._busy: dict[str, None] = {}  # boards with something in their inbox
        self._hears = {f"{name}/sensores": board.telemetry.append for name, board in boards.items()}
        self._obeys = {topic: name for name in boards for topic in _commands(name)}

    def take_over(self, now: float, beliefs: Mapping[str, Belief]) -> None:
        """Take over what boards said before this record began."""
        for name, board in self.of_robot.items():
            board.take_over(now, beliefs[name])

    def look(self, moment: Moment, clients: dict[str, Client]) -> None:
        """Take in what reached boards, and what they carry out."""
        self.deliver(moment.delivered)
        self.executed.clear()
        for name, goal in moment.executed:
            self.executed.append(self.by_name[name].carried_out(goal))
        self.forget_read(clients)

    def deliver(self, delivered: list[tuple[str, Delivery]]) -> None:
        """Messages reached the inboxes of the bridge and of boards."""
        for _, delivery in delivered:
            hear = self._hears.get(delivery.topic)
            if hear is None:
                name = self._obeys.get(delivery.topic)
                if name is not None:
                    self.by_name[name].inbox.append(delivery)
                    self._busy[name] = None
            elif not delivery.retain:
                hear(delivery)

    def tell(self, at: float, published: Iterable[tuple[str, Publication]]) -> None:
        """Take in publications; only what boards publish about themselves counts here."""
        for name, publication in published:
            if publication.topic in self._hears and (board := self.by_name.get(name)) is not None:
                if board.boot != board.board.boot_id:
                    board.notice_boot()
                board.published.append((publication.payload, at))

    def forget_read(self, clients: dict[str, Client]) -> None:
        """Forget the messages that boards have read: they are no longer new to them."""
        if not self._busy:
            return
        for name in tuple(self._busy):
            self.by_name[name].forget_read(clients[name].inbox)
            if not self.by_name[name].inbox:
                del self._busy[name]


@lru_cache(maxsize=KEPT)
def _angle(value: float, degrees: float) -> str:
    """An angle in the form that boards write; `degrees` is the number of degrees in one unit of `value`."""
    return repr(round(value * degrees, DECIMALS) + 0.0)


def _commands(board: str) -> list[str]:
    reports = (Channel.TELEMETRY, Channel.PRESENCE)
    return [topic(board, channel) for channel in Channel if channel not in reports]


def on_wire(joint: Joint, value: float) -> float:
    """A joint's value in degrees, from rad, or from m along the rack of a pinion."""
    return math.degrees(value / joint.pinion_radius_m if joint.pinion_radius_m else value)


@lru_cache(maxsize=RECENT)  # each telemetry is looked at several times in its step
def parts(payload: bytes) -> tuple[bytes, bytes, bytes]:
    """The parts of a message: before its number, the number, after it."""
    before, _, rest = payload.partition(b'"seq":')
    after = rest.lstrip(b"0123456789")
    return before, rest[: len(rest) - len(after)], after


def is_number(value: object) -> bool:
    return type(value) in (int, float) and math.isfinite(value)  # type: ignore[arg-type]


@lru_cache(maxsize=RECENT)  # beats are the same all the time, and several invariants look at each message
def fields(raw: bytes) -> Mapping[str, Any]:
    """The JSON object of a payload; empty where there is none. Nobody changes it."""
    try:
        body = json.loads(raw)
    except ValueError:
        return {}
    return body if isinstance(body, dict) else {}


def _says(raw: bytes, there: dict[str, Any]) -> bool:
    body = fields(raw)
    rows: Iterator[tuple[Any, Any]] = ((body.get(key), value) for key, value in there.items())
    return all(is_number(reported) and abs(reported - value) <= EXACT for reported, value in rows)
