"""Truth about parts: each lies ready at a pick-up, hangs in an effector, or was put down or dropped."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import count

from ..truth.arm import ArmTruth
from .deeds import CellTruth

FLOOR, EFFECTOR = "floor", "effector"  # where a part can be, besides a pose
GRIPPED, PUT, RELEASED, FELL, POWER = "gripped", "put down", "released", "fell", "lost with the power"
OUTDATED = "let go for a leader of before"


@dataclass(kw_only=True)
class Part:
    """One part of a cell; `counts`: when it leaves the pick-up, that is a pick.

    It does not count if an effector came back to the pick-up for it after it had lost its part unseen.
    """

    number: int
    cell: str
    counts: bool = False


@dataclass(frozen=True, kw_only=True)
class Passage:
    """Move of a part to another place: how, and to which pose or FLOOR or EFFECTOR.

    `lay_there`: a part lay where the arm gripped it.
    """

    part: Part
    arm: str
    cause: str
    place: str
    lay_there: bool = True


class Parts:
    """Places of all parts; a pick-up never runs out of new ones, and takes back what is returned."""

    def __init__(self) -> None:
        self.passages: list[Passage] = []  # of this step
        self.held: dict[str, Part] = {}  # by arm
        self.returned: dict[tuple[str, str], Part] = {}  # (cell, pose) -> the one that is gripped next there
        self.stations: dict[tuple[str, str], list[Part]] = {}  # (cell, pose), until the customer comes
        self._numbers = count(1)

    def forget(self) -> None:
        """Forget what happened in the step before."""
        self.passages = []

    def start(self, arm: ArmTruth) -> None:
        """Take over that an arm holds a part already."""
        if arm.holding:
            self.held[arm.robot.name] = Part(number=next(self._numbers), cell=arm.cell.name)

    def take_over(self, arm: ArmTruth) -> None:
        """Take over what an arm holds after tasks that nobody followed."""
        self.held.pop(arm.robot.name, None)
        self.start(arm)

    def look(self, cell: CellTruth, arm: ArmTruth) -> None:
        """Take in what an arm did with its part in this step."""
        name = arm.robot.name
        if arm.was_holding and not arm.holding and name in self.held:
            self._part_with(self.held.pop(name), cell, arm)
        if arm.holding and name not in self.held:
            self._grip(cell, arm)
        part = self.held.get(name)
        if part is not None and part.counts and arm.moving and not self._at_a_pick(arm.goal, cell, arm):
            part.counts = False
            cell.picks += 1

    def empty(self, cell: str) -> None:
        """Empty the stations of a cell, as the customer takes what lies there."""
        for key in [key for key in self.stations if key[0] == cell]:
            del self.stations[key]

    def _grip(self, cell: CellTruth, arm: ArmTruth) -> None:
        poses = arm.stood | arm.reaches  # by now it may have moved on
        name, key = arm.robot.name, (cell.cell.name, _pick_like(poses, cell, arm))
        part = self.returned.pop(key, None) or Part(number=next(self._numbers), cell=cell.cell.name)
        part.counts = cell.switch is not None and cell.switch.on
        self.held[name] = part
        lay_there = arm.on and self._at_a_pick(poses, cell, arm)
        passage = Passage(part=part, arm=name, cause=GRIPPED, place=EFFECTOR, lay_there=lay_there)
        self.passages.append(passage)

    def _part_with(self, part: Part, cell: CellTruth, arm: ArmTruth) -> None:
        cause, place = _cause(cell, arm), FLOOR
        if cause in (PUT, RELEASED, OUTDATED):
            place = self._put(part, cell, arm)
        if cause in (PUT, OUTDATED) and place != FLOOR and cell.puts_down:
            cell.places += 1
        self.passages.append(Passage(part=part, arm=arm.robot.name, cause=cause, place=place))

    def _put(self, part: Part, cell: CellTruth, arm: ArmTruth) -> str:
        if not arm.stood:
            return FLOOR
        name = cell.cell.name
        station = _station(arm.stood, cell)
        if self._at_a_pick(arm.stood, cell, arm):
            self.returned[name, _pick_like(arm.stood, cell, arm)] = part
        elif station is not None:
            if cell.task is not None and not cell.blind:  # else the customer has it at once
                self.stations.setdefault((name, station), []).append(part)
        elif not cell.legal_to_open(arm):
            return FLOOR
        return "/".join(sorted(arm.stood))

    def _at_a_pick(self, poses: frozenset[str], cell: CellTruth, arm: ArmTruth) -> bool:
        return any(poses & arm.poses_like(pick.q) for pick in cell.pick_poses)


def _cause(cell: CellTruth, arm: ArmTruth) -> str:
    if arm.lost_power:
        return POWER
    if arm.on or arm.opened:
        return FELL
    switch = cell.switch
    if switch is not None and switch.outdated:
        return OUTDATED
    return RELEASED if switch is not None and switch.released else PUT


def _pick_like(poses: frozenset[str], cell: CellTruth, arm: ArmTruth) -> str:
    return next((pick.name for pick in cell.pick_poses if poses & arm.poses_like(pick.q)), "")


def _station(poses: frozenset[str], cell: CellTruth) -> str | None:
    return next((pose.name for pose in cell.cell.stations if pose.name in poses), None)
