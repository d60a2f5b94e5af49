"""Truth about effectors: where each was switched and by whom, and whether it brought a part."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

from arboleda.drivers import Command, Motion, MotionState, Report, Switch
from arboleda.engine.inspection import ledger_of
from arboleda.model.plant_model import Cell
from arboleda.rig.world import World
from arboleda.wire.payloads import EffectorGoal

from .arm import ArmTruth
from .robot import NOWHERE, RobotTruth


@dataclass(frozen=True, kw_only=True)
class Switching:
    """A change of an effector, at the named poses where its arm stood still.

    `by_command`: its board carried out a command for it; `outdated`: it did so for an order of a process that
    no longer led when that arrived, and that has no number by which the board could have refused it;
    `by_others`: somebody else than the plant opened it; `taken_away`: somebody had put the arm elsewhere by
    hand; `is_at_place`: a part can be taken there, or put, as far as the plant file says that.
    """

    arm: str
    on: bool
    poses: frozenset[str]
    by_command: bool
    outdated: bool
    by_others: bool
    lost_power: bool
    taken_away: bool
    is_at_place: bool

    @property
    def where(self) -> str:
        """The names of these poses, for people."""
        return "/".join(sorted(self.poses)) if self.poses != NOWHERE else "no pose"


@dataclass(frozen=True, kw_only=True)
class Told:
    """An effector was told to grip, or to let go, for a task of a cell."""

    cell: str
    at: float


@dataclass(frozen=True, kw_only=True)
class EmptyHanded:
    """An arm was told to let go of what it did not have; `robbed`: somebody had opened its effector."""

    told: Told
    robbed: bool


class Effector:
    """One effector: what it was told last, and what became of its part since it was told to grip.

    `empty_handed` is None where it brought the part to where it was told to let go of that. `put_down` counts
    the parts that it let go of where they can be. `unseen_at`: when nobody could know last where its arm is.
    `felt` is what its board said last of its part on the way, since it closed; None where it said nothing.
    """

    def __init__(self, arm: ArmTruth) -> None:
        self.arm = arm
        self.gripped: Told | None = None
        self.let_go: Told | None = None
        self.empty_handed: EmptyHanded | None = None
        self.put_down = 0
        self.unseen_at = -math.inf
        self.felt: bool | None = None
        self._moves = self._is_said_on = False
        self._said: bool | None = None
        self._said_since, self._on_way_since, self._felt_at = -math.inf, math.inf, -math.inf
        self._heard_at = 0.0
        self._is_empty = self._is_robbed = self._carries = False
        self._nothing_since: float | None = None  # for how long its board has said that no part is there

    def tell(self, told: Told, *, grips: bool) -> None:
        """Take in that the plant tells it to grip, or to let go."""
        if grips:
            self.gripped, self.let_go, self.empty_handed = told, None, None
            self.felt = None
            self._is_empty = self._is_robbed = self._carries = False
            return
        if self._carries and self.let_go is None and (self._is_empty or self._is_robbed):
            self.empty_handed = EmptyHanded(told=told, robbed=self._is_robbed)
        self.let_go = told

    def set_out(self) -> None:
        """Take in that its arm is told to move."""
        self._carries = True

    def feel(self, now: float, *, is_there: bool, debounce_s: float) -> None:
        """Take in what the plant hears of a part; that none is there counts once it was said for
        `debounce_s`.
        """
        since = now if self._nothing_since is None else self._nothing_since
        self._nothing_since = None if is_there else since
        is_settled = not is_there and now - since >= debounce_s
        if is_settled and self.arm.on and not self.arm.holding and self.let_go is None:
            self._is_empty = True
        if is_there is not self._said:
            self._said, self._said_since = is_there, now
        is_of_way = now - max(self._on_way_since, self._said_since) >= debounce_s
        if is_of_way and self.let_go is None and is_there is not self.felt:
            self.felt, self._felt_at = is_there, now

    def restart(self) -> None:
        """Begin with a new plant, which hears the arm anew. That a part was seen on the way it has not kept,
        nor maybe what the old one heard last.
        """
        self._on_way_since = math.inf
        if self.felt or self._felt_at >= self._heard_at:
            self.felt = None

    def hear(self, report: Report, *, stale_after_s: float) -> None:
        """Take in what the plant hears of the arm."""
        was_lost, self._heard_at = report.at - self._heard_at >= stale_after_s, report.at
        if report.state is not None:
            self._moves = report.state is MotionState.MOVING
        if report.effector is not None:
            self._is_said_on = report.effector
        if not (self._moves and self._is_said_on):
            self._on_way_since = math.inf
        elif was_lost or self._on_way_since == math.inf:
            self._on_way_since = report.at

    def look(self) -> None:
        """Take in what somebody did to it in this step."""
        if self.arm.opened and self.arm.was_holding and self.let_go is None:
            self._is_robbed = True


class GripsTruth:
    """Effectors of all arms by the name of the arm. Of this step: `switched`, and `stray`, the arms that the
    plant told to grip though no task of their cell ran.
    """

    def __init__(
        self, world: World, robots: Mapping[str, RobotTruth], unseen: Callable[[RobotTruth], bool]
    ) -> None:
        self.switched: list[Switching] = []
        self.stray: list[str] = []
        arms = [robot for robot in robots.values() if isinstance(robot, ArmTruth)]
        self.effectors = {arm.robot.name: Effector(arm) for arm in arms if arm.robot.has_effector}
        self._world, self._unseen = world, unseen

    def of(self, cell: str, since: float) -> list[Effector]:
        """Those that were told to grip for a task of a cell since then."""
        told = [(each.gripped, each) for each in self.effectors.values()]
        return [each for last, each in told if last is not None and last.cell == cell and last.at >= since]

    def forget(self) -> None:
        """Forget what happened in the step before."""
        if self.switched or self.stray:
            self.switched, self.stray = [], []

    def follow(self, changed: Iterable[RobotTruth]) -> None:
        """Take in what arms did in this step."""
        for robot in changed:
            effector = self.effectors.get(robot.robot.name)
            if effector is None:
                continue
            arm = effector.arm
            effector.look()
            if arm.on != arm.was_on:
                switching = self._switching(arm)
                self.switched.append(switching)
                effector.put_down += arm.let_go and arm.was_holding and switching.is_at_place
            if self._unseen(arm):
                effector.unseen_at = self._world.now

    def restart(self) -> None:
        """Begin with a new plant."""
        for effector in self.effectors.values():
            effector.restart()

    def hear(self, reports: Iterable[Report]) -> None:
        """Take in what the plant hears of parts."""
        timing = self._world.model.timing
        debounce_s, stale_after_s = timing.piece_debounce_s, timing.stale_after_s
        for report in reports:
            if report.robot in self.effectors:
                self.effectors[report.robot].hear(report, stale_after_s=stale_after_s)
            if report.piece is not None and report.robot in self.effectors:
                self.effectors[report.robot].feel(report.at, is_there=report.piece, debounce_s=debounce_s)

    def command(self, command: Command, *, runs: Callable[[str], bool]) -> None:
        """Take in a command; `runs` says whether a task of a cell is at work."""
        effector = self.effectors.get(command.robot)
        if effector is None:
            return
        if isinstance(command, Motion):
            effector.set_out()
        elif isinstance(command, Switch) and command.grips is not None:
            entry = ledger_of(self._world.plant).entries.get(command.id)
            cell = entry.cell if entry is not None else ""
            effector.tell(Told(cell=cell, at=self._world.now), grips=command.grips)
            if command.grips and not runs(cell):
                self.stray.append(command.robot)

    def _switching(self, arm: ArmTruth) -> Switching:
        goals = [act.goal for act in arm.acts]
        return Switching(
            arm=arm.robot.name,
            on=arm.on,
            poses=arm.stood,
            by_command=any(isinstance(goal, EffectorGoal) and goal.on == arm.on for goal in goals),
            outdated=arm.switched_by is not None and arm.switched_by.outdated,
            by_others=arm.opened,
            lost_power=arm.lost_power,
            taken_away=arm.taken_away,
            is_at_place=self._is_at_place(arm),
        )

    def _is_at_place(self, arm: ArmTruth) -> bool:
        cells = self._world.model.cells_of[arm.robot.name]
        places = [part_poses(cell, arm.robot.name, puts=not arm.on) for cell in cells]
        return any(poses is None or not poses.isdisjoint(arm.stood) for poses in places)


def part_poses(cell: Cell, robot: str, *, puts: bool) -> frozenset[str] | None:
    """The names of the poses at which a robot of a cell takes parts, or `puts` them; None: it may anywhere.

    Of the robot that takes what another one brings, all of them are known: the handover, where parts lie
    ready, the places that are counted; it puts parts also at targets of groups, and takes them back.
    """
    if cell.handover is None or cell.handover.taker != robot:
        return None
    space = cell.reach[robot]
    named = {*cell.handover.targets, *(place.target for place in cell.counted)}
    if puts:
        named.update(*cell.groups.values())
    poses = {pose.name for target, pose in space.targets.items() if target in named}
    return frozenset(poses.union(space.supplies))
