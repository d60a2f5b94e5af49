"""Plant, bridge and virtual boards joined without threads, sockets or clocks."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import count
from typing import Any

from py_trees.common import Status

from arboleda.core import view
from arboleda.core.messages import (
    Command,
    Event,
    Fact,
    Heartbeat,
    OperatorAnswer,
    OperatorRequest,
    Remember,
    Report,
    TaskChanged,
    TaskRequest,
    Verb,
)
from arboleda.core.model import PlantModel
from arboleda.core.plant import Plant
from arboleda.core.task import Recipe
from arboleda.sim.devices import Devices, Reboot, ToBoard
from arboleda.wire.bridge import Bridge, FromPlant
from arboleda.wire.transport import Connection, Delivery, Publication

RECIPES = frozenset(recipe.value for recipe in Recipe)
AT_ONE_INSTANT = 1000  # rounds; more means two machines that never stop talking


class Rig:
    """A plant at `now` seconds; messages take no time, `wait` moves it from deadline to deadline.

    `lost` and `carry` are the network: which messages it loses, and what it makes of each of the others.
    `watchers` are called after every step; `to_boards` is every command that reached a board, with its time.
    """

    def __init__(self, model: PlantModel, *, now: float = 100.0, epoch: int = 1000) -> None:
        self.model = model
        self.now = now
        self.epochs = count(epoch)
        self.plant = Plant(model, epoch=next(self.epochs), now=now)
        self.devices = Devices(model, now=now, boot_ids=count(1).__next__)
        self.bridge: Bridge | None = None
        self.changes: list[TaskChanged] = []
        self.answers: list[OperatorAnswer] = []
        self.memory: dict[Fact, dict[str, str]] = {}
        self.sent: list[Any] = []
        self.lost: Callable[[Publication], bool] = lambda publication: False
        self.carry: Callable[[Publication], Iterable[Publication]] = lambda publication: [publication]
        self.watchers: list[Callable[[], None]] = []
        self.to_boards: list[tuple[float, Publication]] = []
        self.broker_up = True
        self._to_plant: list[Event] = []
        self._to_bridge: list[Any] = []
        self._to_devices: list[Any] = []
        self._retained: dict[str, Publication] = {}
        for board in self.devices.boards:
            self._connect(board)
        self.start_bridge()
        self._settle()

    def submit(self, text: str) -> TaskChanged:
        """Ask for a task; the plant's answer."""
        self._to_plant.append(TaskRequest(at=self.now, text=text, request=text))
        before = len(self.changes)
        self._settle()
        return next(change for change in self.changes[before:] if change.request == text)

    def operate(self, verb: Verb, scope: str = "", *, by_hand: bool = False) -> str | None:
        """An operator's act; why it was refused, None where it was done."""
        self.tell(OperatorRequest(at=self.now, verb=verb, scope=scope, by_hand=by_hand))
        return self.answers[-1].refusal

    def crash(self) -> None:
        """The plant's process dies and starts anew with what it had to keep."""
        self._to_plant = []
        self.plant = Plant(self.model, epoch=next(self.epochs), now=self.now, memory=self.memory)
        self._settle()

    def tell(self, event: Event) -> None:
        """Give the plant one event."""
        self._to_plant.append(event)
        self._settle()

    def wait(self, seconds: float, until: Callable[[], bool] = lambda: False) -> bool:
        """Let time pass, at most `seconds`; whether `until` came true."""
        end = self.now + seconds
        while not until() and (due := self._next_deadline()) <= end:
            self.now = max(self.now, due)
            self._settle()
        if not until():
            self.now = end
        return until()

    def outcomes(self) -> dict[str, TaskChanged]:
        """The last change of every accepted task, by task id."""
        return {change.task: change for change in self.changes if change.task}

    def leaf(self, cell: str) -> str | None:
        """The leaf that runs in a cell, with what it is part of: `main/effector on/switch`."""
        tree = self.plant.cells[cell].tree
        running = [node for node in tree.iterate() if node.status is Status.RUNNING] if tree else []
        names = [node.name for node in reversed(running) if node.name not in RECIPES]
        return "/".join(names) or None

    def runs(self, cell: str, leaf: str) -> bool:
        """Whether a leaf runs whose name, with what it is part of, ends so."""
        return f"/{self.leaf(cell)}".endswith(f"/{leaf}")

    def wait_for(self, cell: str, leaf: str, seconds: float = 60.0) -> None:
        """Let time pass until this leaf runs."""
        assert self.wait(seconds, until=lambda: self.runs(cell, leaf)), f"{leaf} never ran in {cell}"

    def snapshot(self) -> dict[str, Any]:
        """What a screen would show now."""
        return view.snapshot(self.plant)

    def reboot(self, board: str) -> None:
        """The board loses power: its connection ends with its last will, then it is back."""
        self.power_off(board)
        self.power_on(board)

    def power_off(self, board: str) -> None:
        """The board loses power; the broker tells its last will."""
        self._publish(Publication(topic=f"{board}/conexion", payload=b"0", retain=True))
        self._connect(board, up=False)
        self._to_devices.append(Reboot(at=self.now, board=board))
        self._settle()

    def power_on(self, board: str) -> None:
        """The board is back, and reaches the broker."""
        self._connect(board)
        self._settle()

    def publish(self, publication: Publication) -> None:
        """Somebody publishes something."""
        self._publish(publication)
        self._settle()

    def stop_broker(self) -> None:
        """The broker dies: every connection breaks, and what it retained is gone."""
        self.broker_up, self._retained = False, {}
        self._connect_all(up=False)

    def start_broker(self) -> None:
        """A new broker: everybody is back."""
        self.broker_up = True
        self._connect_all(up=True)

    def stop_bridge(self) -> None:
        """The bridge's process dies."""
        self.bridge, self._to_bridge = None, []

    def start_bridge(self) -> None:
        """A new bridge process connects; the broker delivers what it retained."""
        self.bridge = Bridge(self.model, epoch=next(self.epochs), now=self.now)
        self._to_bridge = [Connection(at=self.now, client="bridge", up=True)]
        self._to_bridge += [self._delivery(each, retain=True) for each in self._retained.values()]

    def _connect(self, board: str, *, up: bool = True) -> None:
        self._to_devices.append(ToBoard(board=board, event=Connection(at=self.now, client=board, up=up)))

    def _connect_all(self, *, up: bool) -> None:
        self._to_bridge.append(Connection(at=self.now, client="bridge", up=up))
        for board in self.devices.boards:
            self._connect(board, up=up)
        self._settle()

    def _next_deadline(self) -> float:
        machines = (self.plant, self.bridge, self.devices)
        due = [machine.next_deadline for machine in machines if machine is not None]
        return min(at for at in due if at is not None)

    def _settle(self) -> None:
        """Step whoever has something to do now, until nobody has."""
        for _ in range(AT_ONE_INSTANT):
            waiting = self._to_plant or self._to_devices or (self.bridge and self._to_bridge)
            if not waiting and self._next_deadline() > self.now:
                return
            self._step()
        raise AssertionError(f"the machines do not come to rest at {self.now}")

    def _step(self) -> None:
        to_devices, self._to_devices = self._to_devices, []
        for said in self.devices.step(self.now, to_devices):
            self._publish(said.publication)
        if self.bridge is not None:
            to_bridge, self._to_bridge = self._to_bridge, []
            for passed_on in self.bridge.step(self.now, to_bridge):
                self._from_bridge(passed_on)
        to_plant, self._to_plant = self._to_plant, []
        for message in self.plant.step(self.now, to_plant):
            self._from_plant(message)
        assert self.plant.sleepers() == [], "a tree runs with nothing left to wake it"
        for watch in self.watchers:
            watch()

    def _from_plant(self, message: Any) -> None:
        self.sent.append(message)
        if isinstance(message, TaskChanged):
            self.changes.append(message)
        elif isinstance(message, OperatorAnswer):
            self.answers.append(message)
        elif isinstance(message, Remember):
            self._remember(message)
        elif isinstance(message, Command | Heartbeat):
            self._to_bridge.append(FromPlant(at=self.now, message=message))

    def _remember(self, fact: Remember) -> None:
        kept = self.memory.setdefault(fact.fact, {})
        if fact.value is None:
            kept.pop(fact.name, None)
        else:
            kept[fact.name] = fact.value

    def _from_bridge(self, message: Publication | Report) -> None:
        if isinstance(message, Report):
            self._to_plant.append(message)
        else:
            self._publish(message)

    def _publish(self, publication: Publication) -> None:
        if not self.broker_up:
            return
        if publication.retain:
            self._retained[publication.topic] = publication
        if self.lost(publication):
            return
        for carried in self.carry(publication):
            self._deliver(carried)

    def _deliver(self, publication: Publication) -> None:
        delivery = self._delivery(publication)
        board, channel = publication.topic.split("/")
        if publication.topic in self.devices.subscriptions(board):
            self._to_devices.append(ToBoard(board=board, event=delivery))
            if channel != "latido":
                self.to_boards.append((self.now, publication))
        elif self.bridge is not None and publication.topic in self.bridge.subscriptions:
            self._to_bridge.append(delivery)

    def _delivery(self, publication: Publication, *, retain: bool = False) -> Delivery:
        return Delivery(at=self.now, topic=publication.topic, payload=publication.payload, retain=retain)
