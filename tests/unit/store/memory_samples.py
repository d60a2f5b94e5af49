"""What the memory of a plant is told, and what is found in it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from arboleda.model.messages import Fact, Journal, Remember, TaskChanged, TaskState, Verb
from arboleda.model.sentence import OWN
from arboleda.store.plant_memory import PlantMemory
from arboleda.store.task_rows import TaskQuery

LATCH = Remember(fact=Fact.LATCH, name="ra1", value="on")
ACT = Journal(
    verb=Verb.OVERRIDE, scope="mesa", cell=None, sentence=OWN(text="mesa is free: ra1 was carried away")
)
ODD = "ñ 'x' \"y\" % ? %s {} \\ \n 日本"
FOUR = {"a": "sis_a 0B 1", "b": "sis_a 0B 2", "c": "sis_b 0B 1", "d": "sis_a palletizing"}
FOUND = [  # of these four, of which a is done
    (TaskQuery(), ["d", "c", "b", "a"]),
    (TaskQuery(limit=2), ["d", "c"]),
    (TaskQuery(limit=2, before=3), ["b", "a"]),
    (TaskQuery(cell="sis_b"), ["c"]),
    (TaskQuery(state="done"), ["a"]),
    (TaskQuery(recipe="palletizing"), ["d"]),
    (TaskQuery(is_open=True), ["d", "c", "b"]),
    (TaskQuery(is_open=False), ["a"]),
    (TaskQuery(words="0b 2"), ["b"]),
    (TaskQuery(words="0_ 2"), []),
    (TaskQuery(words="%"), []),
    (TaskQuery(words="is_a"), ["d", "b", "a"]),
    (TaskQuery(id="c"), ["c"]),
    (TaskQuery(since_s=2.0, until_s=4.0), ["c", "b"]),
    (TaskQuery(cell="sis_b", state="done"), []),
]


def queued(id: str, text: str = "sis_a 0B 1") -> TaskChanged:
    return TaskChanged(task=id, text=text, cell=text.split()[0], state=TaskState.QUEUED)


def ended(id: str, state: TaskState = TaskState.DONE, **why: Any) -> TaskChanged:
    return replace(queued(id), state=state, **why)


def tell_of_four(memory: PlantMemory) -> None:
    """Four tasks are accepted one after the other, and one of them is done."""
    for at, (id, text) in enumerate(FOUR.items(), start=1):
        memory.tasks.keep(queued(id, text), "palletizing" if "pall" in text else "storage", float(at))
    memory.tasks.keep(ended("a"), "storage", 9.0)
