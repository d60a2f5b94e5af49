"""A task that several cells can do goes to the one that is expected to have done it first."""

from __future__ import annotations

import pytest

from arboleda.core.choosing import CHOSEN, CHOSEN_IN_TROUBLE, FULL, HINDERED, LATER, PastTimes
from arboleda.model.errors import TextError
from arboleda.model.messages import Course, TaskChanged, TaskRequest, TaskState, Verb
from arboleda.model.task import Order, Task
from arboleda.rig.rig import Rig
from arboleda.rig.world import PLANT
from arboleda.testing import shipped
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


def went(text: str, *courses: Course) -> list[Task]:
    """Tasks that were held for a while each, so that what they took says nothing."""
    tasks = done(text, *(1000.0 for _ in courses))
    for task, course in zip(tasks, courses, strict=True):
        task.course = course
    return tasks


def left(rig: Rig, cell: str) -> float:
    """What is expected to be left of the task that runs there; nothing waits in its queue."""
    times = PastTimes(rig.plant.intake.tasks.values())
    (mine,) = (each for each in rig.plant.prospects(TASK) if each.order.cell == cell)
    return mine.seconds - times.expected(mine.order)


def learned(rig: Rig, text: str = "sis_a 0B 1") -> Course:
    """How a task went that is done when it begins where the one before it has ended."""
    for words in ("sis_a 0B 1", text):
        task = rig.submit(words).task
        assert rig.wait(60.0, lambda: rig.plant.intake.tasks[task].state is TaskState.DONE)  # noqa: B023
    course = rig.plant.intake.tasks[task].course
    assert course is not None
    return course


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


def test_a_task_that_ended_before_it_began_by_a_clock_that_was_set_back_says_nothing() -> None:
    times = PastTimes(done("sis_a 0B 7", 30.0, -3570.0))
    assert times.expected(order("sis_a 0B 7")) == 30.0


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


def test_the_time_for_which_a_task_was_held_is_not_learned() -> None:
    times = PastTimes(went("sis_a 0B 1", Course(seconds=20.0, begun={})))
    assert times.expected(order("sis_a 0B 1")) == 20.0


def test_what_is_left_is_what_was_left_at_that_step_less_what_it_took_so_far() -> None:
    times = PastTimes(went("sis_a 0B 1", Course(seconds=20.0, begun={"a": 0.0, "b": 4.0, "c": 12.0})))
    assert [times.remaining_s(order("sis_a 0B 1"), [("b", seconds)]) for seconds in (0.0, 5.0)] == [
        16.0,
        11.0,
    ]


def test_a_step_that_takes_longer_than_ever_leaves_what_comes_after_it() -> None:
    times = PastTimes(went("sis_a 0B 1", Course(seconds=20.0, begun={"a": 0.0, "b": 4.0, "c": 12.0})))
    assert times.remaining_s(order("sis_a 0B 1"), [("b", 3600.0)]) == 8.0
    assert times.remaining_s(order("sis_a 0B 1"), [("c", 3600.0)]) == 0.0


def test_steps_are_known_of_other_tasks_of_the_recipe_and_of_no_other_recipe() -> None:
    courses = [Course(seconds=seconds, begun={"b": 4.0}) for seconds in (10.0, 12.0, 30.0)]
    times = PastTimes(went("sis_a 0B 1", *courses))
    assert times.remaining_s(order("sis_a 0C 4"), [("b", 1.0)]) == 7.0
    assert times.remaining_s(order("sis_b 0C 4"), [("b", 1.0)]) == 7.0
    assert times.remaining_s(order("sis_a 0C 4"), [("other", 0.5), ("b", 1.0)]) == 7.0, (
        "the last that is known"
    )
    assert times.remaining_s(order("sis_a 0C 4"), [("other", 0.5)]) is None
    assert times.remaining_s(order("sis_a palletizing", recipe="palletizing"), [("b", 1.0)]) is None


def test_a_task_that_was_held_long_is_not_nearly_done(rig: Rig) -> None:
    course = learned(rig)
    rig.submit("sis_a 0B 1")
    rig.wait(5.0)
    assert left(rig, "sis_a") == pytest.approx(course.seconds - 5.0, abs=0.5)
    rig.operate(Verb.HOLD, "sis_a")
    rig.wait(100.0)
    assert left(rig, "sis_a") == pytest.approx(course.seconds - 5.0, abs=0.5), "it stands"
    rig.operate(Verb.RESUME, "sis_a")
    rig.wait(2.0)
    assert course.seconds - 5.5 > left(rig, "sis_a") > 0.5


def test_a_task_is_learned_without_its_hold(rig: Rig) -> None:
    course, task = learned(rig), rig.submit("sis_a 0B 1").task
    rig.wait(5.0)
    rig.operate(Verb.HOLD, "sis_a")
    rig.wait(100.0)
    rig.operate(Verb.RESUME, "sis_a")
    assert rig.wait(60.0, lambda: rig.plant.intake.tasks[task].state is TaskState.DONE)
    again = rig.plant.intake.tasks[task].course
    assert again is not None and again.seconds == pytest.approx(course.seconds, abs=5.0)
    assert again.begun.keys() == course.begun.keys()


def test_how_tasks_went_is_known_after_a_restart_too(rig: Rig) -> None:
    course = learned(rig, "sis_a 0B 1 #lot7")
    rig.crash(PLANT)
    rig.wait(5.0)
    assert rig.plant.intake.tasks["lot7"].course == course


def test_a_task_into_which_a_restart_cut_says_nothing_of_its_steps(rig: Rig) -> None:
    rig.submit("sis_a 0B 1 #lot7")
    rig.wait(5.0)
    rig.crash(PLANT)
    rig.wait(5.0)
    rig.operate(Verb.RESUME, "sis_a")
    task = rig.plant.intake.tasks["lot7"]
    assert rig.wait(60.0, lambda: task.state is TaskState.DONE) and task.course is None


def test_what_is_left_after_a_restart_goes_by_the_steps_that_began_since(rig: Rig) -> None:
    course = learned(rig)
    rig.submit("sis_a 0B 1 #lot7")
    rig.wait(5.0)
    rig.crash(PLANT)
    rig.wait(100.0)
    run = rig.plant.cells["sis_a"].run
    assert not run.steps
    rig.operate(Verb.RESUME, "sis_a")
    assert rig.wait(30.0, lambda: bool(run.steps))
    assert course.seconds > left(rig, "sis_a") > 1.0


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
