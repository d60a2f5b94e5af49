"""A task that several cells can do goes to the one that is expected to have done it first."""

from __future__ import annotations

import pytest

from arboleda.core.choosing import CHOSEN, CHOSEN_IN_TROUBLE, FULL, HINDERED, LATER, PastTimes
from arboleda.model.errors import TextError
from arboleda.model.messages import TaskChanged, TaskRequest, TaskState, Verb
from arboleda.model.task import Order, Task
from arboleda.simulator.world import PLANT
from arboleda.testing import shipped
from arboleda.testing.rig import Rig
from arboleda.views.view import promises

TASK = "sis_a,sis_b 0B 7"


@pytest.fixture
def rig() -> Rig:
    made = Rig(shipped("sis_a", "sis_b"))
    made.wait(2.0)
    return made


def done(text: str, *seconds: float, recipe: str = "storage") -> list[Task]:
    """As often as there are seconds, each after so many."""
    tasks = []
    for took in seconds:
        task = Task("lot", Order(text=text, cell=text.split()[0], recipe=recipe))
        task.become(TaskState.RUNNING, 0.0)
        task.become(TaskState.DONE, took)
        tasks.append(task)
    return tasks


def order(text: str, recipe: str = "storage") -> Order:
    return Order(text=text, cell=text.split()[0], recipe=recipe)


def test_it_goes_to_the_cell_with_less_to_do(rig: Rig) -> None:
    rig.submit("sis_a 0B 1")
    answer = rig.submit(TASK)
    assert (answer.cell, answer.text) == ("sis_b", "sis_b 0B 7")
    assert answer.choice == CHOSEN(cell="sis_b", seconds=60.0, others=(LATER(cell="sis_a", seconds=120.0),))


def test_of_equal_cells_it_goes_to_the_one_that_is_named_first(rig: Rig) -> None:
    assert rig.submit("sis_b,sis_a 0B 7").cell == "sis_b"


def test_what_was_done_before_is_expected_to_take_as_long(rig: Rig) -> None:
    rig.submit("sis_b 0B 7")
    rig.wait(60.0)
    rig.submit("sis_b 0B 7")
    answer = rig.submit("sis_b,sis_a palletizing")
    assert answer.cell == "sis_a", "sis_b is at work"
    assert answer.choice is not None and answer.choice.values["seconds"] < 60.0, "something was done before"


def test_a_cell_in_trouble_is_left_out_however_little_it_has_to_do(rig: Rig) -> None:
    rig.submit("sis_b 0B 1")
    rig.power_off("rm_sis_a")
    rig.wait(10.0)
    answer = rig.submit(TASK)
    assert answer.cell == "sis_b" and answer.choice is not None
    (other,) = answer.choice.values["others"]
    assert other.phrase is HINDERED and "rm_sis_a" in str(other)


def test_a_cell_at_work_whose_robot_falls_silent_is_in_trouble(rig: Rig) -> None:
    rig.submit("sis_a 0B 1")
    rig.wait_for("sis_a", "move to pick-up")
    rig.power_off("rm_sis_a")
    for number in (2, 3):
        rig.submit(f"sis_b 0B {number}")
    rig.wait(4.0)
    assert rig.submit(TASK).cell == "sis_b"


def test_a_held_cell_is_left_out(rig: Rig) -> None:
    rig.submit("sis_a 0B 1")
    rig.wait(1.0)
    rig.operate(Verb.HOLD, "sis_a")
    rig.submit("sis_b 0B 2")
    rig.submit("sis_b 0B 3")
    assert rig.submit(TASK).cell == "sis_b"


def test_where_no_cell_works_it_says_so_and_waits_for_the_one_with_least_to_do(rig: Rig) -> None:
    rig.operate(Verb.STOP)
    answer = rig.submit(TASK)
    assert answer.state is TaskState.QUEUED and answer.choice is not None
    assert answer.choice.phrase is CHOSEN_IN_TROUBLE


def test_a_full_cell_is_left_out_and_the_task_is_refused_where_all_are_full(rig: Rig) -> None:
    limit = rig.model.cells[0].queue_limit
    rig.operate(Verb.STOP)
    for number in range(limit):
        rig.submit(f"sis_a 0B 1 #a{number}")
    answer = rig.submit(TASK)
    assert answer.cell == "sis_b" and answer.choice is not None
    assert answer.choice.values["others"] == (FULL(cell="sis_a"),)
    for number in range(limit - 1):
        rig.submit(f"sis_b 0B 1 #b{number}")
    refused = rig.submit(TASK + " ")
    assert refused.state is TaskState.REFUSED and refused.for_now


def test_it_stays_where_it_went_whatever_befalls_that_cell(rig: Rig) -> None:
    task = rig.submit(TASK).task
    rig.wait(1.0)
    rig.operate(Verb.HOLD, "sis_a")
    rig.wait(100.0)
    assert {change.cell for change in rig.changes if change.task == task} == {"sis_a"}


def test_the_same_id_again_is_the_same_task_wherever_it_is(rig: Rig) -> None:
    first = rig.submit(f"{TASK} #lot7")
    rig.submit("sis_a 0B 1")
    again = rig.submit("sis_b,sis_a 0B 7 #lot7")
    assert (again.task, again.cell) == ("lot7", first.cell)
    other = rig.submit("sis_a,sis_b 0B 6 #lot7")
    assert other.state is TaskState.REFUSED


def test_after_a_restart_it_is_the_same_task_and_still_says_why(rig: Rig) -> None:
    rig.submit("sis_a 0B 1")
    before = rig.submit(f"{TASK} #lot7")
    rig.crash(PLANT)
    rig.wait(5.0)
    again: TaskChanged = rig.submit(f"{TASK}  #lot7")
    assert (again.task, again.cell, again.choice) == ("lot7", "sis_b", before.choice)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("sis_a, sis_b 0B 7", "with commas and without spaces, e.g. sis_a,sis_b"),
        ("sis_a,sis_a 0B 7", "sis_a is named twice"),
        ("sis_a,sis_z 0B 7", "'sis_z' is not a cell"),
        ("sis_a,sis_b 0B 70", "'70' is not a station of sis_a"),
    ],
)
def test_a_group_with_a_mistake_is_refused_with_a_sentence(rig: Rig, text: str, why: str) -> None:
    refused = rig.submit(text)
    assert refused.state is TaskState.REFUSED and why in str(refused.sentence)
    assert TextError.__name__ not in str(refused.sentence)


def test_expected_is_the_median_of_the_last_times_of_the_very_same() -> None:
    times = PastTimes(done("sis_a 0B 1", 500.0, 10.0, 11.0, 90.0, 12.0, 13.0))
    assert times.expected(order("sis_a 0B 1")) == 12.0


def test_expected_of_what_was_never_done_is_what_is_most_like_it() -> None:
    known = [
        *done("sis_b palletizing", 5.0, recipe="palletizing"),
        *done("sis_a 0B 1", 20.0),
        *done("sis_b 0B 1", 30.0),
    ]
    times = PastTimes(known)
    assert times.expected(order("sis_a 0C 4")) == 20.0, "its recipe in that cell"
    assert times.expected(order("sis_c 0C 4")) == 25.0, "its recipe in other cells"
    assert times.expected(order("sis_c other", recipe="other")) == 20.0, "whatever was done"
    assert PastTimes([]).expected(order("sis_a 0B 1")) == 60.0


def test_what_cells_promise_is_said_without_giving_them_anything(rig: Rig) -> None:
    rig.submit("sis_a 0B 1")
    rows = promises(rig.plant, TASK)
    assert [(row["cell"], row["seconds"], row["hindrance"], row["full"]) for row in rows] == [
        ("sis_a", 120.0, None, False),
        ("sis_b", 60.0, None, False),
    ]
    assert len(rig.plant.intake.tasks) == 1


def test_who_chose_between_plants_says_why_and_it_is_kept_with_the_task(rig: Rig) -> None:
    asked = TaskRequest(at=rig.now, text="sis_a 0B 1 #lot7", choice="north/sis_a is first")
    rig.tell(asked)
    assert str(rig.plant.intake.tasks["lot7"].choice) == "north/sis_a is first"
    rig.tell(TaskRequest(at=rig.now, text="sis_a 0B 1 #lot7", choice="another reason"))
    assert str(rig.plant.intake.tasks["lot7"].choice) == "north/sis_a is first"
