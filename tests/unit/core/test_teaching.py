"""Teaching: a mode of a cell in which nothing moves but what its one teacher holds."""

from __future__ import annotations

import math
from dataclasses import replace
from importlib.resources import files
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

from arboleda.core.teaching import HOLD_S
from arboleda.kinds.joints import MoveJoints
from arboleda.kinds.mobile import FollowPath
from arboleda.model.commands import Stop, StopMode
from arboleda.model.messages import Fact, Jog, Journal, Remember, Verb
from arboleda.plant_file.loader import load
from arboleda.testing import Rig, shipped

BEAT_S = 0.05  # how often a page says that a button is held
FAR = 0.5  # rad


class Teacher:
    """Someone who teaches a cell of a rig."""

    def __init__(self, rig: Rig, cell: str = "sis_a") -> None:
        self.rig, self.cell, self.number = rig, cell, 0
        assert rig.operate(Verb.TEACH, cell, teacher="ana") is None
        self.session = rig.answers[-1].act or 0

    def jog(self, robot: str = "ra1", *, held: bool = True, **towards: Any) -> None:
        """Say something of the present button."""
        self.rig.tell(self.made(robot, held=held, **towards))

    def made(self, robot: str = "ra1", *, held: bool = True, **towards: Any) -> Jog:
        return Jog(
            at=self.rig.now,
            cell=self.cell,
            session=self.session,
            number=self.number,
            robot=robot,
            held=held,
            **towards,
        )

    def press(self, seconds: float, robot: str = "ra1", **towards: Any) -> None:
        """Hold a new button for so long."""
        self.number += 1
        until = self.rig.now + seconds
        while self.rig.now < until:
            self.jog(robot, **towards)
            self.rig.wait(BEAT_S)

    def release(self, robot: str = "ra1") -> None:
        self.jog(robot, held=False)


@pytest.fixture
def rig() -> Rig:
    rig = Rig(shipped())
    rig.wait(2.0)
    return rig


@pytest.fixture
def teacher(rig: Rig) -> Teacher:
    return Teacher(rig)


def q(rig: Rig, robot: str = "ra1") -> tuple[float, ...]:
    found = rig.plant.dispatcher.beliefs[robot].q
    assert found is not None
    return found


def turned(rig: Rig, by: float = FAR) -> tuple[float, ...]:
    first, *others = q(rig)
    return (first + by, *others)


def goals(rig: Rig, kind: type = MoveJoints) -> list[Any]:
    return [message for message in rig.sent if isinstance(message, kind)]


def test_a_button_that_is_held_moves_the_robot_in_short_strides_at_low_speed(
    rig: Rig, teacher: Teacher
) -> None:
    start, goal, began = q(rig), turned(rig), rig.now
    teacher.press(2.0, goal=goal)
    moved = q(rig)[0] - start[0]
    speed = shipped().cell("sis_a").teach.turn
    assert 0.2 * speed < moved / (rig.now - began) <= speed
    assert len(goals(rig)) > 10
    steps = [start, *(each.q for each in goals(rig))]
    assert max(abs(b[0] - a[0]) for a, b in pairwise(steps)) < math.radians(1.0)


def test_it_goes_to_the_goal_and_no_further(rig: Rig, teacher: Teacher) -> None:
    goal = turned(rig, 0.1)
    teacher.press(4.0, goal=goal)
    assert rig.plant.model.robots["ra1"].motion.stands_at(q(rig), goal)
    assert rig.plant.cells["sis_a"].manual.teaching.held is None


def test_who_says_no_more_that_it_is_held_lets_the_robot_stand(rig: Rig, teacher: Teacher) -> None:
    teacher.press(1.0, goal=turned(rig))
    last = rig.now - BEAT_S
    rig.wait(0.3 - BEAT_S)
    assert not rig.boards["ra_1"].body.moving
    stood = q(rig)
    rig.wait(2.0)
    assert q(rig) == stood
    assert max(each for each in _sent_at(rig, MoveJoints)) <= last + HOLD_S
    assert "not held any more" in str(rig.plant.cells["sis_a"].manual.teaching.trouble)


def _sent_at(rig: Rig, kind: type) -> list[float]:
    return [at for at, said in rig.to_boards if said.topic.endswith("/juntas")] or [0.0]


def test_letting_go_halts_at_once(rig: Rig, teacher: Teacher) -> None:
    teacher.press(0.5, goal=turned(rig))
    while not rig.boards["ra_1"].body.moving:
        teacher.jog(goal=turned(rig))
        rig.wait(0.01)
    teacher.release()
    halts = [each for each in goals(rig, Stop) if each.mode is StopMode.HALT]
    assert [each.robot for each in halts] == ["ra1"]
    rig.wait(0.1)
    assert not rig.boards["ra_1"].body.moving


def test_a_press_that_is_over_never_comes_back(rig: Rig, teacher: Teacher) -> None:
    teacher.press(0.3, goal=turned(rig))
    late = teacher.made(goal=turned(rig))
    rig.wait(1.0)
    stood = q(rig)
    for _ in range(10):
        rig.tell(replace(late, at=rig.now))
        rig.wait(BEAT_S)
    assert q(rig) == stood


def test_a_gap_within_one_step_of_the_plant_ends_a_press(rig: Rig, teacher: Teacher) -> None:
    teacher.press(0.2, goal=turned(rig))
    teaching = rig.plant.cells["sis_a"].manual.teaching
    teaching.take(replace(teacher.made(goal=turned(rig)), at=rig.now + 1.0))
    assert teaching.held is None


def test_a_button_stays_that_of_one_robot(rig: Rig, teacher: Teacher) -> None:
    teacher.press(0.2, goal=turned(rig))
    teacher.jog("rm_sis_a", goal=1)
    rig.wait(1.0)
    assert goals(rig, FollowPath) == []


def test_its_goal_may_be_another_while_it_is_held(rig: Rig, teacher: Teacher) -> None:
    start = q(rig)
    teacher.press(1.0, goal=turned(rig))
    there = q(rig)
    for _ in range(20):
        teacher.jog(goal=start)
        rig.wait(BEAT_S)
    assert start[0] <= q(rig)[0] < there[0]


def test_no_task_starts_and_the_queue_stays_paused_afterwards(rig: Rig, teacher: Teacher) -> None:
    rig.submit("sis_a 0B 7")
    rig.wait(5.0)
    assert rig.plant.cells["sis_a"].task is None
    assert "is being taught by ana" in str(rig.changes[-1].sentence)
    assert rig.operate(Verb.AUTOMATIC, "sis_a") is None
    rig.wait(5.0)
    assert rig.plant.cells["sis_a"].task is None
    assert rig.operate(Verb.RESUME, "sis_a") is None
    rig.wait(1.0)
    assert rig.plant.cells["sis_a"].task is not None


@pytest.mark.parametrize("verb", [Verb.RESUME, Verb.HOME, Verb.RELEASE])
def test_others_move_nothing_meanwhile(rig: Rig, teacher: Teacher, verb: Verb) -> None:
    refusal = rig.operate(verb, "sis_a")
    assert refusal == "sis_a is being taught by ana; automatic sis_a ends that"


def test_only_one_person_teaches(rig: Rig, teacher: Teacher) -> None:
    refusal = rig.operate(Verb.TEACH, "sis_a", teacher="luis")
    assert refusal == "sis_a is being taught by ana, and only by one person"
    other = replace(teacher.made(goal=turned(rig)), session=teacher.session + 1, number=1)
    assert "only by one person" in str(rig.plant.jog_refusal(other))
    rig.tell(other)
    rig.wait(1.0)
    assert goals(rig) == []


def test_a_cell_with_a_task_is_not_taught(rig: Rig) -> None:
    rig.submit("sis_a 0B 7")
    rig.wait(1.0)
    refusal = "sis_a is in execute; only a cell that is idle, or held without a task, can be taught"
    assert rig.operate(Verb.TEACH, "sis_a", teacher="ana") == refusal
    assert rig.operate(Verb.HOLD, "sis_a") is None
    rig.wait(3.0)
    assert rig.operate(Verb.TEACH, "sis_a", teacher="ana") == refusal.replace("in execute", "held")


def test_a_robot_that_is_not_heard_keeps_it_from_beginning(rig: Rig) -> None:
    rig.power_off("ra_1")
    rig.wait(3.0)
    assert rig.operate(Verb.TEACH, "sis_a", teacher="ana") == "ra1 is offline"


@pytest.mark.parametrize("teacher", ["", " ", "a" * 41, "a\nb"])
def test_who_teaches_has_a_name(rig: Rig, teacher: str) -> None:
    assert rig.operate(Verb.TEACH, "sis_a", teacher=teacher) == "say who teaches sis_a, in 1 to 40 letters"


@pytest.mark.long
def test_it_ends_by_itself_when_nobody_touches_it(rig: Rig, teacher: Teacher) -> None:
    rig.wait(299.0)
    teacher.press(0.2, goal=turned(rig))
    rig.wait(299.0)
    assert rig.plant.cells["sis_a"].manual.teaching is not None
    rig.wait(2.0)
    assert rig.plant.cells["sis_a"].manual.teaching is None
    last = [message for message in rig.sent if isinstance(message, Journal)][-1]
    assert str(last.sentence) == "teaching of sis_a by ana ended: nobody touched it for 300 s"


def test_a_stop_ends_it(rig: Rig, teacher: Teacher) -> None:
    teacher.press(0.5, goal=turned(rig))
    assert rig.operate(Verb.STOP, "sis_a") is None
    assert rig.plant.cells["sis_a"].manual.teaching is None
    rig.wait(2.0)
    stood = q(rig)
    teacher.press(1.0, goal=turned(rig))
    assert q(rig) == stood


def test_limits_are_told_before_anything_moves(rig: Rig, teacher: Teacher) -> None:
    teacher.number = 1
    beyond = teacher.made(goal=(math.radians(151), *q(rig)[1:]))
    assert str(rig.plant.jog_refusal(beyond)) == "ra1 cannot go there: brazo_joint goes from -150 to 150 deg"
    rig.tell(beyond)
    rig.wait(1.0)
    assert goals(rig) == []


@pytest.fixture
def zoned(tmp_path: Path) -> Rig:
    """The shipped plant whose first two arms share a zone."""
    text = files("arboleda").joinpath("plants/plant.yaml").read_text()
    path = tmp_path / "plant.yaml"
    path.write_text(text + "\nzones:\n  centre:\n    poses: [sis_a pickup, sis_b pickup]\n")
    rig = Rig(load(path))
    rig.wait(2.0)
    return rig


def test_a_zone_of_somebody_else_keeps_a_cell_from_being_taught(zoned: Rig) -> None:
    zoned.submit("sis_b 0B 7")
    assert zoned.wait(60.0, until=lambda: bool(zoned.plant.zones.held_by("ra2")))
    refusal = zoned.operate(Verb.TEACH, "sis_a", teacher="ana")
    assert refusal == "ra1 may get into zone centre, which ra2 holds"


def test_its_zones_are_held_until_its_end(zoned: Rig) -> None:
    rig, _ = zoned, Teacher(zoned)
    rig.wait(5.0)
    assert rig.plant.zones.held_by("ra1") == {"centre"}
    rig.submit("sis_b 0B 7")
    rig.wait(20.0)
    assert rig.plant.zones.held_by("ra1") == {"centre"}
    assert rig.operate(Verb.AUTOMATIC, "sis_a") is None
    rig.wait(1.0)
    assert rig.plant.zones.held_by("ra1") == frozenset()


def test_a_mobile_robot_goes_from_node_to_node(rig: Rig, teacher: Teacher) -> None:
    teacher.press(20.0, "rm_sis_a", goal=4)
    assert rig.plant.dispatcher.beliefs["rm_sis_a"].node == 4
    assert [each.nodes for each in goals(rig, FollowPath)] == [(0, 1), (1, 4)]
    teacher.number += 1
    nowhere = teacher.made("rm_sis_a", goal=9)
    assert str(rig.plant.jog_refusal(nowhere)) == "rm_sis_a cannot go there: node 9 is none of its 9"


def test_a_gripper_grips_in_manual_and_the_cell_says_so_afterwards(rig: Rig, teacher: Teacher) -> None:
    teacher.press(0.5, word="grip")
    rig.wait(1.0)
    assert rig.plant.dispatcher.beliefs["ra1"].effector is True
    assert rig.plant.cells["sis_a"].state.value == "idle"
    teacher.press(1.0, goal=turned(rig))
    assert rig.operate(Verb.AUTOMATIC, "sis_a") is None
    rig.wait(0.5)
    assert rig.plant.cells["sis_a"].state.value == "held"


def test_homing_is_held_like_any_move(rig: Rig, teacher: Teacher) -> None:
    teacher.press(6.0, goal=turned(rig, 1.0))
    teacher.press(0.1, word="home")
    rig.wait(1.0)
    assert not rig.boards["ra_1"].body.moving
    assert rig.plant.dispatcher.beliefs["ra1"].unhomed
    teacher.press(30.0, word="home")
    assert not rig.plant.dispatcher.beliefs["ra1"].unhomed


def test_a_plant_that_dies_meanwhile_starts_no_task_by_itself(rig: Rig, teacher: Teacher) -> None:
    kept = [m for m in rig.sent if isinstance(m, Remember) and m.fact is Fact.MANUAL]
    assert [(each.name, each.value) for each in kept] == [("sis_a", "ana")]
    rig.crash()
    rig.wait(3.0)
    assert rig.plant.cells["sis_a"].manual.teaching is None
    assert rig.plant.cells["sis_a"].queue.paused
    assert not rig.plant.cells["sis_b"].queue.paused
