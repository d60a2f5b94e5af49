"""The keys of the driver in a plant file."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Literal

from arboleda.drivers import Device, Evidence, Mobile, Robot

NOT_IN_TOPICS = frozenset("/+#$")
TYPES: dict[str, tuple[type, ...]] = {"loaded": (bool,), "charging": (bool,), "battery": (int, float)}
KNOWN = "loaded: bool, charging: bool, battery: number"
MAJOR = {"2.0": "v2", "2.1": "v2", "3.0": "v3"}


@dataclass(frozen=True, kw_only=True)
class EdgeAction:
    """Action of a vehicle on its way between two nodes, in both directions."""

    between: tuple[str, str]
    action: str
    values: dict[str, bool | int | float | str] = field(default_factory=dict)
    blocking: Literal["NONE", "SOFT", "HARD"] = "NONE"


@dataclass(frozen=True, kw_only=True)
class Settings:
    """Settings of the driver `vda5050`: the vehicle and its broker, its map, nodes and actions.

    `nodes` are its names of the nodes of the grid, in their order. `base` is how many nodes ahead of the
    vehicle are released, 0: all of them. `instant` are the verbs that it does at once, also on its way;
    `edges` is what it does between nodes.
    `silent_after_s` is after how long without a state it is lost.
    """

    broker: str
    manufacturer: str
    serial: str
    version: Literal["2.0", "2.1", "3.0"] = "2.1"
    interface: str = "uagv"
    map: str = "map"
    nodes: tuple[str, ...] = ()
    base: int = 2
    instant: tuple[str, ...] = ()
    edges: tuple[EdgeAction, ...] = ()
    silent_after_s: float = 35.0

    def __post_init__(self) -> None:
        for name in ("manufacturer", "serial", "interface"):
            if not getattr(self, name) or NOT_IN_TOPICS & set(getattr(self, name)):
                raise ValueError(f"{name} is {getattr(self, name)!r}; allowed: a word without / + # $")
        if self.base < 0:
            raise ValueError(f"base is {self.base}; allowed: 0 (all nodes) or more")
        if not 0.5 <= self.silent_after_s <= 3600:
            raise ValueError(f"silent_after_s is {self.silent_after_s:g}; allowed: 0.5 to 3600")
        if len(set(self.nodes)) < len(self.nodes):
            raise ValueError("nodes has a name twice")

    @property
    def vehicle(self) -> str:
        return f"{self.manufacturer}/{self.serial}"

    @property
    def topics(self) -> str:
        """The prefix of all topics of the vehicle."""
        return f"{self.interface}/{MAJOR[self.version]}/{self.vehicle}"

    def node_names(self, mobile: Mobile | None) -> tuple[str, ...]:
        """The vehicle's name of each node of the grid."""
        return self.nodes or tuple(str(node) for node in range(mobile.grid.size if mobile else 0))

    def problems(self, device: Robot) -> Iterable[tuple[tuple[str | int, ...], str]]:
        """Settings that do not fit a device, each as its keys and a sentence."""
        if device.evidence is not Evidence.IDS:
            yield (), f"{device.name} has evidence: {device.evidence.value}; a vehicle of VDA 5050 proves ids"
        if isinstance(device, Mobile):
            if self.nodes and len(self.nodes) != device.grid.size:
                yield (
                    ("nodes",),
                    f"there are {len(self.nodes)} names for the {device.grid.size} nodes of {device.name}",
                )
            yield from self._edge_problems(device)
        elif isinstance(device, Device):
            wrong = [name for name, type in device.kind.facts.items() if type.type not in TYPES.get(name, ())]
            if wrong:
                yield (), f"a vehicle says nothing of {', '.join(wrong)}; it has {KNOWN}"
        else:
            yield (), f"{device.name} is no mobile robot and of no declared kind"

    def _edge_problems(self, mobile: Mobile) -> Iterable[tuple[tuple[str | int, ...], str]]:
        numbers = {name: number for number, name in enumerate(self.node_names(mobile))}
        for row, edge in enumerate(self.edges):
            start, end = edge.between
            strange = [name for name in edge.between if name not in numbers]
            if strange:
                yield ("edges", row, "between"), f"no node {strange[0]!r}; there are {', '.join(numbers)}"
            elif numbers[end] not in mobile.grid.neighbours(numbers[start]):
                yield ("edges", row, "between"), f"{start} and {end} are no neighbours on the grid"
