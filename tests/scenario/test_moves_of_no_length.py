"""A robot that is told to go where it stands: it may say little of that, or say it late."""

from __future__ import annotations

from dataclasses import replace

import pytest

from arboleda.core.plant import Plant
from arboleda.kinds.joints import MoveJoints
from arboleda.model.messages import Event, MotionState, Reason, Report, TaskChanged, TaskRequest, TaskState
from arboleda.model.plant_model import Evidence, Link, PlantModel
from arboleda.testing import Rig, shipped
from arboleda.testing.storage_layout import StorageLayout

from ..cells import with_palletizing, with_poses, with_robot

MOVING, STOPPED = MotionState.MOVING, MotionState.STOPPED
PERIOD_S, LATE_S, SPEED_RAD_S = 0.1, 0.2, 2.0
TASKS = 5
ENDED = (TaskState.DONE, TaskState.FAILED, TaskState.CANCELLED)


def equal_neighbours(evidence: Evidence, link: Link) -> PlantModel:
    """One arm whose place is its home pose: every task begins with a move of no length."""
    model = shipped("sis_a", evidence=evidence, link=link)
    (cell,) = model.cells
    place = replace(cell.stations[0], q=StorageLayout(cell).home.q)
    cell = with_palletizing(with_poses(cell, station_0=place), "pickup", "station_0")
    return replace(model, cells=(with_robot(cell, "mobile", link=Link.NONE),))


class Glued:
    """An arm behind glue: a joint at constant speed, and two topics that are late by times of their own.

    `says_moving`: whether it says so of a move of no length, for one period.
    """

    def __init__(self, evidence: Evidence, *, state_s: float, position_s: float, says_moving: bool) -> None:
        self.ticks = 0
        self.now = 100.0
        self.plant = Plant(equal_neighbours(evidence, Link.ROS), epoch=7, now=self.now)
        self.late = {"state": state_s, "q": position_s}
        self.pulse_s = PERIOD_S * says_moving
        self.q = self.goal = (0.0, 0.0, 0.0)
        self.moves_until = 0.0
        self.coming: list[tuple[float, Report]] = []
        self.said: MotionState | None = None

    def ends(self, tasks: int) -> list[tuple[TaskState, Reason | None]]:
        """How so many tasks end, one after the other, each asked for before the one before has ended."""
        text = "sis_a palletizing #n"
        asked: list[Event] = [TaskRequest(at=self.now, text=f"{text}{self.ticks}-{n}") for n in range(tasks)]
        ended: list[tuple[TaskState, Reason | None]] = []
        until = self.now + 60.0 * tasks
        while len(ended) < tasks:
            assert self.now < until, f"it hangs: {ended}"
            self._pass_10_ms()
            for message in self.plant.step(self.now, [*asked, *self._heard()]):
                if isinstance(message, MoveJoints):
                    self._obey(message)
                elif isinstance(message, TaskChanged) and message.state in ENDED:
                    ended.append((message.state, message.reason))
            asked = []
        return ended

    def _heard(self) -> list[Report]:
        due = [report.again(self.now) for at, report in self.coming if at <= self.now]
        self.coming = [each for each in self.coming if each[0] > self.now]
        return due

    def _obey(self, move: MoveJoints) -> None:
        self.goal = StorageLayout(self.plant.model.cells[0]).arm.motion.quantised(move.q)
        way = max(abs(a - b) for a, b in zip(self.goal, self.q, strict=True))
        self.moves_until = self.now + (way / SPEED_RAD_S or self.pulse_s)

    def _pass_10_ms(self) -> None:
        self.ticks += 1
        self.now = 100.0 + self.ticks / 100
        step = SPEED_RAD_S / 100
        self.q = tuple(a + max(-step, min(step, b - a)) for a, b in zip(self.q, self.goal, strict=True))
        state = MOVING if self.now < self.moves_until else STOPPED
        if state is not self.said:  # its code is told at changes, its joints in time
            self.said = state
            self._say(state=state)
        if self.ticks % 10 == 0:
            self._say(q=self.q)

    def _say(self, **said: object) -> None:
        (kind,) = said
        self.coming.append((self.now + self.late[kind], Report(at=0.0, robot="ra1", **said)))  # type: ignore[arg-type]


@pytest.mark.parametrize("says_moving", [True, False], ids=["a late pulse", "never moving"])
@pytest.mark.parametrize(("state_s", "position_s"), [(0.0, 0.0), (LATE_S, 0.0), (0.0, LATE_S), (0.13, 0.07)])
def test_at_joints_no_task_fails_whichever_topic_is_late(
    state_s: float, position_s: float, says_moving: bool
) -> None:
    arm = Glued(Evidence.JOINTS, state_s=state_s, position_s=position_s, says_moving=says_moving)
    assert arm.ends(TASKS) == [(TaskState.DONE, None)] * TASKS


def test_at_state_a_robot_left_at_its_goal_need_not_say_moving() -> None:
    """Only for its very first move it has to."""
    arm = Glued(Evidence.STATE, state_s=0.0, position_s=0.0, says_moving=True)
    assert arm.ends(1) == [(TaskState.DONE, None)]
    arm.pulse_s = 0.0
    assert arm.ends(TASKS) == [(TaskState.DONE, None)] * TASKS


def test_at_state_a_move_of_no_length_takes_as_long_as_its_robot_says_that_it_moves() -> None:
    arm = Glued(Evidence.STATE, state_s=0.0, position_s=0.0, says_moving=True)
    assert arm.ends(1) == [(TaskState.DONE, None)]
    arm.pulse_s, begun = 2 * arm.plant.model.timing.stop_timeout_s, arm.now
    assert arm.ends(1) == [(TaskState.DONE, None)]
    assert arm.now - begun > arm.pulse_s


@pytest.mark.parametrize("evidence", list(Evidence), ids=lambda evidence: evidence.value)
def test_our_own_boards_fail_none(evidence: Evidence) -> None:
    rig = Rig(equal_neighbours(evidence, Link.MQTT))
    rig.wait(0.5)
    for number in range(TASKS):
        rig.submit(f"sis_a palletizing #n{number}")
    rig.wait(120.0)
    assert [change.state for change in rig.outcomes().values()] == [TaskState.DONE] * TASKS
