"""Robots for benchmarks: boards and bridge in one, at evidence `ids`, with moves that take a given time."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, cast

from arboleda.drivers import (
    Command,
    FollowPath,
    Home,
    MotionState,
    MoveJoints,
    Report,
    Robot,
    SetEffector,
    Stop,
)
from arboleda.kinds.arm import Arm
from arboleda.kinds.joints import Jointed
from arboleda.model.messages import Heartbeat
from arboleda.model.plant_model import PlantModel

from .clockwork import Clockwork, now

EPOCH = 1  # of the bridge that they play
TELEMETRY_S = 0.1
EVERYTHING = (MoveJoints, FollowPath, SetEffector, Stop, Home)


class PlayedRobot:
    """One robot: its open command, its place, and its report of both."""

    def __init__(self, robot: Robot) -> None:
        self.robot = robot
        self.plant: int | None = None
        self._arm = isinstance(robot, Arm)
        self._at: tuple[float, ...] = robot.reference if isinstance(robot, Arm) else (0,)
        self._move: MoveJoints | FollowPath | None = None
        self._began = self._lasts = 0.0
        self._accepted: str | None = None
        self._done: str | None = None
        self._effector = False

    def begin(self, command: MoveJoints | FollowPath, now: float, lasts: float) -> None:
        """Accept a move, and set out."""
        self._move, self._accepted, self._began, self._lasts = command, command.id, now, lasts

    def end(self, move: MoveJoints | FollowPath) -> None:
        """Arrive at the end of a move, unless the robot was halted meanwhile."""
        if move is self._move:
            self._at, self._done, self._move = self._goal(move), move.id, None

    def switch(self, command: SetEffector) -> None:
        self._effector = command.on

    def halt(self, now: float) -> None:
        """Stand still where it is."""
        self._at, self._move = self._place(now), None

    def report(self, now: float) -> Report:
        place = self._place(now)
        return Report(
            at=now,
            robot=self.robot.name,
            epoch=EPOCH,
            plant=self.plant,
            boot_id=1,
            accepted=self._accepted,
            done=self._done,
            state=MotionState.STOPPED if self._move is None else MotionState.MOVING,
            q=place if self._arm else None,
            node=None if self._arm else int(place[0]),
            homed=True,
            effector=self._effector if self._arm else None,
        )

    def _goal(self, move: MoveJoints | FollowPath) -> tuple[float, ...]:
        if isinstance(move, MoveJoints):
            return cast(Jointed, self.robot).motion.quantised(move.q)
        return (move.nodes[-1],)

    def _place(self, now: float) -> tuple[float, ...]:
        """The place on a straight line to the goal; for a mobile robot the last node that it passed."""
        move = self._move
        if move is None:
            return self._at
        share = min((now - self._began) / self._lasts, 1.0)
        if isinstance(move, FollowPath):
            return (move.nodes[int(share * (len(move.nodes) - 1))],)
        return tuple(a + (b - a) * share for a, b in zip(self._at, move.q, strict=True))


class Crew:
    """All robots of a plant: `send` is the plant's port, `post` gets their reports, in a thread of their own.

    Each robot reports every TELEMETRY_S, one after the other, and at each change. `reactions` are the times
    from the post of a report that ends a move to the next command of the same cell, those left out that a
    dwell precedes.
    """

    def __init__(self, model: PlantModel, post: Callable[[Report], Any], *, move_s: float) -> None:
        self._post = post
        self._move_s = move_s
        self._robots = {name: PlayedRobot(robot) for name, robot in model.robots.items()}
        self._cell_of: Mapping[str, str] = {name: cell.name for name, cell in model.cell_of.items()}
        self.clockwork = Clockwork()
        self._ended: dict[str, tuple[float, type]] = {}
        self.reactions: list[float] = []
        self.repeats = 0  # reports that came by the clock

    def start(self) -> None:
        self.appear()
        self.clockwork.start()

    def appear(self) -> None:
        """Have the robots report from now on."""
        begin, many = now(), len(self._robots)
        for number, robot in enumerate(self._robots.values()):
            first = begin + TELEMETRY_S * number / many
            self.clockwork.every(TELEMETRY_S, partial(self._tell, robot), first=first)

    def stop(self) -> None:
        """Have no robot say or do anything any more; idempotent."""
        self.clockwork.stop()

    def send(self, message: Any) -> None:
        """Take a message of the plant; one that is not for robots is ignored."""
        if isinstance(message, Heartbeat):
            self.clockwork.at(0.0, partial(self._heed, message.epoch))
        elif isinstance(message, EVERYTHING):
            self._note(message)
            self.clockwork.at(0.0, partial(self._obey, message))

    def _note(self, command: Command) -> None:
        """Note a reaction, except for the first drive of a task, before which there is a dwell."""
        heard = now()
        ended = self._ended.pop(self._cell_of[command.robot], None)
        if ended is not None and (not isinstance(command, FollowPath) or ended[1] is FollowPath):
            self.reactions.append(heard - ended[0])

    def _heed(self, epoch: int) -> None:
        for robot in self._robots.values():
            robot.plant = epoch

    def _obey(self, command: Command) -> None:
        robot = self._robots[command.robot]
        if isinstance(command, MoveJoints | FollowPath):
            robot.begin(command, now(), self._move_s)
            self.clockwork.after(self._move_s, partial(self._arrive, robot, command))
        elif isinstance(command, SetEffector):
            robot.switch(command)
        elif isinstance(command, Stop):
            robot.halt(now())
        self._post(robot.report(now()))

    def _arrive(self, robot: PlayedRobot, command: MoveJoints | FollowPath) -> None:
        robot.end(command)
        report = robot.report(now())
        self._ended[self._cell_of[command.robot]] = (now(), type(command))
        self._post(report)

    def _tell(self, robot: PlayedRobot) -> None:
        self._post(robot.report(now()))
        self.repeats += 1
