"""What truly happened at the virtual boards, whatever the plant believed."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import cast

from arboleda.core.messages import TaskChanged, TaskState
from arboleda.core.model import Arm, Cell, Pose
from arboleda.sim.arm import ArmBody
from arboleda.sim.board import Board
from arboleda.sim.mobile import MobileBody
from arboleda.wire.transport import Publication

from .rig import Rig

STARTS_MOTION = ("juntas", "camino", "referencia")
FLOOR, EFFECTOR, PICKUP = "floor", "effector", "pick-up"  # where a part can be, besides a station


@dataclass(frozen=True, kw_only=True)
class Switch:
    """An effector that was switched, and the named poses at which its arm stood still; none elsewhere.

    `legal`: on or off at the pick-up, or off at the station of the cell's last task.
    """

    at: float
    arm: str
    on: bool
    poses: frozenset[str]
    legal: bool


class Witness:
    """Looks at the boards of a rig after every step, and keeps what must never happen.

    `false_successes`: tasks called done that were not; `illegal`: effectors switched off a legal pose;
    `collisions`: two arms in one zone; `part`: arm -> where its part is.
    """

    def __init__(self, rig: Rig) -> None:
        self.rig = rig
        self.switches: list[Switch] = []
        self.false_successes: list[str] = []
        self.collisions: list[str] = []
        self.part: dict[str, str] = {}
        self._arms = {cell.arm.name: _ArmTruth(cell, rig.devices.boards) for cell in rig.model.cells}
        self._changes = len(rig.changes)
        self._started: dict[str, int] = {}
        self._goals: dict[str, Pose] = {}
        self._exits: dict[str, int] = {}  # cell -> the node that ends the way of its last task's mobile
        self._left: set[str] = set()
        self._arrived: set[str] = set()
        rig.watchers.append(self.look)

    @property
    def illegal(self) -> list[Switch]:
        """Effectors that were switched where they must not be."""
        return [each for each in self.switches if not each.legal]

    def look(self) -> None:
        """Take in what the boards do now, then judge what the plant said of its tasks."""
        for name, arm in self._arms.items():
            on_before, held_before, lost_power = arm.on, arm.held, arm.look()
            if arm.on != on_before and not lost_power:
                self._switched(name, arm)
            if arm.held != held_before:
                put_down = arm.here if not arm.on and not lost_power else frozenset()
                self.part[name] = EFFECTOR if arm.held else "/".join(sorted(put_down)) or FLOOR
        self._watch_mobiles()
        self._watch_zones()
        for change in self.rig.changes[self._changes :]:
            self._judge(change)
        self._changes = len(self.rig.changes)

    def _switched(self, name: str, arm: _ArmTruth) -> None:
        places = arm.poses_like(arm.cell.pickup.q)
        goal = self._goals.get(arm.cell.name)
        if goal is not None and not arm.on:
            places |= arm.poses_like(goal.q)
        legal = bool(arm.here & places)
        self.switches.append(Switch(at=self.rig.now, arm=name, on=arm.on, poses=arm.here, legal=legal))

    def motions_since(self, mark: int, robots: Iterable[str]) -> list[Publication]:
        """What could have started something at these robots' boards: motion goals, effector on.

        `mark` is a former length of `rig.to_boards`.
        """
        boards = {self.rig.model.robots[robot].mqtt for robot in robots}
        reached = [each for _, each in self.rig.to_boards[mark:] if each.topic.split("/")[0] in boards]
        return [each for each in reached if _starts_something(each)]

    def _watch_mobiles(self) -> None:
        for name, node in self._exits.items():
            mobile = cast(MobileBody, self.rig.devices.boards[self.rig.model.cell(name).mobile.mqtt].body)
            if mobile.moving:
                self._left.add(name)
            elif name in self._left and mobile.node == node:
                self._arrived.add(name)

    def _watch_zones(self) -> None:
        for zone in self.rig.model.zones:
            inside = sorted(name for name, arm in self._arms.items() if zone in arm.zones)
            if len(inside) > 1:
                self.collisions.append(f"{' and '.join(inside)} in {zone} at {self.rig.now:.2f}")

    def _judge(self, change: TaskChanged) -> None:
        if change.state is TaskState.RUNNING:
            self._started[change.task] = len(self.switches)
            cell, path = self._cell(change), self.rig.plant.intake.tasks[change.task].order.path
            self._goals[cell.name] = self._goal(change)
            self._exits.pop(cell.name, None)
            self._left.discard(cell.name)
            self._arrived.discard(cell.name)
            if path is not None:
                self._exits[cell.name] = path.nodes[-1]
        elif change.state is TaskState.DONE and (why := self._not_done(change)):
            self.false_successes.append(f"{change.text}: {why}")

    def _not_done(self, change: TaskChanged) -> str | None:
        """What is missing of a task that the plant calls done."""
        cell, goal = self._cell(change), self._goal(change)
        order = self.rig.plant.intake.tasks[change.task].order
        since = self.switches[self._started[change.task] :]
        switched = [(each.on, each.poses) for each in since if each.arm == cell.arm.name]
        way = [(True, self._arms[cell.arm.name].poses_like(cell.pickup.q))]
        way += [(False, self._arms[cell.arm.name].poses_like(goal.q))]
        last = cell.home if order.station else goal
        if switched != way:
            return f"the effector was switched {switched}"
        if last.name not in self._arms[cell.arm.name].here:
            return f"the arm does not stand at {last.name}"
        if order.path and cell.name not in self._arrived:
            return f"the mobile never stood at node {order.path.nodes[-1]}"
        return None

    def _cell(self, change: TaskChanged) -> Cell:
        return self.rig.model.cell(self.rig.plant.intake.tasks[change.task].order.cell)

    def _goal(self, change: TaskChanged) -> Pose:
        """Where the part of a task belongs."""
        return self.rig.plant.intake.tasks[change.task].order.station or self._cell(change).palletizing.place


class _ArmTruth:
    """One arm: where it stands, what its effector does, which zones it may be in."""

    def __init__(self, cell: Cell, boards: dict[str, Board]) -> None:
        self.cell = cell
        self._board = boards[cell.arm.mqtt]
        self._body = cast(ArmBody, self._board.body)
        self._boot = self._board.boot_id
        self._names: dict[tuple[int, ...], frozenset[str]] = {}
        for pose in cell.poses:
            place = _steps(cell.arm, pose.q)
            self._names[place] = self._at(place) | {pose.name}
        self.here: frozenset[str] = frozenset()
        self._between: frozenset[str] = frozenset()
        self.on = self._body.effector
        self.held = self._body.holding
        self.zones: frozenset[str] = frozenset()
        self._displaced = False
        self._shared = bool(cell.crossings) or any(pose.zones for pose in cell.poses)
        self.look()

    def look(self) -> bool:
        """Take in the present; whether the board lost its power since the last look."""
        lost_power, self._boot = self._boot != self._board.boot_id, self._board.boot_id
        self._displaced = (self._displaced or lost_power) and not self._board.homed
        self.on, self.held = self._body.effector, self._body.holding
        still = self._body.position == self._body.targets and not self._displaced
        self.here = self._at(self._body.position) if still else frozenset()
        if not self._displaced and self._shared:
            self._between = self.here or (self._between | self._at(self._body.targets))
            self.zones = self._zones_between()
        return lost_power

    def poses_like(self, q: tuple[float, ...]) -> frozenset[str]:
        """The names of all poses that are where `q` is."""
        return self._at(_steps(self.cell.arm, q))

    def _at(self, steps: tuple[int, ...]) -> frozenset[str]:
        return self._names.get(steps, frozenset())

    def _zones_between(self) -> frozenset[str]:
        inside = [pose.zones for pose in self.cell.poses if pose.name in self._between]
        crossed = [each.zones for each in self.cell.crossings if {each.a, each.b} <= self._between]
        return frozenset[str]().union(*inside, *crossed)


def _steps(arm: Arm, q: tuple[float, ...]) -> tuple[int, ...]:
    return tuple(joint.steps(value) for joint, value in zip(arm.joints, q, strict=True))


def _starts_something(publication: Publication) -> bool:
    channel = publication.topic.split("/")[1]
    return channel in STARTS_MOTION or (channel == "efector" and b'"efector":1' in publication.payload)
