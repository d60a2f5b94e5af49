"""Truth of devices that cells share: what was so of each as a cell gave it back."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from arboleda.drivers import Value
from arboleda.model.plant_model import Cell
from arboleda.rig.world import World

from .robot import RobotTruth


@dataclass(frozen=True, kw_only=True)
class GivenBack:
    """Facts of a device at the time, in s, at which a cell gave it back."""

    at: float
    facts: Mapping[str, Value]


class SharedDevicesTruth:
    """True facts of shared devices as the last task of each cell left them."""

    def __init__(self, world: World, robots: Mapping[str, RobotTruth]) -> None:
        self._world = world
        self._robots = robots
        self._holders: dict[str, str] = {}
        self._given_back: dict[tuple[str, str], GivenBack] = {}  # by device and cell

    def look(self) -> None:
        """Take in which cells gave devices back in this step."""
        holders = self._world.plant.zones.holders
        now = {name: holders[name] for name in self._world.model.shared if name in holders}
        for name, cell in self._holders.items():
            if now.get(name) != cell and name in self._robots:
                self._given_back[name, cell] = GivenBack(at=self._world.now, facts=self._facts_of(name))
        self._holders = now

    def as_left_by(self, cell: Cell, device: str, *, since: float) -> Mapping[str, Value]:
        """The facts of a device as a cell's task that began at `since`, in s, left it; none where that task
        did not have it: a cell leaves a device that it never takes as other cells do.
        """
        own = self._given_back.get((device, cell.name))
        if self._holders.get(device) == cell.name:
            return self._facts_of(device)
        return own.facts if own is not None and own.at >= since else {}

    def _facts_of(self, device: str) -> dict[str, Value]:
        return dict(self._robots[device].body.true_facts)
