"""What a task was made of, and what is kept of it, as it is read again."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import pytest
from tests.cells import with_poses, with_robot

from arboleda.model.messages import Fact
from arboleda.model.plant_model import Cell
from arboleda.resume import fingerprint
from arboleda.resume.trail import Trail
from arboleda.testing import Rig, shipped
from arboleda.trees import steps
from arboleda.trees.leaves import Unless

MADE_BY_CODE = "ae0d51165bde685fa42ee56dc501189c"


def of(holds: Callable[[], bool], name: str = "a") -> str:
    return fingerprint.of_tree(steps.sequence("work", Unless(name, holds)), {})


def waits(seconds: float) -> Callable[[], bool]:
    return lambda: seconds > 0


def later(at: Any) -> bool:
    return bool(at)


def test_a_tree_made_again_is_the_same() -> None:
    assert of(waits(1.0)) == of(waits(1.0))
    assert of(partial(later, (1, {"a": [2.0]}))) == of(partial(later, (1, {"a": [2.0]})))
    assert of(partial(later, frozenset({"b", "a"}))) == of(partial(later, frozenset({"a", "b"})))


@pytest.mark.parametrize(
    "other",
    [of(waits(2.0)), of(waits(1.0), "b"), of(lambda: True), of(partial(later, 1.0)), of(partial(later, 2.0))],
)
def test_what_a_step_has_taken_in_makes_another_tree(other: str) -> None:
    assert other != of(waits(1.0))


def test_what_is_in_a_set_counts() -> None:
    assert of(partial(later, frozenset({"a"}))) != of(partial(later, frozenset({"b"})))


def test_a_number_that_is_written_in_a_function_counts() -> None:
    assert of(lambda: later(1.0)) != of(lambda: later(2.0))


def test_what_a_cell_is_made_of_counts_and_what_only_its_queue_needs_does_not() -> None:
    cell = shipped("sis_a").cells[0]

    def storage(cell: Cell) -> str:
        return fingerprint.of_cell(cell, "storage", {})

    same, home = storage(cell), cell.reach["ra1"].home
    assert storage(replace(cell, queue_limit=99, goes_on=True)) == same
    assert storage(with_robot(cell, "arm", timeout_s=77.0)) != same
    assert storage(with_poses(cell, home=replace(home, q=(0.1, 0.1, 0.0)))) != same
    assert fingerprint.of_cell(cell, "palletizing", {}) != same


def test_a_step_that_has_taken_in_its_cell_does_not_count_its_queue_either() -> None:
    def named(cell: Cell) -> str:
        return of(lambda: cell.name != "")

    (cell,) = shipped("sis_a").cells
    assert named(cell) == named(replace(cell, queue_limit=7, goes_on=True))
    assert named(cell) != named(replace(cell, name="other"))


def test_the_source_of_a_recipe_stands_for_its_functions() -> None:
    def source(holds: Callable[[], bool], source: str) -> str:
        return fingerprint.of_tree(steps.sequence("work", Unless("a", holds)), {}, source=source)

    written_so, written_otherwise = (lambda: later(1.0)), (lambda: later(2.0))
    assert source(written_so, "one") == source(written_otherwise, "one")
    assert source(written_so, "one") != source(written_so, "another")
    assert source(waits(1.0), "one") != source(waits(2.0), "one")  # what it has taken in still counts


def test_a_version_that_hashed_code_is_still_understood() -> None:
    """The words of a value have not changed; of functions it had those of the interpreter."""
    cell = shipped("sis_a").cells[0]
    assert fingerprint.of_cell(replace(cell, recipes=()), "storage", {}, by_code=True) == MADE_BY_CODE


@pytest.fixture
def kept() -> str:
    """What is kept of a task whose mobile robot is on its way."""
    rig = Rig(shipped("sis_a"))
    rig.wait(1.0)
    task = rig.submit("sis_a 0B 7").task
    rig.wait_for("sis_a", "drive path 0B")
    return str(rig.disk.facts[Fact.STEP][task])


def test_it_is_read_as_it_was_written(kept: str) -> None:
    assert Trail.read(kept).text() == kept


def test_what_another_version_kept_is_refused(kept: str) -> None:
    (version, *made), now = json.loads(kept)
    with pytest.raises(ValueError, match="another version"):
        Trail.read(json.dumps([[version + 1, *made], now]))


def test_what_is_damaged_is_refused(kept: str) -> None:
    begun, now = json.loads(kept)
    with pytest.raises(ValueError, match="damaged"):
        Trail.read(json.dumps([begun[:-2], now]))
