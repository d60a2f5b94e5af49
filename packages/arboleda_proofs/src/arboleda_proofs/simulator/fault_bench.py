"""FaultBench: the virtual boards of a plant in real time, with faults of the simulator that people begin."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from heapq import heappop, heappush
from itertools import count
from typing import TYPE_CHECKING

from arboleda.drivers import Facts
from arboleda.model.plant_model import PlantModel
from arboleda.rig.network import Client, Line
from arboleda.sim.arm import ArmBody
from arboleda.sim.board import Board
from arboleda.sim.devices import Alarm, Devices, FromBoard, Reboot, ToBoard
from arboleda.wire.payloads import Presence, encode
from arboleda.wire.topics import Channel, topic
from arboleda.wire.transport import Connection, Delivery, Publication

if TYPE_CHECKING:
    from .faults import End


@dataclass(frozen=True, kw_only=True)
class MishapBegins:
    """Event: a mishap begins at a board, for `seconds`; `number` is its own. `name` is one of MISHAPS."""

    number: int
    name: str
    board: str
    seconds: float = 0.0


@dataclass(frozen=True, kw_only=True)
class MishapEnds:
    """Event: somebody ends a mishap before its time; one that is over stays so."""

    number: int


@dataclass(frozen=True, kw_only=True)
class MishapNote:
    """Message: a mishap has begun at a board, or is over.

    It lasts until `ends_at`; None: it was an instant.
    """

    at: float
    number: int
    name: str
    board: str
    ends_at: float | None = None
    is_over: bool = False


@dataclass(frozen=True, kw_only=True)
class MishapOver:
    """Message: answer to the end of a mishap that was over already."""

    number: int


class Clients:
    """Connections of the boards, each with a line in each direction."""

    def __init__(self, boards: Mapping[str, Board]) -> None:
        self.clients = {name: Client(name, board.subscriptions) for name, board in boards.items()}


class BenchHands:
    """Hands of somebody at the virtual machines of a bench."""

    def __init__(self, bench: FaultBench) -> None:
        self._bench = bench

    def open_effector(self, board: str) -> None:
        body = self._bench.boards[board].body
        if isinstance(body, ArmBody) and self._bench.is_on(board) and not body.stuck:
            body.switch_effector(False)

    def set_facts(self, board: str, facts: Facts) -> None:
        self._bench.boards[board].body.set_by_hand(facts)


class FaultBench:
    """Virtual boards as a machine like `Devices`, which it drives; without a mishap all passes as it is.

    What mishaps do is what faults do in the simulator. `begun` has those that last, by their numbers.
    """

    def __init__(self, model: PlantModel, devices: Devices, *, now: float) -> None:
        self.model = model
        self.now = now
        self.holds: Counter[tuple[str, str]] = Counter()
        self.boards = devices.boards
        self.broker = Clients(devices.boards)
        self.manual = BenchHands(self)
        self.begun: dict[int, MishapNote] = {}
        self._devices = devices
        self._ends: dict[int, list[End]] = {}
        self._off: set[str] = set()
        self._stalled: dict[str, list[ToBoard | Reboot | Alarm]] = {}  # boards, with what waits for them
        self._agenda: list[tuple[float, int, Callable[[], None]]] = []
        self._agenda_no = count()
        self._events: list[ToBoard | Reboot | Alarm] = []
        self._out: list[FromBoard | MishapNote | MishapOver] = []

    @property
    def awake_s(self) -> float:
        return self.now

    @property
    def next_deadline(self) -> float | None:
        due = self._devices.next_deadline
        planned = self._agenda[0][0] if self._agenda else math.inf
        first = planned if due is None else min(planned, due)
        return None if first == math.inf else first

    def step(
        self, now: float, events: Sequence[ToBoard | Reboot | Alarm | MishapBegins | MishapEnds]
    ) -> list[FromBoard | MishapNote | MishapOver]:
        """Take the events in order, let the time pass, and collect what boards publish and mishaps do."""
        self.now = max(now, self.now)
        while self._agenda and self._agenda[0][0] <= self.now:
            heappop(self._agenda)[2]()
        for event in events:
            if isinstance(event, MishapBegins):
                self._begin(event)
            elif isinstance(event, MishapEnds) and event.number not in self.begun:
                self._out.append(MishapOver(number=event.number))
            elif isinstance(event, MishapEnds):
                self._end(event.number)
            else:
                self._take(event)
        passed, self._events = self._events, []
        for message in self._devices.step(self.now, passed):
            self._send(message)
        out, self._out = self._out, []
        return out

    def is_on(self, process: str) -> bool:
        return process not in self._off

    def power_off(self, board: str, *, will_after_s: float = 0.0) -> None:
        """Cut a board's power: what waits for it is lost, and it boots once it has power again."""
        if board in self._off:
            return
        client = self.broker.clients[board]
        client.connection += 1  # what is under way is lost
        self._off.add(board)
        self._stalled.pop(board, None)
        self._devices.pause(board)
        now_us = round(self.now * 1e6)
        self.boards[board].connect(now_us, False)
        self.boards[board].reboot(now_us, self._devices.next_boot_id())
        self.boards[board].take()
        lost = client.connection
        self._at(self.now + will_after_s, lambda: self._tell_will(client, lost))

    def power_on(self, board: str) -> None:
        if board not in self._off:
            return
        self._off.discard(board)
        client = self.broker.clients[board]
        client.connection += 1
        self.boards[board].connect(round(self.now * 1e6), client.connected)
        self._devices.go_on(board)

    def stall(self, process: str, seconds: float) -> None:
        if process not in self._off and process not in self._stalled:
            self._stalled[process] = []
            self._devices.pause(process)

    def go_on(self, process: str) -> None:
        waiting = self._stalled.pop(process, None)
        if waiting is not None:
            self._devices.go_on(process)
            self._events += [_as_of(event, self.now) for event in waiting]

    def wake(self, process: str) -> None:
        if process not in self._off:
            self._devices.wake(process)

    def _begin(self, event: MishapBegins) -> None:
        from .faults import OF_BOARDS  # loads the whole simulator, for what most plants are never asked for
        from .mishaps import MISHAPS

        mishap = MISHAPS[event.name]
        begun = (
            OF_BOARDS[each.kind].begin(self, each)
            for each in mishap.of(event.board, at=self.now, seconds=event.seconds)
        )
        ends = [end for end in begun if end is not None]
        until = self.now + event.seconds if ends else None
        note = MishapNote(at=self.now, number=event.number, name=event.name, board=event.board, ends_at=until)
        if until is not None:
            self._ends[event.number], self.begun[event.number] = ends, note
            self._at(until, lambda: self._end(event.number))
        self._out.append(note)

    def _end(self, number: int) -> None:
        note = self.begun.pop(number, None)
        if note is None:
            return
        for end in self._ends.pop(number):
            end()
        self._out.append(replace(note, at=self.now, is_over=True))

    def _take(self, event: ToBoard | Reboot | Alarm) -> None:
        """Have an event reach its board, through the line there."""
        client = self.broker.clients[event.board]
        inner = event.event if isinstance(event, ToBoard) else None
        if isinstance(inner, Connection):
            client.connected = inner.up
        if isinstance(inner, Delivery) and not client.down.is_clear(self.now):
            self._delay(client, client.down, inner, lambda: self._hand_on(_as_of(event, self.now)))
        else:
            self._hand_on(event)

    def _hand_on(self, event: ToBoard | Reboot | Alarm) -> None:
        """Give a board an event; without power it gets none, and where it does nothing they wait."""
        if event.board in self._off:
            return
        if event.board in self._stalled:
            self._stalled[event.board].append(event)
        else:
            self._events.append(event)

    def _send(self, message: FromBoard) -> None:
        """Have a message of a board leave, through the line from there."""
        client = self.broker.clients[message.board]
        if client.up.is_clear(self.now):
            self._out.append(message)
        else:
            self._delay(client, client.up, message.publication, lambda: self._out.append(message))

    def _delay(
        self, client: Client, line: Line, message: Publication | Delivery, arrive: Callable[[], None]
    ) -> None:
        """Have `arrive()` made for each copy of a message, when the line lets it through."""
        connection = client.connection

        def late() -> None:
            if client.connection == connection:
                arrive()

        for at in line.carry(self.now, message):
            self._at(at, late)

    def _at(self, time: float, call: Callable[[], None]) -> None:
        """Have `call()` made at a time, or now where that has come."""
        if time <= self.now:
            call()
        else:
            heappush(self._agenda, (time, next(self._agenda_no), call))

    def _tell_will(self, client: Client, connection: int) -> None:
        if client.connection == connection:
            gone = Publication(
                topic=topic(client.name, Channel.PRESENCE),
                payload=encode(Presence(online=False)),
                retain=True,
            )
            self._out.append(FromBoard(board=client.name, publication=gone))


def _as_of(event: ToBoard | Reboot | Alarm, now: float) -> ToBoard | Reboot | Alarm:
    """An event that waited, as if it happened now."""
    if not isinstance(event, ToBoard):
        return replace(event, at=now)
    inner = event.event
    late = inner._replace(at=now) if isinstance(inner, Delivery) else replace(inner, at=now)
    return replace(event, event=late)
