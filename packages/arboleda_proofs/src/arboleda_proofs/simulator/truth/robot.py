"""Truth about one robot: its power and its reference, what its board heard and carried out."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from operator import attrgetter
from typing import Any

from arboleda.drivers import Command, Evidence, Position, Robot, StopMode
from arboleda.model.plant_model import Cell, Interlock
from arboleda.rig.network import Client
from arboleda.sim.board import Board
from arboleda.wire.payloads import EffectorGoal, Goal, HomeGoal, JointsGoal, PathGoal, StopGoal
from arboleda.wire.topics import Channel
from arboleda.wire.transport import Delivery, Publication

from ..commands import goal as goal_of

NOWHERE: frozenset[str] = frozenset()
MOTIONS = (JointsGoal, PathGoal, HomeGoal)
BEATS = f"/{Channel.BEAT.value}"
UNDER_WAY = 64  # publications of the bridge that may still reach the board


@dataclass(frozen=True, kw_only=True)
class Act:
    """A goal that a board carried out, and what held just before.

    `ours`: our bridge published it; `outdated`: it did so before another process led, the board got it after
    that, and no number in it lets the board tell; `latched`: the board had obeyed a latching stop that was
    not cleared; `homed`: its counters were right; `moves`: it sets the robot in motion; `starts`: a stop
    forbids it.
    """

    goal: Goal
    ours: bool
    outdated: bool
    latched: bool
    homed: bool
    moves: bool
    starts: bool


class RobotTruth:
    """One robot, followed step by step.

    `again`: it is to be looked at, even if what `signs` gets of its body is `last_signs`, and so is `boot`.
    `stopping`: from a stop or halt that its board heard until it stands still or gets a new goal. Of one
    step, until `forget`: `acts` and `lost_power`; `started`, `swerved`, `jumped`: it began to move, changed
    its way or is elsewhere, and nothing that it heard explains it; `sped_up`, `runs_on`: it was told to stop
    and does not.
    """

    SIGNS: tuple[str, ...]  # attributes of a body of which one changes with anything that happens
    PLACE: str  # the name of the place in lies of boards
    FORGETS = False  # what was switched may be as in the beginning after a boot
    zones = NOWHERE  # where it is, or may have swept
    here = NOWHERE  # the targets at which it stands still
    stood = NOWHERE  # the same, in this step, if it has moved on
    unmet: Sequence[tuple[Command, str]] = ()  # commands that it carries out without their needs
    cut_short = False  # it ended work that goes on through a stop, and nothing explains that

    overdue = False  # in this step it switched so late that nobody counts on that any more
    switched_from: float | None = None  # when it was given the switch that changed a fact in this step, s

    worked_from: float | None = None  # for a machine that reports only ends: when it began to move, s

    def __init__(self, robot: Robot, cell: Cell, board: Board, client: Client) -> None:
        self.robot = robot
        self.cell = cell
        self.board = board
        self.body: Any = board.body
        self.moving = board.body.moving
        self.homed = board.homed
        self.latched = board.latched
        self.stopping = False
        self.acts: list[Act] = []
        self.again = True  # look even if nothing seems to have changed
        self.booted_us = -1  # when it last lost its power
        self.signs = attrgetter(*self.SIGNS)
        self._client = client
        self._executed: list[Goal] = []  # what the board says that it carried out in this step
        self._ahead: list[tuple[Delivery, bool]] = []  # what reached it and was not yet heard; if outdated
        self.boot = board.boot_id
        self._left = 0  # how many of `_ahead` were there before this step
        self._ours: deque[tuple[str, bytes]] = deque(maxlen=UNDER_WAY)
        self._homing = self._put_right = False
        self.taken_away = False  # somebody has moved it by hand since it was last told to move
        self.put_right_at = -math.inf  # when somebody put it at its reference last, s
        self._arrived = not self.moving  # it stood still at some time in this step
        self.last_signs: object = ()
        self._due: int | None = None  # when its motion was to end
        self._was_due: int | None = None  # the same, before this step
        self.forget()

    @property
    def unbidden(self) -> bool:
        """True if what moved it in this step was none of its goals."""
        return False

    @property
    def let_go(self) -> bool:
        """True if it let go in this step of what it held, by itself and with its power on."""
        return False

    def stands_at(self, place: Position) -> bool:
        """True if it stands at this place; what goes nowhere stands at none."""
        return False

    def forget(self) -> None:
        """Forget what happened in the step before."""
        if self.acts:
            self.acts = []
        self.lost_power = self.started = self.swerved = self.jumped = False
        self.sped_up = self.runs_on = False
        self.stood = self.here

    def expect(self, publication: Publication) -> None:
        """Expect a command that our bridge published for it."""
        self._ours.appendleft((publication.topic, publication.payload))  # the last one is asked for most

    def put_right(self, now: float) -> None:
        """Put its counters right, as somebody has put it at its reference by hand."""
        self.homed = self.again = self._put_right = self.taken_away = True
        self.put_right_at = now

    def be_locked(self, locks: tuple[Interlock, ...]) -> None:
        """Have it occupy zones whenever its facts differ from one of these, one for each cell."""

    def revise(self, cell: Cell) -> None:
        """Know the places of another version of its cell, beside those of before."""

    def be_opened(self, at: float) -> None:
        """Note that somebody else than the plant has it let go of what it holds."""

    def reach(self, delivery: Delivery, *, outdated: bool) -> None:
        """Note a message that is at its board, which has not read it yet; `outdated`: from a bridge that
        another one had superseded meanwhile.
        """
        self._ahead.append((delivery, outdated))
        self.again = True

    def carry_out(self, goal: Goal) -> None:
        """Take in a goal that its board carries out."""
        self._executed.append(goal)
        self.again = True

    def look(self, now_us: int) -> None:
        """Take in the present state; called if there is more to see than a body on its way."""
        self._take_in(now_us)
        self.again = bool(self._ahead) or self._slows_down

    def _take_in(self, now_us: int) -> None:
        due, self._due, self.last_signs = self._due, self.body.next_change_us, self.signs(self.body)
        self._was_due = due
        turned = due != self._due
        if self.board.boot_id != self.boot:
            self._boot_up(now_us)
        was_stopping = self.stopping
        if self._homing and due is not None and due <= now_us:
            self._end_homing()
        if self._ahead or self._executed:
            self._hear()
        was_moving, self.moving = self.moving, self.body.moving
        self._arrived = not was_moving or (due is not None and due <= now_us)
        self.stopping = self.stopping and self.moving
        commanded, soon = any(act.moves for act in self.acts), self._ends_soon(now_us)
        self.started = self.moving and not was_moving and not commanded
        self.swerved = self.moving and was_moving and turned and not commanded and not soon
        self.runs_on = self.stopping and (self._goes_on() if was_stopping else not soon)
        self._follow(was_moving)
        self.jumped = self.jumped and not self._put_right
        self._put_right = False
        self._follow_homing()

    @property
    def blind(self) -> bool:
        """True if nobody can know where it is by what its board tells: at `state`, only that it moved and
        stopped; else counters that a boot may have set to 0, of a board that does not report a homing.
        """
        if self.robot.evidence is Evidence.STATE:
            return True
        return not (self.homed or self.robot.says_homed)

    @property
    def _slows_down(self) -> bool:
        """True while it slows down on a ramp, which is to be looked at in every step."""
        return False

    def _follow(self, was_moving: bool) -> None:
        """Take in the present place of the body."""
        raise NotImplementedError

    def _ends_soon(self, now_us: int) -> bool:
        """True if the present motion may end so soon that it can be a stopping ramp."""
        raise NotImplementedError

    def _goes_on(self) -> bool:
        """True if it did more since the last look than a robot that was told to stop before that."""
        raise NotImplementedError

    @property
    def at_reference(self) -> bool:
        """True if it truly stands where homing ends."""
        raise NotImplementedError

    @property
    def _came_home(self) -> bool:
        """True if the body is where its homing routine ends, wherever it sets out for in this step."""
        raise NotImplementedError

    def _boot_up(self, now_us: int) -> None:
        self.boot, self.booted_us = self.board.boot_id, now_us
        self.lost_power = True
        self.homed = self.latched = self._homing = self.stopping = False
        del self._ahead[: self._left]
        self._left = 0

    def _hear(self) -> None:
        """Go through what the board heard and did, in order."""
        executed, self._executed = self._executed, []
        waiting = sum(map(_is_command, self._client.inbox)) if self._ahead else 0
        count = len(self._ahead) - waiting
        for delivery, outdated in self._ahead[:count]:
            goal = None if delivery.retain else goal_of(delivery.topic, delivery.payload, self.body.axes)
            if goal is not None:
                self._obeyed(goal)
            if executed and goal == executed[0]:
                ours = (delivery.topic, delivery.payload) in self._ours
                self._did(executed.pop(0), ours=ours, outdated=outdated and ours and goal.epoch is None)
        del self._ahead[:count]
        self._left = waiting
        for goal in executed:  # nobody sent it: the board acts on its own
            self._did(goal, ours=False, outdated=False)

    def _obeyed(self, goal: Goal) -> None:
        """Take in a stop, whatever its numbers; one of the instant of a boot may be older than that."""
        if isinstance(goal, StopGoal) and goal.mode is not StopMode.CLEAR and not self.lost_power:
            self.latched = self.latched or goal.mode is StopMode.LATCH
            self._homing = False
            self.stopping = True

    def _did(self, goal: Goal, *, ours: bool, outdated: bool) -> None:
        moves = self._moves(goal)
        starts = moves or self._grips(goal)
        act = Act(
            goal=goal,
            ours=ours,
            outdated=outdated,
            latched=self.latched,
            homed=self.homed,
            moves=moves,
            starts=starts,
        )
        self.acts.append(act)
        if moves:
            self.stopping = self.taken_away = False
        if isinstance(goal, HomeGoal):
            self.homed, self._homing = False, True
        if isinstance(goal, StopGoal) and goal.mode is not StopMode.HALT:
            self.latched = goal.mode is StopMode.LATCH

    def _moves(self, goal: Goal) -> bool:
        """True if a goal sets it in motion."""
        return isinstance(goal, MOTIONS)

    def _grips(self, goal: Goal) -> bool:
        """True if a stop forbids a goal although that moves nothing."""
        return isinstance(goal, EffectorGoal) and goal.on

    def _end_homing(self) -> None:
        """End the homing; it may have ended before a stalled board finds a stop in its inbox."""
        if self._came_home:
            self.homed, self._homing = True, False

    def _follow_homing(self) -> None:
        if self._homing and not self.moving:
            self.homed, self._homing = self.at_reference, False


def _is_command(event: object) -> bool:
    return isinstance(event, Delivery) and not event.topic.endswith(BEATS)
