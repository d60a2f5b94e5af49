"""`cell.recover` and TryCatch: what has failed first stays the cause, whatever the rescue comes to."""

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
TREE = '<root BTCPP_format="4"><BehaviorTree ID="T">{body}</BehaviorTree></root>'
UNCLEAR = "no clear reading"
FAILS = f"cell.fail('{UNCLEAR}')"
PLATE = "mover says false of plate; true is needed"
BOTH = f"{UNCLEAR}; and the rescue failed: {PLATE}"


def written(folder: Path, *, python: str = "mover.put_away()", xml: str = "<mover_put_away/>") -> Rig:
    rig = Rig(read(folder, PLANT, RECIPES.format(body=python), beside={"tree.xml": TREE.format(body=xml)}))
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


CHECK = '<reader_says lid="closed"/>'
NOT_CLOSED = "reader says open of lid; closed is needed"
XML_BOTH = f"{NOT_CLOSED}; and the rescue failed: {PLATE}"
TRY = f"<TryCatch>{CHECK}<mover_put_away/></TryCatch>"


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    ("body", "why", "commands"),
    [
        (f"<TryCatch><mover_take_out/>{CHECK}</TryCatch>", "", ["mover take_out"]),
        (TRY, NOT_CLOSED, ["mover put_away"]),
        (f'<TryCatch>{CHECK}<mover_says plate="true"/></TryCatch>', XML_BOTH, []),
        ('<TryCatch name="try"><AlwaysFailure/><mover_says plate="true"/></TryCatch>',
         f"the tree try has failed; and the rescue failed: {PLATE}", []),
        (f'<TryCatch>{CHECK}<Fallback><mover_says plate="true"/><mover_put_away/></Fallback></TryCatch>',
         NOT_CLOSED, ["mover put_away"]),
        (f"<Fallback>{TRY}<reader_open/></Fallback>", "", ["mover put_away", "reader open"]),
        (f"<TryCatch>{TRY}<mover_take_out/></TryCatch>", NOT_CLOSED, ["mover put_away", "mover take_out"]),
        (f'<TryCatch>{CHECK}<ScriptCondition code="1 / 0 == 1"/></TryCatch>',
         f"{NOT_CLOSED}; and the rescue failed: a division by zero", []),
        (f'<Timeout msec="1000">{TRY}</Timeout>', NOT_CLOSED, ["mover put_away"]),
    ],
)  # fmt: skip
def test_the_first_cause_stays_in_a_tree_as_xml(
    tmp_path: Path, body: str, why: str, commands: list[str]
) -> None:
    rig = written(tmp_path, xml=body)
    outcome = run(rig, "tree")
    assert str(outcome.sentence or "") == why
    assert told(rig) == commands


@pytest.mark.parametrize("recipe", ["assay", "tree"])
def test_the_first_cause_outlives_the_plant(tmp_path: Path, recipe: str) -> None:
    rig = written(tmp_path, python=RESCUE, xml=TRY)
    rig.submit(f"bench {recipe} #one")
    rig.wait(2.0)
    assert told(rig) == ["mover put_away"]
    restart(rig, after_s=0.5)
    rig.wait(1.0)
    assert rig.operate(Verb.RESUME, "bench") is None
    assert str(ended(rig).sentence) == (UNCLEAR if recipe == "assay" else NOT_CLOSED)


def test_the_step_of_a_rescue_is_named(tmp_path: Path) -> None:
    rig = written(tmp_path, python=RESCUE)
    rig.submit("bench assay #one")
    rig.wait(1.0)
    assert str(step_of(rig.plant.cells["bench"].tree)) == "mover put_away"


@pytest.mark.parametrize("recipe", ["assay", "tree"])
def test_nothing_is_rescued_after_a_stop(tmp_path: Path, recipe: str) -> None:
    python = "cell.recover(mover.put_away(), mover.take_out())"
    rig = written(tmp_path, python=python, xml="<TryCatch><mover_put_away/><mover_take_out/></TryCatch>")
    rig.submit(f"bench {recipe} #one")
    rig.wait(2.0)
    assert rig.operate(Verb.STOP, "bench") is None
    assert ended(rig).reason is Reason.STOPPED
    assert told(rig)[0] == "mover put_away" and "mover take_out" not in told(rig)


def test_a_failure_that_the_tree_asks_for_keeps_its_words_while_the_rescue_takes_its_time(
    tmp_path: Path,
) -> None:
    body = '<TryCatch><AlwaysFailure name="it says 2"/><Sleep msec="300"/></TryCatch>'
    rig = written(tmp_path, xml=body)
    outcome = run(rig, "tree")
    assert outcome.state is TaskState.FAILED
    assert str(rig.plant.intake.tasks[outcome.task].failed_step) == "it says 2"
