"""A part that was put into a station stays there until somebody says that it was taken out."""

from __future__ import annotations

import pytest

from arboleda.model.messages import Fact, TaskState, Verb
from arboleda.testing import Rig, shipped
from arboleda.views import twin_view


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
    return {name: numbers for name, numbers in twin_view.positions(rig.plant)["stored"].items() if numbers}


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


def test_a_station_that_has_a_part_is_not_refused(rig: Rig) -> None:
    carry_out(rig, "sis_a 0B 7", "sis_a 0B 7")
    assert [change.state for change in rig.outcomes().values()] == [TaskState.DONE] * 2
    assert stored(rig) == {"sis_a": [7]}


TAKEN = {
    "sis_a 7": {"sis_a": [2], "sis_b": [8]},
    "SIS_A 2": {"sis_a": [7], "sis_b": [8]},
    "sis_a": {"sis_b": [8]},
    "": {},
}


@pytest.mark.parametrize("scope", TAKEN)
def test_what_was_taken_out_is_forgotten(rig: Rig, scope: str) -> None:
    carry_out(rig, "sis_a 0B 7", "sis_a 1C 2", "sis_b palletizing")
    before = len(rig.to_boards)
    assert rig.operate(Verb.UNLOAD, scope) is None
    assert stored(rig) == TAKEN[scope]
    assert len(rig.to_boards) == before, "nothing moves"
    assert rig.memory.get(Fact.STORED, {}) == {
        name: " ".join(map(str, numbers)) for name, numbers in TAKEN[scope].items()
    }


REFUSED = {
    "sis_a": "no part is known to be in the rack of sis_a",
    "": "no part is known to be in the rack of plant",
    "sis_a 7": "no part is known to be in station 7 of sis_a",
    "sis_a 9": "'9' is not a station of sis_a",
    "nowhere": "'nowhere' is neither a cell nor a robot",
}


@pytest.mark.parametrize("scope", REFUSED)
def test_what_is_not_there_cannot_be_taken_out(rig: Rig, scope: str) -> None:
    refusal = rig.operate(Verb.UNLOAD, scope)
    assert refusal is not None and refusal.startswith(REFUSED[scope])
