"""What `check` says of devices that cells share, as tasks give them back."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.plant_check import advance_check

from ...plants import plant_text, read

PLANT = plant_text(__file__, "shared_ends")
RECIPES = """
from arboleda.recipes import recipe, work

@recipe("do", ends_with=ENDS)
def do(cell):
    clock, stand = cell.devices("clock", "stand")
    hour = clock.read()
    return BODY
"""
GIVES = "a: do gives stand back with a part in it, and fails there; "
HOLDS = f"{GIVES}write stand.lock(on=False) before"


def checked(folder: Path, body: str, ends: str = "{}") -> tuple[list[str], list[str]]:
    """What is warned of, and what is said of the end."""
    plant = read(folder, PLANT, RECIPES.replace("BODY", body).replace("ENDS", ends))
    warned = [each.split(":1: ")[1] for each in advance_check.warnings(plant)]
    return warned, list(advance_check.ends(plant))


@pytest.mark.parametrize(
    ("body", "ends"),
    [
        ("stand.lock(on=True)", "{}"),
        ("stand.lock(on=True)", "{'stand.locked': True}"),
        ("work(hour, cell.choose(hour, {'day': stand.lock(on=True), 'night': stand.lock(on=False)}))", "{}"),
        ("work(cell.using('stand', stand.lock(on=True)), cell.using('stand', stand.lock(on=False)))", "{}"),
    ],
    ids=["forgotten", "meant", "on one way", "between two times"],
)
def test_a_shared_device_that_is_given_back_with_a_part_is_told(tmp_path: Path, body: str, ends: str) -> None:
    assert checked(tmp_path, body, ends)[0] == [HOLDS]


def test_nothing_is_told_where_it_lets_go_before(tmp_path: Path) -> None:
    assert checked(tmp_path, "work(stand.lock(on=True), hour, stand.lock(on=False))")[0] == []


@pytest.mark.parametrize(
    ("night", "when"),
    [
        ("stand.lift(to='high')", "when stand is given back (it says so)"),
        ("[]", "when stand is given back, by a task that takes it (it says so)"),
    ],
)
def test_the_end_of_a_shared_device_is_that_of_a_task_that_takes_it(
    tmp_path: Path, night: str, when: str
) -> None:
    ways = f"{{'day': stand.lift(to='high'), 'night': {night}}}"
    body = f"work(hour, cell.choose(hour, {ways}))"
    warned, ends = checked(tmp_path, body, "{'stand.at': 'high'}")
    assert (warned, ends) == ([], [f"a: do ends with stand.at high {when}"])
