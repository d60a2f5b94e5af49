"""Truth about a device: its facts, the work that it carries out, and the zones that it is in the way of."""

from __future__ import annotations

from arboleda.drivers import Command, Robot, Switch, Value, needs_clear
from arboleda.model.plant_model import Cell, Interlock
from arboleda.rig.network import Client
from arboleda.sim.board import Board
from arboleda.wire.payloads import Goal, VerbGoal

from .robot import Act, RobotTruth

Facts = dict[str, Value]

GIVEN_UP = 1.5  # a switch that ends so many times later than it may has been given up long before
KEPT = 8  # switches whose end is looked at


class MachineTruth(RobotTruth):
    """Truth about one device: its `facts`, those that `were` before this step, and its `work`, if any.

    `zones` are those that it is in the way of. Of this step: `unmet`, the commands that it carries out
    although what they need is not so, each with what that is; `cut_short`: it ended work that goes on
    through a stop, and neither its power nor an alarm explains that; `overdue`: it switched so late that
    nobody counts on that any more.
    """

    SIGNS = ("next_change_us", "moving")  # its work may end while a switch goes on until the same time
    PLACE = "facts"
    FORGETS = True

    def __init__(self, robot: Robot, cell: Cell, board: Board, client: Client) -> None:
        self.facts: Facts = dict(board.body.true_facts)
        self.were = self.facts
        self.work: Command | None = None
        self.unmet: list[tuple[Command, str]] = []
        self.cut_short = False
        self._locks: tuple[Interlock, ...] = ()
        self._finishes = board.body.finishes
        self._switches: list[tuple[Switch, int]] = []  # and when they were given, the last one first
        self._now_us = 0
        super().__init__(robot, cell, board, client)

    def be_locked(self, locks: tuple[Interlock, ...]) -> None:
        self._locks = locks
        self.zones = self._in_the_way()

    @property
    def held(self) -> bool:
        """True while it holds something."""
        return bool(self.facts.get(self.robot.held_fact or ""))

    @property
    def let_go(self) -> bool:
        """True if it let go by itself in this step of what it held, with its power on and nobody at it."""
        held = bool(self.were.get(self.robot.held_fact or ""))
        return held and not self.held and not self.lost_power and not self.by_hand

    @property
    def unbidden(self) -> bool:
        """True if its power, and with it its grip and switches, is lost, or a person was at it: either may
        put it in the way.
        """
        return self.lost_power or self.by_hand

    @property
    def at_reference(self) -> bool:
        """True always, as it has no reference that it could be away from."""
        return True

    def be_opened(self, at: float) -> None:
        self.again = self._put_right = True

    def forget(self) -> None:
        super().forget()
        self.were, self.unmet, self.cut_short, self.by_hand = self.facts, [], False, False

    def look(self, now_us: int) -> None:
        self._now_us = now_us
        super().look(now_us)

    @property
    def _came_home(self) -> bool:
        return True

    def _boot_up(self, now_us: int) -> None:
        super()._boot_up(now_us)
        self.homed, self.work = True, None

    def _moves(self, goal: Goal) -> bool:
        return isinstance(goal, VerbGoal) and self.body.is_work(goal)

    def _grips(self, goal: Goal) -> bool:
        """True for a goal other than work that a stop forbids: neither a question nor a release."""
        command = self._command(goal)
        return command is not None and needs_clear(command)

    def _command(self, goal: Goal) -> Command | None:
        command: Command | None = self.body.command(goal) if isinstance(goal, VerbGoal) else None
        return command

    def _follow(self, was_moving: bool) -> None:
        before, self.facts = self.facts, dict(self.body.true_facts)
        self.jumped = self.facts != before and not self.lost_power and not self._ended_in_time
        self.by_hand = self._put_right
        self.swerved = False  # of several things that it does, one may end
        given = [(act, self._command(act.goal)) for act in self.acts]
        self._look_at_switches(before)
        switches = [(command, self._now_us) for _, command in given if isinstance(command, Switch)]
        self._switches = [*reversed(switches), *self._switches][:KEPT]
        self._follow_work(was_moving, given)
        self.zones = self._in_the_way()
        self.unmet = [
            (command, why)
            for command in self._at_work(given)
            if (why := self._why_unmet(command)) is not None
        ]

    def _follow_work(self, was_moving: bool, given: list[tuple[Act, Command | None]]) -> None:
        began = [command for act, command in given if act.moves]
        ended = was_moving and (not self.moving or began)
        excused = self.lost_power or self.board.faulted or self._ended_in_time
        self.cut_short = bool(ended and self._finishes and not excused)
        self._finishes = self.body.finishes
        if began:
            self.work, self.worked_from = began[-1], self._now_us / 1e6
        elif not self.moving:
            self.work = None

    def _look_at_switches(self, before: Facts) -> None:
        """Note when the last switch of a fact that has changed was given, and whether that was long ago."""
        self.overdue, self.switched_from = False, None
        for switch, given_us in self._switches:
            if any(self.facts[name] != before[name] for name, _ in switch.sets):
                self.overdue = self._now_us - given_us > GIVEN_UP * 1e6 * (switch.at_most_s or 0.0)
                self.switched_from = given_us / 1e6
                return

    @property
    def _ended_in_time(self) -> bool:
        return self._was_due is not None and self._was_due <= self._now_us

    def _at_work(self, given: list[tuple[Act, Command | None]]) -> list[Command]:
        """The work that it begins in this step, and that with which it goes on."""
        begins = [command for _, command in given if command is not None and command is not self.work]
        return begins if self.work is None else [*begins, self.work]

    def _why_unmet(self, command: Command) -> str | None:
        """The first need of a command that was met neither before nor after this step; None: all were."""
        rows = [(name, value) for name, value in command.needs if self.facts.get(name) != value]
        if command is not self.work:  # its own effect may have ended what it needed
            rows = [(name, value) for name, value in rows if self.were.get(name) != value]
        return next((f"{name} is {self.facts.get(name)}, not {value}" for name, value in rows), None)

    def _in_the_way(self) -> frozenset[str]:
        word = "" if self.work is None else self.work.word
        return frozenset(
            lock.zone
            for lock in self._locks
            if word in lock.held_while
            or any(self.facts.get(name) != value for name, value in lock.free_while)
        )

    def _ends_soon(self, now_us: int) -> bool:
        return bool(self.body.finishes)  # all other work ends at once

    def _goes_on(self) -> bool:
        return not self.body.finishes
