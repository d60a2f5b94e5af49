"""`cell.recover`: what has failed first stays the cause, whatever the rescue comes to."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from arboleda.model.commands import Switch, Work
from arboleda.model.messages import Reason, TaskState, Verb
from arboleda.testing import Rig
from arboleda.trees.tree_run import step_of

from ..plants import plant_text, read
from .restarts import ENDED, restart

PLANT = plant_text(__file__, "recover")
RECIPES = """
from arboleda.recipes import parallel, recipe, work

@recipe("assay")
def assay(cell):
    mover, reader = cell.devices("mover", "reader")
    return {body}
"""
UNCLEAR = "no clear reading"
FAILS = f"cell.fail('{UNCLEAR}')"
PLATE = "mover says false of plate; true is needed"
BOTH = f"{UNCLEAR}; and the rescue failed: {PLATE}"


def written(folder: Path, *, python: str) -> Rig:
    rig = Rig(read(folder, PLANT, RECIPES.format(body=python)))
    rig.wait(5.0)
    return rig


def ended(rig: Rig) -> Any:
    assert rig.wait(60.0, until=lambda: rig.outcomes()["one"].state in ENDED)
    return rig.outcomes()["one"]


def run(rig: Rig, recipe: str = "assay") -> Any:
    rig.submit(f"bench {recipe} #one")
    return ended(rig)


def told(rig: Rig) -> list[str]:
    return [f"{each.robot} {each.verb}" for each in rig.sent if isinstance(each, Work | Switch)]


RESCUE = f"cell.recover({FAILS}, mover.put_away())"


@pytest.mark.sampled(4)
@pytest.mark.parametrize(
    ("body", "why", "commands"),
    [
        (f"cell.recover(mover.take_out(), {FAILS})", "", ["mover take_out"]),
        (RESCUE, UNCLEAR, ["mover put_away"]),
        (f"cell.recover([reader.open(), {FAILS}], [mover.put_away()])", UNCLEAR,
         ["reader open", "mover put_away"]),
        (f"cell.recover({FAILS}, mover.says(plate=True))", BOTH, []),
        (f"cell.recover({FAILS}, work(mover.says(plate=True), mover.put_away()))", BOTH, []),
        (f"work({RESCUE}, reader.open())", UNCLEAR, ["mover put_away"]),
        (f"cell.recover({FAILS}, cell.fallback(mover.says(plate=True), mover.put_away()))", UNCLEAR,
         ["mover put_away"]),
        (f"cell.recover({FAILS}, cell.retry(mover.says(plate=True), times=2, pause_s=0.1))", BOTH, []),
        (f"cell.recover({RESCUE}, mover.take_out())", UNCLEAR, ["mover put_away", "mover take_out"]),
        (f"cell.fallback({RESCUE}, reader.open())", "", ["mover put_away", "reader open"]),
        (f"cell.retry({RESCUE}, times=1, pause_s=0.1)", UNCLEAR, ["mover put_away", "mover put_away"]),
        (f"cell.timeout({RESCUE}, 1.0)", UNCLEAR, ["mover put_away"]),
        (f"parallel({RESCUE}, work(cell.wait(1.0), reader.says(lid='closed')))", UNCLEAR, ["mover put_away"]),
    ],
)  # fmt: skip
def test_the_first_cause_stays_in_a_recipe(tmp_path: Path, body: str, why: str, commands: list[str]) -> None:
    rig = written(tmp_path, python=body)
    outcome = run(rig)
    assert str(outcome.sentence or "") == why
    assert outcome.state is (TaskState.FAILED if why else TaskState.DONE)
    assert told(rig) == commands


def test_the_first_cause_outlives_the_plant(tmp_path: Path) -> None:
    outlives_the_plant(written(tmp_path, python=RESCUE), "assay", UNCLEAR)


def outlives_the_plant(rig: Rig, recipe: str, cause: str) -> None:
    """The first cause of a task is still told when the plant was started anew during its rescue."""
    rig.submit(f"bench {recipe} #one")
    rig.wait(2.0)
    assert told(rig) == ["mover put_away"]
    restart(rig, after_s=0.5)
    rig.wait(1.0)
    assert rig.operate(Verb.RESUME, "bench") is None
    assert str(ended(rig).sentence) == cause


def test_the_step_of_a_rescue_is_named(tmp_path: Path) -> None:
    rig = written(tmp_path, python=RESCUE)
    rig.submit("bench assay #one")
    rig.wait(1.0)
    assert str(step_of(rig.plant.cells["bench"].tree)) == "mover put_away"


def test_nothing_is_rescued_after_a_stop(tmp_path: Path) -> None:
    rig = written(tmp_path, python="cell.recover(mover.put_away(), mover.take_out())")
    not_rescued_after_a_stop(rig, "assay")


def not_rescued_after_a_stop(rig: Rig, recipe: str) -> None:
    """The rescue of a task that puts something away does not begin after a stop."""
    rig.submit(f"bench {recipe} #one")
    rig.wait(2.0)
    assert rig.operate(Verb.STOP, "bench") is None
    assert ended(rig).reason is Reason.STOPPED
    assert told(rig)[0] == "mover put_away" and "mover take_out" not in told(rig)
