"""A plant's memory in a real PostgreSQL server holds what one in an SQLite file does.

The tests in tests/unit/store say what that is.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from tests.unit.store.memory_samples import FOUND, ODD, ended, queued, tell_of_four

from arboleda.model.messages import (
    Course,
    Fact,
    Journal,
    Reason,
    Remember,
    TaskAnswer,
    TaskState,
    Verb,
)
from arboleda.model.sentence import OWN
from arboleda.store.package_table import PackageTable
from arboleda.store.plant_memory import PlantMemory
from arboleda.store.sqlite import Store
from arboleda.store.task_rows import History, TaskHistory, TaskQuery
from arboleda.store.task_table import PRUNED
from arboleda_fleet.oee.api import OeeQuery
from arboleda_fleet.oee.rows import figures
from arboleda_fleet.postgres.history import PostgresHistory
from arboleda_fleet.postgres.memory import PostgresMemory

Deed = Callable[[PlantMemory], object]


class Places:
    """The same memory in a file and in a server."""

    def __init__(self, path: Path, address: str, plant: str) -> None:
        self._memories = (lambda: Store(path)), (lambda: PostgresMemory(address, plant))
        self._histories = TaskHistory(path), PostgresHistory(address, plant)

    def hold_the_same(self, *deeds: Deed) -> None:
        """Do it in both, each deed by a plant that has just started, and compare all that can be read."""
        of_file, of_server = (
            [self._seen(memory, history, deed) for deed in deeds]
            for memory, history in zip(self._memories, self._histories, strict=True)
        )
        assert of_server == of_file

    def _seen(self, opened: Callable[[], PlantMemory], history: History, deed: Deed) -> dict[str, Any]:
        with opened() as memory:
            memory.lead.take(1)
            deed(memory)
            seen = {"rows": [replace(row, number=0) for row in history.select(TaskQuery())]}
        with opened() as memory:  # as the next start finds it
            return seen | {
                "facts": [memory.facts(fact) for fact in Fact],
                "journal": memory.acts.last(),
                "table": PackageTable(memory, "acme").rows(),
                "tasks": [replace(row, number=0) for row in memory.tasks.select(TaskQuery(limit=None))],
                "figures": figures(history, OeeQuery(since_s=0.0), 1000.0),
            }

    def close(self) -> None:
        for each in self._histories:
            each.close()


@pytest.fixture
def places(tmp_path: Path, database: str, plant: str) -> Iterator[Places]:
    with closing(Places(tmp_path / "plant.sqlite", database, plant)) as made:
        yield made


def fact(name: str, value: str | None, kind: Fact = Fact.EFFECTOR) -> Remember:
    return Remember(fact=kind, name=name, value=value)


def test_facts(places: Places) -> None:
    places.hold_the_same(
        lambda memory: memory.keep(fact("ra1", "switching"), fact("ra2", "off"), fact("ra1", "on")),
        lambda memory: memory.keep(fact(ODD, ODD, Fact.STEP), fact("ra1", None), fact("nobody", None)),
    )


def test_the_table_of_a_package(places: Places) -> None:
    places.hold_the_same(
        lambda memory: PackageTable(memory, "acme").put({"a": "1", ODD: ODD, "b": "2"}),
        lambda memory: PackageTable(memory, "acme").put({"a": None, "b": "3", "nobody": None}),
        lambda memory: PackageTable(memory, "acme.other").put({"b": "4"}),
    )


def test_the_journal(places: Places) -> None:
    act = Journal(verb=Verb.STOP, scope="ra1", cell="sis_a", sentence=OWN(text=ODD))
    places.hold_the_same(
        lambda memory: memory.acts.keep(act, 1000.25),
        lambda memory: memory.acts.keep(replace(act, verb=Verb.OVERRIDE, cell=None), 999.5),
    )


def test_a_task_from_its_acceptance_to_its_end(places: Places) -> None:
    answers = (TaskAnswer(by="ana", asked=ODD, answer=2.5),)
    course = Course(seconds=31.507, begun={"drive path 0B #1": 0.2})
    late = ended("b", TaskState.FAILED, reason=Reason.DEADLINE, sentence=OWN(text="late"))

    def begun(memory: PlantMemory) -> None:
        memory.tasks.keep(queued("a"), "storage", 5.0, "page")
        memory.tasks.keep(queued("a"), "storage", 6.0, "http")  # whoever asks again asks for the same task
        memory.tasks.keep(queued("b"), ODD, 7.0, "ros2")
        memory.tasks.keep(ended("a", TaskState.RUNNING), "storage", 8.0)
        memory.tasks.attempted("a", 3)
        memory.tasks.keep(ended("", TaskState.REFUSED), "", 9.0)

    def over(memory: PlantMemory) -> None:
        memory.tasks.keep(replace(ended("a"), course=course), "storage", 9.0, answers=answers)
        memory.tasks.keep(late, "", 10.0)
        memory.tasks.keep(ended("a", TaskState.FAILED), "storage", 11.0)  # it has ended before

    places.hold_the_same(begun, over)


def test_times_of_cells(places: Places) -> None:
    def killed(memory: PlantMemory) -> None:
        memory.times.began(10.0)
        memory.tasks.keep(queued("a"), "storage", 12.0)
        memory.tasks.keep(ended("a", TaskState.RUNNING), "storage", 13.0)
        memory.tasks.keep(ended("a"), "storage", 19.0)
        memory.times.stands("sis_a", "held", 20.0)
        memory.times.stands("sis_b", "held", 75.0)
        memory.times.note_run(70.0)

    def goes_on(memory: PlantMemory) -> None:
        memory.times.began(500.0)
        memory.times.stands("sis_a", "held", 501.0)
        memory.times.stands("sis_a", None, 503.0)
        memory.times.note_run(560.0, ended=True)

    def set_back(memory: PlantMemory) -> None:
        memory.move_times(-40.0, 520.0, 0.0, 60.0)
        memory.tasks.keep(queued("b"), "storage", 565.0)
        memory.tasks.forget(1.0)

    places.hold_the_same(killed, goes_on, set_back, lambda memory: memory.times.began(600.0))


def test_tasks_are_forgotten_from_the_oldest_on(places: Places) -> None:
    def many(memory: PlantMemory) -> None:
        for number in range(PRUNED + 5):
            memory.tasks.keep(queued(f"n{number}"), "storage", 1.0)
            memory.tasks.keep(ended(f"n{number}"), "storage", 2.0, ran_s=2.0 + number)
        memory.tasks.keep(queued("open"), "storage", 1.0)

    places.hold_the_same(
        many,
        lambda memory: memory.tasks.forget(1000.0),
        lambda memory: memory.tasks.forget(2.0 + PRUNED + 2),
    )


def test_tasks_are_found_by_what_is_asked_for(database: str, plant: str) -> None:
    with PostgresMemory(database, plant) as memory, closing(PostgresHistory(database, plant)) as history:
        memory.lead.take(1)
        tell_of_four(memory)
        for select in (memory.tasks.select, history.select):
            found = [(query, [row.id for row in select(query)]) for query, _ in FOUND]
            assert found == FOUND
