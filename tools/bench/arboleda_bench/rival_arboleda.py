"""Side of `rival`: the part `orchestrator` as `build` makes it, its port joined to lines of text."""

from __future__ import annotations

import os
import sys
import threading
from functools import partial
from pathlib import Path
from typing import Any

from arboleda.drivers import FollowPath, MoveJoints, SetEffector
from arboleda.model.messages import Heartbeat, TaskChanged, TaskState
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file.loader import load
from arboleda.runtime.build import Options, build
from arboleda.runtime.parts.orchestrator import Orchestrator

from . import steps
from .clockwork import Clockwork, now
from .played import TELEMETRY_S, PlayedRobot
from .rival_lines import DONE, KINDS, begin, end

LONG_S = 1.0  # a move is over when a line says so


class RobotsByLine:
    """The plant's port: says each command as a line, and ends it at the next line."""

    def __init__(self, model: PlantModel, orchestrator: Orchestrator) -> None:
        self._robots = {name: PlayedRobot(robot) for name, robot in model.robots.items()}
        self._hear = orchestrator.hear
        self._lock = threading.Lock()
        self._open: Any = None
        self.clockwork = Clockwork()
        for robot in self._robots.values():
            self.clockwork.every(TELEMETRY_S, partial(self._tell, robot))

    def send(self, message: Any) -> None:
        if isinstance(message, Heartbeat):
            for robot in self._robots.values():
                robot.plant = message.epoch
        elif type(message) in KINDS:
            with self._lock:
                self._open = message
                if isinstance(message, MoveJoints | FollowPath):
                    self._robots[message.robot].begin(message, now(), LONG_S)
            begin(KINDS[type(message)])

    def done(self) -> None:
        """End the step that was told last."""
        with self._lock:
            command, robot = self._open, self._robots[self._open.robot]
            if isinstance(command, SetEffector):
                robot.switch(command)
            else:
                robot.end(command)
            report = robot.report(now())
        self._hear(report)

    def _tell(self, robot: PlayedRobot) -> None:
        with self._lock:
            report = robot.report(now())
        self._hear(report)


def main(file: str, state: str) -> None:
    model = load(Path(file))
    app = build(model, {"orchestrator"}, Options(state_dir=Path(state)))
    assert app.orchestrator is not None
    robots = RobotsByLine(model, app.orchestrator)
    app.orchestrator.connect(robots)
    app.listen(_take)
    app.start()
    robots.clockwork.start()
    try:
        for line in sys.stdin:
            if line.rstrip() == DONE:
                robots.done()
            else:
                app.plant.submit(steps.task(model.cells[0]))
    finally:
        robots.clockwork.stop()
        app.stop()


def _take(change: TaskChanged) -> None:
    if change.state is TaskState.DONE:
        end()
    elif change.state not in (TaskState.QUEUED, TaskState.RUNNING):
        print(f"{change.text}: {change.state.value} ({change.sentence})", file=sys.stderr, flush=True)
        os._exit(1)  # from the plant's thread: who measures is told at once


if __name__ == "__main__":
    main(*sys.argv[1:])
