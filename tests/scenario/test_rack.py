"""A part that was put into a station stays there until somebody says that it was taken out."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from arboleda.model.messages import Fact, TaskState, Verb
from arboleda.testing import Rig, shipped
from arboleda.views import view


@pytest.fixture
def rig() -> Rig:
    rig = Rig(shipped("sis_a", "sis_b"))
    rig.wait(0.5)
    return rig


def carry_out(rig: Rig, *texts: str) -> None:
    for text in texts:
        rig.submit(text)
    assert rig.wait(120.0, until=lambda: len(rig.outcomes()) >= len(texts) and rig.plant.at_rest)
    assert rig.wait(
        120.0, until=lambda: not any(cell.queue or cell.task for cell in rig.plant.cells.values())
    )


def stored(rig: Rig) -> dict[str, list[int]]:
    """The full stations, by cell, of the cells that have some."""
    rows = {cell["name"]: cell["places"] for cell in view.snapshot(rig.plant)["cells"]}
    full = {name: [row["station"] for row in places if row["parts"]] for name, places in rows.items()}
    return {name: numbers for name, numbers in full.items() if numbers}


def test_parts_stay_in_their_stations(rig: Rig) -> None:
    carry_out(rig, "sis_a 0B 7", "sis_a 1C 2", "sis_b palletizing")
    assert stored(rig) == {"sis_a": [2, 7], "sis_b": [8]}


def test_a_part_on_its_way_is_in_no_station(rig: Rig) -> None:
    rig.submit("sis_a 0B 7")
    rig.wait_for("sis_a", "main/move to station 7")
    assert stored(rig) == {}
    rig.operate(Verb.CANCEL, "sis_a")
    assert rig.wait(60.0, until=lambda: rig.plant.at_rest)
    assert stored(rig) == {}, "it went back to the mobile robot"


def test_they_are_known_after_a_restart(rig: Rig) -> None:
    carry_out(rig, "sis_a 0B 7")
    rig.crash()
    rig.wait(3.0)
    assert stored(rig) == {"sis_a": [7]}


def test_a_memory_of_an_earlier_version_has_the_rack_as_it_was(rig: Rig) -> None:
    rig.disk.facts[Fact.STORED] = {"sis_a": "2 7"}
    rig.crash()
    rig.wait(3.0)
    assert stored(rig) == {"sis_a": [2, 7]}
    carry_out(rig, "sis_a 0B 0")
    assert stored(rig) == {"sis_a": [0, 2, 7]}
    assert rig.disk.facts.get(Fact.STORED, {}) == {}, "there is one set of books"
    rig.crash()
    rig.wait(3.0)
    assert stored(rig) == {"sis_a": [0, 2, 7]}


def test_a_person_may_put_a_part_into_a_station(rig: Rig) -> None:
    assert rig.operate(Verb.LOAD, "sis_a", place="station_4") is None
    assert stored(rig) == {"sis_a": [4]}
    assert rig.operate(Verb.UNLOAD, "sis_a", place="station_4") is None
    assert stored(rig) == {}


def test_a_station_that_has_a_part_is_not_refused(rig: Rig) -> None:
    carry_out(rig, "sis_a 0B 7", "sis_a 0B 7")
    assert [change.state for change in rig.outcomes().values()] == [TaskState.DONE] * 2
    assert stored(rig) == {"sis_a": [7]}


TAKEN = [
    ("sis_a", {"station": 7}, {"sis_a": [2], "sis_b": [8]}),
    ("SIS_A", {"station": 2}, {"sis_a": [7], "sis_b": [8]}),
    ("sis_a", {}, {"sis_b": [8]}),
    ("", {}, {}),
]


@pytest.mark.parametrize(("scope", "told", "left"), TAKEN)
def test_what_was_taken_out_is_forgotten(rig: Rig, scope: str, told: dict, left: dict) -> None:
    carry_out(rig, "sis_a 0B 7", "sis_a 1C 2", "sis_b palletizing")
    before = len(rig.to_boards)
    assert rig.operate(Verb.UNLOAD, scope, **told) is None
    assert stored(rig) == left
    assert len(rig.to_boards) == before, "nothing moves"
    kept = {name: " ".join(f"station_{number}=1" for number in numbers) for name, numbers in left.items()}
    assert rig.disk.facts.get(Fact.PARTS, {}) == kept


REFUSED = [
    ("sis_a", {}, "no part is known to be in the rack of sis_a"),
    ("", {}, "no part is known to be in the rack of plant"),
    ("sis_a", {"station": 7}, "no part is known to be in station 7 of sis_a"),
    ("sis_a", {"station": 9}, "'9' is not a station of sis_a"),
    ("sis_a", {"station": "x"}, "'x' is not a station of sis_a"),
    ("sis_a", {"answer": "yes"}, "unload takes no argument 'answer'"),
    ("nowhere", {}, "'nowhere' is neither a cell nor a robot"),
    ("sis_a 7", {}, "'sis_a 7' is neither a cell nor a robot"),
]


@pytest.mark.parametrize(("scope", "told", "sentence"), REFUSED)
def test_what_is_not_there_cannot_be_taken_out(rig: Rig, scope: str, told: dict, sentence: str) -> None:
    refusal = rig.operate(Verb.UNLOAD, scope, **told)
    assert refusal is not None and refusal.startswith(sentence)


def test_of_stations_within_the_tolerance_of_each_other_the_goal_of_the_arm_has_the_part() -> None:
    def wide(robot: Any) -> Any:
        return replace(robot, tolerance=(0.5, 0.5, 0.001)) if robot.name == "ra1" else robot

    plant = shipped("sis_a")
    rig = Rig(replace(plant, cells=(plant.cells[0].with_robots(wide),)))
    rig.wait(0.5)
    carry_out(rig, "sis_a 0B 7")
    assert stored(rig) == {"sis_a": [7]}
