"""Campaign of a plant with devices behind actions, under the faults of their servers."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from arboleda.model.commands import Command, Stop
from arboleda.model.messages import Reason
from arboleda.model.plant_model import Cell, PlantModel, Robot
from arboleda_drivers.ros_action.events import ListedGoal, Measurement
from arboleda_drivers.ros_action.machine import Machine
from arboleda_drivers.ros_action.virtual.machine import Body, VirtualServer
from arboleda_drivers.virtual.faults import Faults

from .rig import Causes, Hear, Rig
from .ros_action_loopback import Loopback

MEASURE_S = 0.05  # less often than by default: a campaign has to see every state, and no more
NEAR = 1e-3  # m or rad
NO_LINK = {Reason.LINK_LOST}
CAUSES: dict[str, set[Reason]] = {
    "vanish": {Reason.LINK_LOST, Reason.REBOOTED},
    "double": NO_LINK,
    "refuse": {Reason.REJECTED},
    "late_answer": {Reason.DEVICE_FAULT},
    "no_result": {Reason.DEADLINE},
    "late_result": set(),
    "lie": {Reason.NOT_REACHED},
    "early": set(),
    "short": {Reason.NOT_REACHED},
    "stall": {Reason.DEADLINE, Reason.NOT_REACHED},  # the last where a result was early
    "abort": {Reason.DEVICE_FAULT},
    "other_client": {Reason.DEVICE_FAULT},
    "refuse_cancel": {Reason.STOP_UNCONFIRMED},
    "deaf": {Reason.STOP_UNCONFIRMED},
    "mute": NO_LINK,
    "frozen": NO_LINK,
    "stuck": {Reason.NOT_REACHED, Reason.DEVICE_FAULT},
    "no_number": NO_LINK,
    "slow": {Reason.DEADLINE},
}
"""The allowed reasons of a failure during, or soon after, each fault that every server has."""


class DeviceFaults(Collection[str]):
    """Faults of one device among those of all, which are called by device and name: `arm.lie`."""

    def __init__(self, all: Faults, device: str) -> None:
        self._all, self._before = all, f"{device}."

    def __contains__(self, name: object) -> bool:
        return f"{self._before}{name}" in self._all

    def __iter__(self) -> Iterator[str]:
        return (name.removeprefix(self._before) for name in self._all if name.startswith(self._before))

    def __len__(self) -> int:
        return sum(1 for _ in self)


@dataclass(frozen=True, kw_only=True)
class Part:
    """Device: the machine of its driver, the body of its server, and the reader of goals between them."""

    name: str
    machine: Callable[[Sequence[Robot], Any], Machine]
    body: Callable[[Collection[str]], Body]
    read: Callable[[Any], Any]
    causes: Causes


class ActionRig(Rig):
    """Test with a server for each device; `parts` names the devices."""

    driver = "actions"
    between_s = 12.0
    parts: Sequence[Part]

    def __init__(self, example: PlantModel) -> None:
        known = {f"{part.name}.{name}": name for part in self.parts for name in part.causes}
        super().__init__(known)
        self.model = example
        self.causes = {f"{each.name}.{name}": why for each in self.parts for name, why in each.causes.items()}
        self.bodies = {part.name: part.body(DeviceFaults(self.faults, part.name)) for part in self.parts}
        self._servers = {
            name: VirtualServer(body, DeviceFaults(self.faults, name), measure_s=MEASURE_S)
            for name, body in self.bodies.items()
        }
        self.listed: dict[str, dict[str, ListedGoal]] = {part.name: {} for part in self.parts}
        self._measured: dict[str, dict[type, Measurement]] = {part.name: {} for part in self.parts}
        self._joined: DeviceGroup | None = None

    @property
    def where(self) -> tuple[float, ...]:
        return tuple(self.bodies[self.parts[0].name].position)

    @property
    def cell(self) -> Cell:
        (cell,) = self.model.cells
        return cell

    @property
    def robots(self) -> Sequence[Robot]:
        return tuple(self.model.robots[part.name] for part in self.parts)

    def join(self, hear: Hear, now: float) -> DeviceGroup:
        made = {}
        for part, device in zip(self.parts, self.robots, strict=True):
            assert device.driver is not None
            driver = part.machine([device], device.driver.settings)
            server, listed = self._servers[part.name], self.listed[part.name]
            measured = self._measured[part.name]
            made[part.name] = Loopback(driver, server, part.read, hear, now, listed, measured)
        self._joined = DeviceGroup(made)
        return self._joined

    def moves(self) -> tuple[int, int]:
        return (0, 0) if self._joined is None else (self._joined.goals, self._joined.given)


class DeviceGroup:
    """Several devices, connected as one."""

    def __init__(self, joined: Mapping[str, Loopback]) -> None:
        self._joined = joined
        self.given = 0  # nodes, positions and widths

    @property
    def goals(self) -> int:
        return sum(each.goals for each in self._joined.values())

    @property
    def next_deadline(self) -> float:
        return min(each.next_deadline for each in self._joined.values())

    def ask(self, command: Command) -> str | None:
        way = getattr(command, "nodes", (None,))
        self.given += 0 if isinstance(command, Stop) else len(way)
        return self._joined[command.robot].ask(command)

    def pass_time(self, now: float) -> None:
        for each in self._joined.values():
            each.pass_time(now)


def spot(spots: Mapping[str, object], position: Sequence[float]) -> str | None:
    """The name of the spot near this position; None if there is none."""
    return next((name for name, at in spots.items() if near(position, at)), None)


def near(position: Sequence[float], other: object) -> bool:
    return isinstance(other, tuple) and all(abs(a - b) < NEAR for a, b in zip(position, other, strict=True))
