"""The truth about the robots and devices of any plant, step by step."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from arboleda.drivers import Command, Device, Evidence, Jointed, Mobile, Report, Robot
from arboleda.engine.inspection import beliefs_of
from arboleda.model.by_class import nearest
from arboleda.model.messages import CellRevised, Fact, OperatorAnswer, Remember, Verb
from arboleda.model.whole_cells import whole_cell
from arboleda.rig.world import World

from .arm import ArmTruth
from .boots import Boots
from .ended_commands import CALM_S, Books
from .machine import MachineTruth
from .mobile import MobileTruth
from .robot import BEATS, Act, RobotTruth
from .stops import Stops
from .zones import ZonesTruth

SAMPLE_S = 1.0  # no deception is shorter, as each lasts until its reports are stale
KINDS: dict[type[Robot], Callable[..., RobotTruth]] = {
    Jointed: ArmTruth,
    Mobile: MobileTruth,
    Device: MachineTruth,
}
"""The truth that is followed of a robot, by its class."""
LATE_BOOT_S = 2.0  # within which a boot is heard of


class RobotsTruth:
    """Looks at the boards' bodies, and at what was said, after every step; robots by name.

    Of this step: `changed`, the robots of which there is more to say than that they stand or go on as
    before; `defied`, what boards began although an operator's stop holds; `deeds`: whether anything was
    done. Robots without a virtual board are left out.
    """

    def __init__(self, world: World) -> None:
        self.world = world
        self.robots: dict[str, RobotTruth] = {}
        self.changed: list[RobotTruth] = []
        self.defied: list[tuple[str, Act]] = []
        self.deeds = False
        self.books = Books(world)
        self.stops = Stops(world.model)
        self._boards: dict[str, RobotTruth] = {}
        for robot in world.model.robots.values():
            self._add(robot)
        self._robots = list(self._boards.values())
        users = [name for cell in world.model.cells for name in (*cell.zone_users, *cell.interlocked)]
        inside = {name: self.robots[name] for name in users if name in self.robots}
        self.zones = ZonesTruth(world, inside, self.mistaken)
        self.boots = Boots(self._robots)
        self._deceived: dict[tuple[str, str], float] = {}
        self._sampled_at = -SAMPLE_S
        self._plant = world.plant
        self._late: frozenset[str] = frozenset()  # robots of which old reports may still come
        self._late_until = 0.0

    def robot(self, name: str) -> Any:
        """The robot with this name; None if it has no virtual board."""
        return self.robots.get(name)

    def deceived_since(self, board: str, what: str, at: float) -> bool:
        """True if a board may have lied about something since then."""
        now_so = self.world.deceptions.get((board, what), 0) > 0
        return now_so or self._deceived.get((board, what), -SAMPLE_S) + SAMPLE_S >= at

    def unseen(self, robot: RobotTruth) -> bool:
        """True if nobody can know where a robot is, as its board says too little.

        At `joints` nothing tells whether a report is older than the robot's last command, if that took its
        time, and a single lie about place or state is enough.
        """
        if robot.blind or robot.robot.evidence is not Evidence.JOINTS:
            return robot.blind
        board, now = robot.robot.mqtt, self.world.now
        lies = any(self.deceived_since(board, what, now) for what in (robot.PLACE, "state"))
        return lies or robot.robot.name in self.books.late

    def mistaken(self, robot: RobotTruth) -> bool:
        """True if the plant may be told a wrong place of a robot: it is `unseen`, its board lies, a report
        from before an earlier start moved it comes late, or it says that it stands still while it moves; for
        a machine also if it has said so since it began to move, does something long after its time, or has
        lied about its boot since it was given the switch that it did: a boot would have ended that. So may
        it of one that forgets at a boot what was switched, until that boot is heard of.
        """
        if self.world.now < self._late_until and robot.robot.name in self._late:
            return True
        board, from_s = robot.robot.mqtt, robot.worked_from
        if from_s is None and robot.moving:
            from_s = self.world.now
        if from_s is not None and self.deceived_since(board, "state", from_s):
            return True
        if robot.switched_from is not None and self.deceived_since(board, "boot", robot.switched_from):
            return True
        lies = self.deceived_since(board, robot.PLACE, self.world.now)
        return robot.overdue or lies or self.unseen(robot) or self._has_forgotten_unheard(robot)

    def _has_forgotten_unheard(self, robot: RobotTruth) -> bool:
        booted_at, belief = robot.booted_us / 1e6, beliefs_of(self.world.plant)[robot.robot.name]
        return robot.FORGETS and self.world.now < booted_at + LATE_BOOT_S and belief.boot_id != robot.boot

    def look(self) -> None:
        """Take in what happened in this step; called before any invariant."""
        if self.deeds:
            self._forget()
        is_new = self.world.plant is not self._plant
        if is_new:
            self.books.drop()  # the old one took them with it
        if self.world.versions and (is_new or CellRevised in map(type, self.world.moment.sent)):
            self._revise()
        self._look_at_messages()
        self._look_at_robots()
        if is_new:
            self._new_plant()
        self._look_at_plant()
        if self.world.model.zones:
            self.zones.look(bool(self.changed))
        self.deeds = bool(self.changed) or self._did_more()

    def _did_more(self) -> bool:
        """True if anything was done in this step though no robot has changed."""
        return False

    def _look_at_messages(self) -> None:
        """Take in what reached the boards, and what they carry out."""
        moment = self.world.moment
        if moment.published or moment.delivered:
            self._overhear()
        for board, goal in moment.executed:
            self._boards[board].carry_out(goal)
        for board in moment.opened:
            self._boards[board].be_opened(self.world.now)
        for board in moment.put_right:
            self._boards[board].put_right(self.world.now)

    def _look_at_robots(self) -> None:
        """Take in what the robots did; called before the plant's part, as the plant steps after them."""
        self.books.look()
        for booked in self.books.ended:  # the present state shows if that is true
            if (robot := self.robot(booked.command.robot)) is not None:
                robot.again = True
        now_us = round(self.world.now * 1e6)
        for robot in self._robots:
            news = robot.again or robot.board.boot_id != robot.boot
            if news or robot.signs(robot.body) != robot.last_signs:
                robot.look(now_us)
                self.changed.append(robot)
        if self.changed:
            self._follow_changes()

    def _look_at_plant(self) -> None:
        """Take in what the plant heard, was deceived about and sent."""
        world, moment = self.world, self.world.moment
        if moment.reports or self.boots.mute:
            self._listen(moment.reports)
        if world.deceptions and world.now >= self._sampled_at + SAMPLE_S:
            self._sampled_at = world.now
            self._deceived.update({key: world.now for key, number in world.deceptions.items() if number})
        if moment.sent:
            for message in moment.sent:
                self._take_in(message)
            self.stops.settle()

    def _listen(self, reports: list[Report]) -> None:
        """Take in what the plant hears."""
        if self.boots.mute:
            self.boots.look(reports, is_question=bool(self.world.moment.requests))

    def _revise(self) -> None:
        """Know the places of what cells work by now."""
        for name, truth in self.robots.items():
            truth.revise(whole_cell(self.world.model, name))

    def _forget(self) -> None:
        for robot in self.changed:
            robot.forget()
        self.changed, self.defied = [], []

    def _add(self, robot: Robot) -> None:
        world = self.world
        board, client = world.boards.get(robot.mqtt), world.broker.clients.get(robot.mqtt)
        if board is not None and client is not None:
            follow = nearest(KINDS, type(robot))
            assert follow is not None, f"nothing follows a {robot.kind_name}"
            truth = follow(robot, whole_cell(world.model, robot.name), board, client)
            locks = (each.interlocks_of(robot.name) for each in world.model.cells_of[robot.name])
            truth.be_locked(tuple(lock for of_cell in locks for lock in of_cell))
            self._boards[robot.mqtt] = self.robots[robot.name] = truth

    def _new_plant(self) -> None:
        """Begin with a new plant; the last words of the old one count."""
        self.boots.restart()
        self._late = frozenset(name for name in self.robots if self.books.is_late(name))
        self._late_until = self.world.now + CALM_S
        words = self.world.moment.last_words
        for message in words:
            self._take_in(message)
        self.stops.settle()
        if words:
            self.stops.restart(self.world.plant_process.found.facts.get(Fact.LATCH, {}))
        self._plant = self.world.plant

    def _overhear(self) -> None:
        """Take in what our bridge publishes, and what reaches the boards."""
        boards = self._boards
        for publication in self.world.moment.ordered:
            if not publication.topic.endswith(BEATS):
                robot = boards.get(publication.topic.partition("/")[0])
                if robot is not None:
                    robot.expect(publication)
        outdated = set(map(id, self.world.moment.outdated))
        for client, delivery in self.world.moment.delivered:
            if client in boards and not delivery.topic.endswith(BEATS):
                boards[client].reach(delivery, outdated=id(delivery) in outdated)

    def _follow_changes(self) -> None:
        for robot in self.changed:
            for act in robot.acts:
                if act.starts and self.stops.breaks(robot.robot, act, self.world.now):
                    self.defied.append((robot.robot.name, act))

    def _take_in(self, message: object) -> None:
        if isinstance(message, Command):
            self._command(message)
        elif isinstance(message, OperatorAnswer) and message.refusal is None:
            self._answered(message)
        elif isinstance(message, Remember) and message.fact is Fact.LATCH:
            self.stops.remembered(message)

    def _command(self, command: Command) -> None:
        self.books.sent(command)
        self.stops.sent(command, self.world.now)

    def _answered(self, answer: OperatorAnswer) -> None:
        self.stops.answered(answer)
        if answer.verb is Verb.OVERRIDE:
            self.zones.overridden(answer.scope.strip().lower())
