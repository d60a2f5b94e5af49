"""What counts as a change of the plant."""

from __future__ import annotations

import asyncio
import copy

import pytest

from arboleda.core.plant import Plant
from arboleda.testing.plants import shipped
from arboleda.views import view
from arboleda.web import stream
from arboleda.web.stream import Reader, changed


@pytest.fixture
def before() -> dict:
    return view.snapshot(Plant(shipped(), epoch=7, now=0.0))


def after(before: dict, where: str, **keys: object) -> dict:
    made = copy.deepcopy(before)
    made[where][0].update(keys)
    return made


def test_nothing_changed(before: dict) -> None:
    assert changed(before, copy.deepcopy(before)) == []


@pytest.mark.parametrize(
    ("where", "keys"), [("robots", {"age_s": 1.5}), ("robots", {"q": [0.1]}), ("cells", {"tree": [1]})]
)
def test_ages_positions_and_trees_are_no_changes(before: dict, where: str, keys: dict) -> None:
    assert changed(before, after(before, where, **keys)) == []


@pytest.mark.parametrize(
    ("where", "kind", "key", "value"),
    [
        ("cells", "cell", "state", "held"),
        ("cells", "cell", "queue", ["t-2"]),
        ("robots", "robot", "online", True),
        ("robots", "robot", "latched", True),
        ("robots", "robot", "facts", {"lid": "open"}),
        ("robots", "robot", "answer", "good"),
    ],
)
def test_a_row_that_changed_is_told_alone(
    before: dict, where: str, kind: str, key: str, value: object
) -> None:
    ((told, row),) = changed(before, after(before, where, **{key: value}))
    assert (told, row["name"], row[key]) == (kind, before[where][0]["name"], value)


def test_a_task_in_a_cell_is_told_by_its_id(before: dict) -> None:
    ((_, row),) = changed(before, after(before, "cells", task={"id": "t-1", "elapsed_s": 2.0}))
    assert row["task"] == "t-1"
    running = after(before, "cells", task={"id": "t-1", "elapsed_s": 2.0})
    assert changed(running, after(before, "cells", task={"id": "t-1", "elapsed_s": 3.0})) == []


def test_a_reader_that_does_not_keep_up_is_ended_and_keeps_nothing_more() -> None:
    reader = Reader()
    for number in range(stream.WAITING + 50):
        reader.put(stream.event(str(number), "task", {}).text)
    assert reader.dropped and reader.waiting == stream.WAITING
    assert asyncio.run(reader.next()) is None
