"""Plant, bridge and virtual boards joined without threads, sockets or clocks."""

from __future__ import annotations

from collections.abc import Callable
from itertools import count
from typing import Any

from arboleda.core import view
from arboleda.core.messages import Event, Report, SystemStart, TaskChanged, TaskRequest
from arboleda.core.model import PlantModel
from arboleda.core.plant import Plant
from arboleda.sim.devices import Devices, Reboot, ToBoard
from arboleda.wire.bridge import Bridge, FromPlant
from arboleda.wire.transport import Connection, Delivery, Publication

AT_ONE_INSTANT = 1000  # rounds; more means two machines that never stop talking


class Rig:
    """A plant at `now` seconds; messages take no time, `wait` moves it from deadline to deadline."""

    def __init__(self, model: PlantModel, *, now: float = 100.0, epoch: int = 1000) -> None:
        self.model = model
        self.now = now
        self.epochs = count(epoch)
        self.plant = Plant(model, epoch=next(self.epochs), now=now)
        self.devices = Devices(model, now=now, boot_ids=count(1).__next__)
        self.bridge: Bridge | None = None
        self.changes: list[TaskChanged] = []
        self.sent: list[Any] = []
        self.lost: Callable[[Publication], bool] = lambda publication: False
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

    def snapshot(self) -> dict[str, Any]:
        """What a screen would show now."""
        return view.snapshot(self.plant)

    def reboot(self, board: str) -> None:
        """The board loses power: its connection ends with its last will, then it is back."""
        self._publish(Publication(topic=f"{board}/conexion", payload=b"0", retain=True))
        self._to_devices.append(Reboot(at=self.now, board=board))
        self._connect(board)
        self._settle()

    def stop_bridge(self) -> None:
        """The bridge's process dies."""
        self.bridge, self._to_bridge = None, []

    def start_bridge(self) -> None:
        """A new bridge process connects; the broker delivers what it retained."""
        self.bridge = Bridge(self.model, epoch=next(self.epochs), now=self.now)
        self._to_bridge = [Connection(at=self.now, client="bridge", up=True)]
        self._to_bridge += [self._delivery(each, retain=True) for each in self._retained.values()]

    def _connect(self, board: str) -> None:
        self._to_devices.append(ToBoard(board=board, event=Connection(at=self.now, client=board, up=True)))

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

    def _from_plant(self, message: Any) -> None:
        self.sent.append(message)
        if isinstance(message, TaskChanged):
            self.changes.append(message)
        elif not isinstance(message, SystemStart):
            self._to_bridge.append(FromPlant(at=self.now, message=message))

    def _from_bridge(self, message: Publication | Report) -> None:
        if isinstance(message, Report):
            self._to_plant.append(message)
        else:
            self._publish(message)

    def _publish(self, publication: Publication) -> None:
        if publication.retain:
            self._retained[publication.topic] = publication
        if self.lost(publication):
            return
        delivery = self._delivery(publication)
        board = publication.topic.split("/")[0]
        if publication.topic in self.devices.subscriptions(board):
            self._to_devices.append(ToBoard(board=board, event=delivery))
        elif self.bridge is not None and publication.topic in self.bridge.subscriptions:
            self._to_bridge.append(delivery)

    def _delivery(self, publication: Publication, *, retain: bool = False) -> Delivery:
        return Delivery(at=self.now, topic=publication.topic, payload=publication.payload, retain=retain)
