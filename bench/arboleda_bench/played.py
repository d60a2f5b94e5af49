"""Robots for benchmarks: boards and bridge in one, at evidence `ids`, with moves that take a given time."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping
from heapq import heappop, heappush
from itertools import count
from typing import Any

from arboleda.core.messages import (
    Command,
    FollowPath,
    Heartbeat,
    Home,
    MoveJoints,
    Report,
    SetEffector,
    Stop,
)
from arboleda.core.model import Arm, MotionState, PlantModel, Robot

EPOCH = 1  # of the bridge that they play
TELEMETRY_S = 0.1
EVERYTHING = (MoveJoints, FollowPath, SetEffector, Stop, Home)


class PlayedRobot:
    """One robot: what it was told, where it is, and its word on both."""

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
        """Accept a move, and be on the way."""
        self._move, self._accepted, self._began, self._lasts = command, command.id, now, lasts

    def end(self, move: MoveJoints | FollowPath) -> None:
        """Be where the move leads, unless it was halted meanwhile."""
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
            return self.robot.quantised(move.q)  # type: ignore[union-attr]
        return (move.nodes[-1],)

    def _place(self, now: float) -> tuple[float, ...]:
        """On a straight line to the goal; a mobile robot on the last node that it passed."""
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
        self._due: list[tuple[float, int, Callable[..., None], tuple[Any, ...]]] = []
        self._number = count()
        self._awake = threading.Condition()
        self._ending = False
        self._ended: dict[str, tuple[float, type]] = {}
        self.reactions: list[float] = []
        self.told = 0  # reports that came by the clock
        self._thread = threading.Thread(target=self._run, name="crew", daemon=True)

    def start(self) -> None:
        self.appear()
        self._thread.start()

    def appear(self) -> None:
        """Have the robots report from now on."""
        now, last = time.monotonic(), len(self._robots)
        for number, robot in enumerate(self._robots.values()):
            due = now + TELEMETRY_S * number / last
            self._at(due, self._tell, robot, due)

    def stop(self) -> None:
        """End the thread and wait for it; idempotent."""
        with self._awake:
            self._ending = True
            self._awake.notify()
        if self._thread.is_alive():
            self._thread.join()

    def send(self, message: Any) -> None:
        """Hear what the plant says; what is not for robots is ignored."""
        now = time.perf_counter()
        if isinstance(message, Heartbeat):
            self._at(0.0, self._heed, message.epoch)
        elif isinstance(message, EVERYTHING):
            self._note(message, now)
            self._at(0.0, self._obey, message)

    def _note(self, command: Command, now: float) -> None:
        """Take down a reaction; before the first drive of a task stands a dwell."""
        ended = self._ended.pop(self._cell_of[command.robot], None)
        if ended is not None and (not isinstance(command, FollowPath) or ended[1] is FollowPath):
            self.reactions.append(now - ended[0])

    def _heed(self, epoch: int) -> None:
        for robot in self._robots.values():
            robot.plant = epoch

    def _obey(self, command: Command) -> None:
        robot, now = self._robots[command.robot], time.monotonic()
        if isinstance(command, MoveJoints | FollowPath):
            robot.begin(command, now, self._move_s)
            self._at(now + self._move_s, self._arrive, robot, command)
        elif isinstance(command, SetEffector):
            robot.switch(command)
        elif isinstance(command, Stop):
            robot.halt(now)
        self._post(robot.report(now))

    def _arrive(self, robot: PlayedRobot, command: MoveJoints | FollowPath) -> None:
        robot.end(command)
        report = robot.report(time.monotonic())
        self._ended[self._cell_of[command.robot]] = (time.perf_counter(), type(command))
        self._post(report)

    def _tell(self, robot: PlayedRobot, due: float) -> None:
        due += TELEMETRY_S
        self._at(due, self._tell, robot, due)
        self._post(robot.report(time.monotonic()))
        self.told += 1

    def _at(self, due: float, deed: Callable[..., None], *args: Any) -> None:
        with self._awake:
            entry = (due, next(self._number), deed, args)
            heappush(self._due, entry)
            if self._due[0] is entry:
                self._awake.notify()

    def do_one(self) -> bool:
        """Do the one thing that has been due for longest; False where nothing is due."""
        with self._awake:
            if not self._due or self._due[0][0] > time.monotonic():
                return False
            _, _, deed, args = heappop(self._due)
        deed(*args)
        return True

    def _run(self) -> None:
        while not self._ending:
            if not self.do_one():
                self._rest()

    def _rest(self) -> None:
        """Sleep until something is due."""
        with self._awake:
            left = self._due[0][0] - time.monotonic() if self._due else None
            if not self._ending and (left is None or left > 0):
                self._awake.wait(left)
