"""What every store of a plant's memory does alike, here over an SQLite file."""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Iterator
from contextlib import closing, contextmanager
from dataclasses import replace
from pathlib import Path

import pytest

from arboleda.model.messages import Course, Fact, Journal, Reason, Remember, TaskAnswer, TaskState, Verb
from arboleda.model.sentence import OWN
from arboleda.store.package_table import PackageTable
from arboleda.store.sqlite import Store
from arboleda.store.task_rows import TaskHistory, TaskQuery, answers_of, course_of
from arboleda.store.task_table import PRUNED

from .memory_samples import ACT, FOUND, LATCH, ODD, ended, queued, tell_of_four


class Site:
    """A place for the memory of one plant, which can be opened again and again."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._histories: list[TaskHistory] = []

    @contextmanager
    def memory(self) -> Iterator[Store]:
        with Store(self._path) as memory:
            memory.lead.take(1)
            yield memory

    def history(self) -> TaskHistory:
        self._histories.append(TaskHistory(self._path))
        return self._histories[-1]

    def rows(self, query: str) -> list[tuple]:
        with closing(sqlite3.connect(self._path)) as db:
            return db.execute(query).fetchall()

    def close(self) -> None:
        for each in self._histories:
            each.close()


@pytest.fixture
def site(tmp_path):
    made = Site(tmp_path / "plant.sqlite")
    yield made
    made.close()


@pytest.fixture
def store(site):
    with site.memory() as opened:
        yield opened


def times(site):
    """The starts of the plant, and when its cells did no work."""
    runs = site.rows("SELECT since_s, seen_s, ended FROM run ORDER BY number")
    downs = site.rows("SELECT cell, state, since_s, until_s FROM down ORDER BY number")
    return runs, downs


def test_a_new_memory_is_empty(store):
    assert [store.facts(fact) for fact in Fact] == [{}] * len(Fact)
    assert store.acts.last() == []


def test_a_fact_is_kept_replaced_and_forgotten(site):
    with site.memory() as store:
        store.keep(Remember(fact=Fact.EFFECTOR, name="ra1", value="switching"))
        store.keep(Remember(fact=Fact.EFFECTOR, name="ra2", value="off"))
        store.keep(Remember(fact=Fact.EFFECTOR, name="ra1", value="on"))
        store.keep(LATCH)
    with site.memory() as store:
        assert store.facts(Fact.EFFECTOR) == {"ra1": "on", "ra2": "off"}
        store.keep(Remember(fact=Fact.EFFECTOR, name="ra1", value=None))
        store.keep(Remember(fact=Fact.QUARANTINE, name="nowhere", value=None))
        assert store.facts(Fact.EFFECTOR) == {"ra2": "off"}
        assert store.facts(Fact.LATCH) == {"ra1": "on"}


def test_the_table_of_a_package_is_there_after_a_restart(site):
    with site.memory() as store:
        table = PackageTable(store, "acme")
        assert table.rows() == {}
        table.put({"a": "1", ODD: ODD, "b": "2"})
        PackageTable(store, "acme.other").put({"a": "7"})
    with site.memory() as store:
        table = PackageTable(store, "acme")
        table.put({"a": None, "b": "3", "nobody": None})
        table.put({})
        assert table.rows() == {ODD: ODD, "b": "3"}
        assert PackageTable(store, "acme.other").rows() == {"a": "7"}
        assert [store.facts(fact) for fact in Fact] == [{}] * len(Fact)


def test_the_journal_is_read_newest_first(site):
    with site.memory() as store:
        stopped = Journal(verb=Verb.STOP, scope="ra1", cell="sis_a", sentence=OWN(text="ra1 stopped"))
        store.acts.keep(stopped, 1000.25)
        store.acts.keep(ACT, 999.5)
    with site.memory() as store:
        newest, oldest = store.acts.last()
        assert (newest.id, newest.unix_s, newest.verb) == (2, 999.5, Verb.OVERRIDE)
        assert (newest.scope, newest.cell, newest.sentence) == (ACT.scope, None, str(ACT.sentence))
        assert (oldest.scope, oldest.cell) == ("ra1", "sis_a")
        assert (oldest.id, oldest.unix_s, oldest.verb) == (1, 1000.25, "stop")
        assert store.acts.last(limit=1) == [newest]


def test_who_asked_first_and_how_often_a_task_was_tried_are_kept(site):
    with site.memory() as store:
        store.tasks.keep(queued("a"), "storage", 5.0, "page")
        store.tasks.keep(queued("a"), "storage", 6.0, "http")  # whoever asks again asks for the same task
        store.tasks.keep(queued("b"), "storage", 7.0, "ros2")
        for _ in range(2):  # as it is told anew to whoever asks
            store.tasks.keep(ended("a", TaskState.RUNNING), "storage", 8.0)
        store.tasks.attempted("a", 3)
        store.tasks.keep(ended("a"), "storage", 9.0)
    with site.memory() as store:
        kept = {row.id: (row.asked_by, row.attempts) for row in store.tasks.select(TaskQuery())}
    assert kept == {"a": ("page", 3), "b": ("ros2", 0)}


def test_what_was_answered_is_kept_with_the_end_of_a_task(site):
    heard = [
        TaskAnswer(by="ana", asked="¿Lleno?", answer="yes"),
        TaskAnswer(by="eye", asked="look", answer=2.5),
    ]
    with site.memory() as store:
        for id, answers in (("a", heard), ("b", ())):
            store.tasks.keep(queued(id), "storage", 5.0)
            store.tasks.keep(ended(id), "storage", 9.0, answers=answers)
    with site.memory() as store:
        kept = {row.id: answers_of(row) for row in store.tasks.select(TaskQuery())}
    assert kept == {"a": tuple(heard), "b": ()}


def test_how_a_task_went_is_kept_with_its_end(site):
    course = Course(seconds=31.507, begun={"drive path 0B #1": 0.2, "move to “home” #2": 28.0})
    with site.memory() as store:
        for id, how in (("a", course), ("b", None)):
            store.tasks.keep(queued(id), "storage", 5.0)
            store.tasks.keep(replace(ended(id), course=how), "storage", 9.0)
    with site.memory() as store:
        assert {row.id: course_of(row) for row in store.tasks.select(TaskQuery())} == {"a": course, "b": None}


def test_old_times_of_cells_are_forgotten_at_a_start(site):
    with site.memory() as store:
        store.times.began(10.0)
        store.times.stands("sis_a", "held", 20.0)
        store.times.stands("sis_a", None, 30.0)
        store.times.note_run(70.0, ended=True)
        store.tasks.keep(queued("a"), "storage", 40.0)
        store.times.began(500.0)
        assert times(site) == ([(10.0, 70.0, 1), (500.0, 500.0, 0)], [])
        store.tasks.keep(ended("a"), "storage", 501.0, ran_s=1.0)
        store.tasks.keep(queued("b"), "storage", 502.0)
        store.times.note_run(560.0, ended=True)
        store.tasks.forget(2.0)
        store.times.began(600.0)
    assert times(site)[0] == [(500.0, 560.0, 1), (600.0, 600.0, 0)]


def test_of_a_plant_without_tasks_no_time_is_forgotten(site):
    with site.memory() as store:
        store.times.began(10.0)
        store.times.began(1e10)
    assert len(times(site)[0]) == 2


def test_times_of_a_start_follow_its_clock_and_those_of_earlier_ones_stay(site):
    with site.memory() as store:
        tell_of_a_start(store, "a", 1000.0, ran_s=50.0)
        tell_of_a_start(store, "b", 2000.0, ran_s=150.0)
        store.tasks.keep(queued("open"), "storage", 2040.0)
        store.times.stands("sis_b", "held", 2045.0)
        for _ in range(2):  # a database may get it again
            store.move_times(-500.0, 1550.0, 50.0, 50.0)
        tasks = store.tasks.select(TaskQuery())
    rows = {row.id: (row.accepted_s, row.started_s, row.ended_s) for row in tasks}
    assert rows == {
        "a": (1010.0, 1020.0, 1030.0),
        "b": (1510.0, 1520.0, 1530.0),
        "open": (1540.0, None, None),
    }
    runs, downs = times(site)
    assert [run[:2] for run in runs] == [(1000.0, 1040.0), (1500.0, 1540.0)]
    assert [down[2:] for down in downs] == [(1035.0, 1036.0), (1535.0, 1536.0), (1545.0, None)]


def test_times_of_earlier_starts_stay_though_their_clock_was_ahead_of_that_of_this_one(site):
    with site.memory() as store:
        tell_of_a_start(store, "a", 90_000.0, ran_s=50.0)
        store.tasks.keep(queued("open"), "storage", 90_050.0)
        store.times.began(2000.0)
        store.move_times(88_100.0, 90_150.0, 50.0, 50.0)
        tasks = store.tasks.select(TaskQuery())
    assert {row.id: row.accepted_s for row in tasks} == {"a": 90_010.0, "open": 90_050.0}
    runs, downs = times(site)
    assert [run[:2] for run in runs] == [(90_000.0, 90_040.0), (90_100.0, 90_100.0)]
    assert [down[2:] for down in downs] == [(90_035.0, 90_036.0)]


def tell_of_a_start(memory, task, unix_s, *, ran_s):
    """A start of the plant, in which a cell was held for a second and did a task."""
    memory.times.began(unix_s)
    memory.tasks.keep(queued(task), "storage", unix_s + 10.0)
    memory.tasks.keep(ended(task, TaskState.RUNNING), "storage", unix_s + 20.0)
    memory.tasks.keep(ended(task), "storage", unix_s + 30.0, ran_s=ran_s)
    memory.times.stands("sis_a", "held", unix_s + 35.0)
    memory.times.stands("sis_a", None, unix_s + 36.0)
    memory.times.note_run(unix_s + 40.0)


def test_what_a_clock_that_was_ahead_began_ends_no_earlier(site):
    with site.memory() as store:
        store.tasks.keep(queued("a"), "storage", 1000.0)
        store.tasks.keep(ended("a", TaskState.RUNNING), "storage", 90_000.0)
    with site.memory() as store:
        store.tasks.keep(ended("a"), "storage", 1010.0)
        (row,) = store.tasks.select(TaskQuery())
    assert row.started_s == row.ended_s == 90_000.0


def test_what_stood_when_the_plant_was_killed_stood_until_it_was_seen_last(site):
    with site.memory() as store:
        store.times.began(10.0)
        store.times.stands("sis_a", "held", 20.0)
        store.times.stands("sis_b", "held", 75.0)
        store.times.note_run(70.0)
        store.times.began(500.0)
        store.times.stands("sis_a", "held", 501.0)
        store.times.stands("sis_a", "aborted", 502.0)
        store.times.stands("sis_a", None, 503.0)
        store.times.note_run(560.0, ended=True)
    assert times(site) == (
        [(10.0, 70.0, 0), (500.0, 560.0, 1)],
        [
            ("sis_a", "held", 20.0, 70.0),
            ("sis_b", "held", 75.0, 75.0),
            ("sis_a", "held", 501.0, 502.0),
            ("sis_a", "aborted", 502.0, 503.0),
        ],
    )


def test_a_task_is_kept_from_its_acceptance_to_its_end(site):
    with site.memory() as store:
        store.tasks.keep(queued("a"), "storage", 1.0)
        store.tasks.keep(ended("a", TaskState.RUNNING), "storage", 2.0)
    with site.memory() as store:
        (row,) = store.tasks.select(TaskQuery())
        assert (row.id, row.text, row.cell, row.recipe) == ("a", "sis_a 0B 1", "sis_a", "storage")
        assert (row.state, row.accepted_s, row.started_s, row.ended_s) == ("running", 1.0, 2.0, None)
        store.tasks.keep(
            ended("a", TaskState.FAILED, reason=Reason.DEADLINE, sentence=OWN(text="late")), "", 3.0
        )
    with site.memory() as store:
        (row,) = store.tasks.select(TaskQuery())
        assert (row.state, row.reason, row.sentence, row.ended_s) == ("failed", "deadline", "late", 3.0)
        assert json.loads(row.said) == OWN(text="late").data()


def test_a_task_that_is_asked_for_again_stays_as_it_is(store):
    for change, at in [(queued("a"), 1.0), (ended("a", TaskState.RUNNING), 2.0), (ended("a"), 3.0)]:
        store.tasks.keep(change, "storage", at)
    (kept,) = store.tasks.select(TaskQuery())
    for change in (queued("a"), ended("a", TaskState.RUNNING), ended("a", TaskState.FAILED)):
        store.tasks.keep(change, "storage", 9.0)
    assert store.tasks.select(TaskQuery()) == [kept]


def test_a_task_that_was_refused_is_not_kept(store):
    store.tasks.keep(ended("", TaskState.REFUSED), "", 1.0)
    assert store.tasks.select(TaskQuery()) == []


@pytest.mark.parametrize(("query", "ids"), FOUND)
def test_tasks_are_found_by_what_is_asked_for(site, query, ids):
    with site.memory() as store:
        tell_of_four(store)
        assert [row.id for row in store.tasks.select(query)] == ids
        assert [row.id for row in site.history().select(query)] == ids


def test_ended_tasks_are_forgotten_from_the_oldest_on_and_open_ones_never(store):
    for number in range(PRUNED + 5):
        store.tasks.keep(queued(f"n{number}"), "storage", 1.0)
        store.tasks.keep(ended(f"n{number}"), "storage", 9e9 - number, ran_s=2.0 + number)
    store.tasks.keep(queued("open"), "storage", 1.0)
    assert store.tasks.ran_s() == PRUNED + 6.0
    store.tasks.forget(1000.0)
    assert [row.id for row in store.tasks.select(TaskQuery())] == [
        "open",
        *(f"n{PRUNED + n}" for n in (4, 3, 2, 1, 0)),
    ]
    store.tasks.forget(2.0 + PRUNED + 2)
    assert len(store.tasks.select(TaskQuery(is_open=False))) == 3


def test_the_history_of_a_plant_that_kept_nothing_is_empty(site):
    assert site.history().select(TaskQuery()) == []


def test_the_history_is_read_while_the_plant_writes(site):
    history = site.history()
    with site.memory() as store:
        for id in ("a", "b"):
            store.tasks.keep(queued(id), "storage", 1.0)
            assert history.select(TaskQuery())[0].id == id
    history.close()


def test_of_facts_that_are_kept_together_the_last_word_on_each_counts(store):
    other = Remember(fact=Fact.LATCH, name="ra2", value="on")
    store.keep(LATCH, other)
    store.keep(replace(LATCH, value="off"), replace(other, value=None), replace(LATCH, value="cleared"))
    assert store.facts(Fact.LATCH) == {"ra1": "cleared"}


def test_a_text_may_have_any_character(store):
    store.keep(Remember(fact=Fact.STEP, name=ODD, value=ODD))
    store.tasks.keep(queued("a"), ODD, 1.0)
    assert store.facts(Fact.STEP) == {ODD: ODD}
    assert [row.recipe for row in store.tasks.select(TaskQuery(recipe=ODD))] == [ODD]
