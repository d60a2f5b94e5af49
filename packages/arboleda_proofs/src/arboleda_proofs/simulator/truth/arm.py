"""Truth about one arm: where it stands, which zones it is in or sweeps, what its effector does."""

from __future__ import annotations

import math
from operator import add, sub

from arboleda.drivers import Arm, Position
from arboleda.model.plant_model import Cell, Pose
from arboleda.rig.network import Client
from arboleda.sim.arm import ArmBody
from arboleda.sim.board import Board
from arboleda.wire.payloads import EffectorGoal

from .robot import NOWHERE, Act, RobotTruth

JITTER_STEPS = 2  # a ramp that slows down may speed up again by that much (D. Austin, 2005)
RAMP_SLACK = 1.1  # a stepper's ramp is a little longer than the formula's
Steps = tuple[int, ...]


class ArmTruth(RobotTruth):
    """Truth about one arm; positions are in motor steps per joint.

    `true` is where the axes are, `lost` how many steps each lost since it was last put right. Poses, zones
    and stations have no extent here, so an arm that lost steps counts as where it would be without that, and
    one within its tolerance of a pose as at it. In this sense `here` names the poses where it stands still,
    `stood` those where it stood in this step if it has moved on, and `zones` those where it is or may have
    swept: if it was halted on its way, by what the plant file says of that way, not by poses that happen to
    be near. `opened`: in this step somebody else than the plant opened its effector; `robbed_at`: when that
    last ended a grip.
    """

    SIGNS = ("next_change_us", "effector", "holding")
    PLACE = "q"
    body: ArmBody

    def __init__(self, robot: Arm, cell: Cell, board: Board, client: Client) -> None:
        assert isinstance(board.body, ArmBody)
        self.on, self.holding = board.body.effector, board.body.holding
        self.opened = False
        self.robbed_at = -math.inf
        super().__init__(robot, cell, board, client)
        self.arm = robot
        self.lost: Steps = (0,) * len(robot.joints)
        self.here = self.stood = self.goal = NOWHERE
        self.zones = NOWHERE
        self.true, self.counted = self.body.motors.true_position, self.body.motors.position
        self._shift = tuple(map(sub, self.true, self.counted))  # of the counters, by boots alone
        self._known_steps: dict[Position, Steps] = {}  # of the poses
        self._names: dict[Steps, frozenset[str]] = {}
        self._spots: dict[Steps, frozenset[str]] = {}  # with the points above poses
        space = cell.workspaces.get(robot.name)
        self._poses = space.poses if space else ()
        self._crossings = space.crossings if space else ()
        for pose in self._poses:
            self._enter(pose)
        reference = (0,) * len(robot.joints)  # where homing leads; like home it lies outside all zones
        self._spots.setdefault(reference, frozenset({space.home.name}) if space else NOWHERE)
        self._is_coarse = any(
            within >= joint.step for joint, within in zip(robot.joints, robot.motion.tolerances, strict=True)
        )
        self._between = NOWHERE
        self._free = frozenset(pose.name for pose in self._poses if not pose.zones)
        self._zones_between: dict[frozenset[str], frozenset[str]] = {}
        self._ramp_us = 1e6 * RAMP_SLACK * max(j.speed / j.acceleration for j in robot.joints) + 1e5
        self._speeds: tuple[float, ...] | None = None
        self._jitter = tuple(2 * JITTER_STEPS * j.acceleration / j.step for j in robot.joints)
        self._locate()

    def revise(self, cell: Cell) -> None:
        """Know the poses of another version of its cell, beside those of before."""
        space = cell.workspaces.get(self.arm.name)
        self._poses = space.poses if space else ()
        for pose in self._poses:
            self._enter(pose)

    def be_opened(self, at: float) -> None:
        """Note that somebody else than the plant opens its effector."""
        self.opened = True
        if self.on:
            self.robbed_at = at

    def poses_like(self, q: Position) -> frozenset[str]:
        """The names of all poses that are at `q`."""
        return self._names.get(self._steps(q), NOWHERE)

    @property
    def reaches(self) -> frozenset[str]:
        """The names of the poses where its axes truly are, with all the steps that they lost."""
        return self._names.get(self.true, NOWHERE)

    def stands_at(self, place: Position) -> bool:
        """True if it stands within its tolerance of the motor step nearest to `place`."""
        return self.stands and self._is_near(self.intended, self._steps(place))

    @property
    def let_go(self) -> bool:
        """True if its effector went off in this step, with its power on, and nobody else opened it."""
        return self.was_on and not self.on and not self.lost_power and not self.opened

    @property
    def switched_by(self) -> Act | None:
        """The order by which its effector came in this step to be as it is; None if none was obeyed so."""
        on, switched_by = self.was_on, None
        for act in self.acts:
            if isinstance(act.goal, EffectorGoal) and act.goal.on != on:
                on, switched_by = act.goal.on, act
        return switched_by if on == self.on else None

    @property
    def stands(self) -> bool:
        """True if it does not move, or only counts as moving for a moment as it is at its goal."""
        return not self.moving or self.body.motors.targets == self.body.motors.position

    @property
    def intended(self) -> Steps:
        """The position at which it would be if it had lost no steps."""
        return tuple(map(sub, self.true, self.lost))

    @property
    def at_reference(self) -> bool:
        return not self.moving and not any(self.intended)

    @property
    def _came_home(self) -> bool:
        return not any(self.body.motors.position)

    @property
    def outside(self) -> str | None:
        """The first joint that stands beyond its limits by more than lost steps and a ramp explain."""
        rows = zip(self.arm.joints, self.true, self.lost, strict=True)
        for joint, steps, lost in rows:
            slack = (abs(lost) + 2) * joint.step
            if not joint.lower - slack <= steps * joint.step <= joint.upper + slack:
                return joint.name
        return None

    def forget(self) -> None:
        super().forget()
        self.was_on, self.was_holding, self.opened = self.on, self.holding, False

    @property
    def _slows_down(self) -> bool:
        return self.stopping

    def _follow(self, was_moving: bool) -> None:
        body = self.body
        self.on, self.holding = body.effector, body.holding
        true, counted = body.motors.true_position, body.motors.position
        still = not (was_moving or self.moving or self.lost_power)
        self.jumped = still and counted != self.counted
        if self.lost_power and not was_moving:
            self.lost = tuple(map(add, self.lost, map(sub, true, self.true)))
        self.true, self.counted = true, counted
        self._follow_drift(tuple(map(sub, true, counted)))
        self._locate(was_moving)
        self._follow_speed()

    def _follow_drift(self, drift: Steps) -> None:
        """Follow the counters' error: by boots, and by lost steps; homing ends both."""
        if not any(drift):
            self._shift = self.lost = drift
        elif self.lost_power:
            self._shift = tuple(map(sub, drift, self.lost))
        else:
            self.lost = tuple(map(sub, drift, self._shift))

    def _locate(self, was_moving: bool = False) -> None:
        place = self.intended
        was_here, was_bound_for = self.here, self.goal
        self.here = self._found(self._names, place) if self.stands else NOWHERE
        moved_on = not self.stands or self._switched_first
        self.stood = was_here if moved_on else self.here
        if was_moving and moved_on and self._arrived:
            self.stood = was_bound_for
        target = tuple(map(add, self.body.motors.targets, self._shift)) if self.moving else place
        self.goal = self._found(self._names, target)
        spot = self._found(self._spots, target)
        if not any(act.moves for act in self.acts):
            spot &= self._between | self._free
        self._between = self._between | spot if self.moving or not spot else spot
        self.zones = self._zones_of(self._between)

    @property
    def _switched_first(self) -> bool:
        """True if its effector was switched before it was told to move; a way of one step is done at once."""
        moves = [act.moves for act in self.acts if act.moves or isinstance(act.goal, EffectorGoal)]
        return any(moves) and not moves[0]

    def _found(self, book: dict[Steps, frozenset[str]], place: Steps) -> frozenset[str]:
        """The names that a book has for a place, or for those within the arm's tolerance of it."""
        if place in book or not self._is_coarse:
            return book.get(place, NOWHERE)
        return NOWHERE.union(*(names for there, names in book.items() if self._is_near(place, there)))

    def _is_near(self, here: Steps, there: Steps) -> bool:
        rows = zip(self.arm.joints, here, there, self.arm.motion.tolerances, strict=True)
        return all(abs(a - b) * joint.step <= within for joint, a, b, within in rows)

    def _zones_of(self, poses: frozenset[str]) -> frozenset[str]:
        """The zones of these poses and of the moves between them."""
        if poses not in self._zones_between:
            inside = [pose.zones for pose in self._poses if pose.name in poses]
            crossed = [each.zones for each in self._crossings if {each.a, each.b} <= poses]
            self._zones_between[poses] = NOWHERE.union(*inside, *crossed)
        return self._zones_between[poses]

    def _follow_speed(self) -> None:
        """Note if an axis gets faster while the arm stops."""
        if not self.stopping:
            self._speeds = None
            return
        speeds = self.body.motors.speeds
        slowest = self._speeds or speeds
        self.sped_up = any(map(_faster, speeds, slowest, self._jitter))
        self._speeds = tuple(map(min, speeds, slowest))

    def _ends_soon(self, now_us: int) -> bool:
        due = self.body.next_change_us
        return due is not None and due <= now_us + self._ramp_us

    def _goes_on(self) -> bool:
        return False  # `sped_up` covers it; the length of the ramp was judged when it heard the stop

    def _enter(self, pose: Pose) -> None:
        for book, q in ((self._names, pose.q), (self._spots, pose.q), (self._spots, pose.above)):
            if q is not None:
                place = self._known_steps[q] = self._steps(q)
                book[place] = book.get(place, NOWHERE) | {pose.name}

    def _steps(self, q: Position) -> Steps:
        if q in self._known_steps:
            return self._known_steps[q]
        assert isinstance(q, tuple)
        return tuple(joint.steps(value) for joint, value in zip(self.arm.joints, q, strict=True))


def _faster(now: float, slowest: float, jitter: float) -> bool:
    """True if an axis sped up by more than its ramp's `jitter`, in (steps/s)2."""
    return now * now > slowest * slowest + jitter
