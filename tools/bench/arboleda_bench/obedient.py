"""A plant in this process whose robots obey: no network, and time is moved by hand."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from arboleda.drivers import Command, FollowPath, MotionState, MoveJoints, Report, Robot, SetEffector
from arboleda.engine import Plant
from arboleda.kinds.arm import Arm
from arboleda.model.messages import Event, TaskChanged, TaskRequest, TaskState
from arboleda.model.plant_model import PlantModel

EPOCH = 1000
MESSAGE_S = 1e-4  # from one word of a robot to the next; none counts as silent meanwhile
ENDED = frozenset({TaskState.DONE, TaskState.FAILED, TaskState.CANCELLED})


class Yard:
    """A plant with every robot online; `words` is the last report of each of them."""

    def __init__(self, model: PlantModel) -> None:
        self.plant = Plant(model, epoch=EPOCH, now=0.0)
        self.words = {robot.name: _first_words(robot) for robot in model.robots.values()}
        self.now = 0.0
        self.roll_call()

    def step(self, *events: Event) -> list[Any]:
        """One step of the plant now, with events that are stamped now."""
        return self.plant.step(self.now, events)

    def roll_call(self) -> None:
        """Repeat the last report of every robot, so that none counts as silent."""
        self.now += MESSAGE_S
        self.step(*[words.again(self.now) for words in self.words.values()])

    def say(self, report: Report) -> Report:
        """The report, kept as the last one of its robot and stamped a little later."""
        self.now += MESSAGE_S
        said = self.words[report.robot] = replace(report, at=self.now)
        return said

    def accepts(self, command: Command) -> Report:
        """The robot's report as it begins a command."""
        moves = not isinstance(command, SetEffector)
        state = MotionState.MOVING if moves else MotionState.STOPPED
        return self.say(replace(self.words[command.robot], accepted=command.id, state=state))

    def finishes(self, command: Command) -> Report:
        """The robot's report once it has done a command."""
        words = replace(self.words[command.robot], state=MotionState.STOPPED, done=command.id)
        if isinstance(command, MoveJoints):
            arm = self.plant.model.robots[command.robot]
            assert isinstance(arm, Arm)
            words = replace(words, q=arm.motion.quantised(command.q))
        elif isinstance(command, FollowPath):
            words = replace(words, node=command.nodes[-1])
        elif isinstance(command, SetEffector):
            words = replace(words, effector=command.on)
        return self.say(words)

    def ask(self, text: str) -> list[Any]:
        """Ask for a task."""
        return self.step(TaskRequest(at=self.now, text=text))

    def sleep(self) -> list[Any]:
        """Let time pass to the next time that the plant waits for."""
        self.now = max(self.now, self.plant.next_deadline)
        return self.step()


def command_in(messages: Sequence[Any]) -> Command | None:
    """The first command of a step."""
    return next((each for each in messages if isinstance(each, Command)), None)


def is_over(messages: Sequence[Any]) -> bool:
    """True if a task ended in this step."""
    return any(isinstance(each, TaskChanged) and each.state in ENDED for each in messages)


def _first_words(robot: Robot) -> Report:
    is_arm = isinstance(robot, Arm)
    return Report(
        at=0.0,
        robot=robot.name,
        epoch=1,
        plant=EPOCH,
        boot_id=1,
        state=MotionState.STOPPED,
        q=tuple(0.0 for _ in robot.joints) if isinstance(robot, Arm) else None,
        node=None if is_arm else 0,
        homed=True,
        effector=False if is_arm else None,
    )
