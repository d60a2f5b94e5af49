"""A plant believes only what it can have written."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from arboleda.model.errors import StartError
from arboleda.model.messages import Check, Course, Fact, Reason, Remember, TaskAnswer, TaskChanged, TaskState
from arboleda.model.sentence import OWN, Phrase, retold
from arboleda.model.task import Task
from arboleda.runtime.memory import kept_tasks, remembered
from arboleda.store.sqlite import Store
from arboleda.store.task_rows import TaskQuery, course_of, unchecked_of


@pytest.fixture
def store() -> Iterator[Store]:
    with Store(Path(":memory:")) as made:
        yield made


def test_what_was_kept_is_remembered(store: Store) -> None:
    kept = {
        Fact.LATCH: {"ra1": "cleared", "ra2": "on"},
        Fact.EFFECTOR: {"ra1": "on"},
        Fact.EMPTIED: {"mill": "true"},
        Fact.QUARANTINE: {"mesa": "gone"},
        Fact.PARTS: {"lab": "nest=1 jaw:nest+"},
        Fact.STORED: {"sis_a": "0 7"},
        Fact.DISPLACED: {"rm": "true"},
        Fact.BOOT: {"rm": "17"},
        Fact.STEP: {"lot-1": "{}"},
        Fact.MANUAL: {"sis_a": "ana"},
    }
    for fact, values in kept.items():
        for name, value in values.items():
            store.keep(Remember(fact=fact, name=name, value=value))
    assert remembered(store) == kept


@pytest.mark.parametrize("fact", [Fact.LATCH, Fact.EFFECTOR])
@pytest.mark.parametrize("value", ["", "Latched", "\x1b[2J"])
def test_a_value_that_means_nothing_is_refused_for_it_may_have_been_a_latch(
    store: Store, fact: Fact, value: str
) -> None:
    store.keep(Remember(fact=fact, name="ra1", value=value))
    with pytest.raises(StartError, match="which means nothing: put a copy") as refused:
        remembered(store)
    assert str(refused.value).isprintable()


def test_kept_tasks_come_in_their_order_with_times_of_this_start(store: Store) -> None:
    def change(id: str, state: TaskState, **why: object) -> TaskChanged:
        return TaskChanged(task=id, text="sis_a 0B 1", cell="sis_a", state=state, **why)  # type: ignore[arg-type]

    late = Phrase("late", "{robot} took {seconds} s")(robot="ra1", seconds=3)
    store.tasks.keep(change("a", TaskState.QUEUED), "storage", 1000.0)
    store.tasks.keep(change("b", TaskState.QUEUED), "storage", 1001.0)
    store.tasks.keep(change("a", TaskState.RUNNING), "storage", 1002.0)
    store.tasks.keep(change("a", TaskState.FAILED, reason=Reason.DEADLINE, sentence=late), "storage", 1005.0)
    a, b = kept_tasks(store, clock_s=50.0, unix_s=1010.0)
    assert (a.id, a.state, a.started_at, a.ended_at) == ("a", TaskState.FAILED, 42.0, 45.0)
    assert (b.id, b.state, b.started_at, b.failure) == ("b", TaskState.QUEUED, None, None)
    assert (a.attempts, b.attempts) == (1, 0)
    assert a.failure is not None and a.failure.reason is Reason.DEADLINE
    assert str(a.failure.sentence) == "ra1 took 3 s"
    assert a.failure.sentence.text_by(lambda phrase: {"late": "{robot} tardó {seconds} s"}[phrase.key]) == (
        "ra1 tardó 3 s"
    )


def test_a_task_comes_back_with_what_was_answered(store: Store) -> None:
    change = TaskChanged(task="a", text="bench weigh", cell="bench", state=TaskState.QUEUED)
    store.tasks.keep(change, "weigh", 1000.0)
    heard = TaskAnswer(by="scale", asked="weigh", answer="enough")
    store.tasks.keep(replace(change, state=TaskState.DONE), "weigh", 1002.0, answers=[heard])
    (task,) = kept_tasks(store, clock_s=50.0, unix_s=1010.0)
    assert task.answers == (heard,)


def test_a_task_comes_back_with_how_it_went_and_without_where_that_is_damaged(store: Store) -> None:
    change = TaskChanged(task="a", text="bench weigh", cell="bench", state=TaskState.QUEUED)
    store.tasks.keep(change, "weigh", 1000.0)
    course = Course(seconds=2.0, begun={"look #1": 0.25})
    store.tasks.keep(replace(change, state=TaskState.DONE, course=course), "weigh", 1002.0)
    (task,) = kept_tasks(store, clock_s=50.0, unix_s=1010.0)
    assert task.course == course
    (row,) = store.tasks.select(TaskQuery())
    for damaged in (
        "{",
        "[]",
        '{"seconds": 2}',
        '{"seconds": "x", "begun": {}}',
        '{"seconds": 2, "begun": 3}',
    ):
        assert course_of(replace(row, course=damaged)) is None


def test_a_task_comes_back_with_what_was_not_checked_and_without_where_that_is_damaged(store: Store) -> None:
    change = TaskChanged(task="a", text="bench weigh", cell="bench", state=TaskState.QUEUED)
    store.tasks.keep(change, "weigh", 1000.0)
    done = replace(change, state=TaskState.DONE, unchecked=(Check.RELEASE,))
    store.tasks.keep(done, "weigh", 1002.0)
    (task,) = kept_tasks(store, clock_s=50.0, unix_s=1010.0)
    assert task.unchecked == (Check.RELEASE,)
    assert str(Task.of(task).remark) == "not checked: whether the part was let go of"
    (row,) = store.tasks.select(TaskQuery())
    assert unchecked_of(replace(row, unchecked="grip weight")) == ()


def test_a_sentence_that_was_kept_with_braces_is_said_as_it_was() -> None:
    assert str(retold("{not a slot}", OWN(text="{not a slot}").data())) == "{not a slot}"
    with pytest.raises(ValueError, match="is no sentence"):
        retold("said", {"key": "x"})
