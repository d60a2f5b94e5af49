"""TryCatch: what has failed first stays the cause, whatever the rescue comes to."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.plants import read
from tests.scenario.test_recover import PLANT, PLATE, not_rescued_after_a_stop, outlives_the_plant, run, told

from arboleda.model.messages import TaskState
from arboleda.testing import Rig

TREE = '<root BTCPP_format="4"><BehaviorTree ID="T">{body}</BehaviorTree></root>'


def written(folder: Path, *, xml: str) -> Rig:
    plant = PLANT.replace("recipes.py", "tree.xml")
    rig = Rig(read(folder, plant, beside={"tree.xml": TREE.format(body=xml)}))
    rig.wait(5.0)
    return rig


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


def test_the_first_cause_outlives_the_plant(tmp_path: Path) -> None:
    outlives_the_plant(written(tmp_path, xml=TRY), "tree", NOT_CLOSED)


def test_nothing_is_rescued_after_a_stop(tmp_path: Path) -> None:
    rig = written(tmp_path, xml="<TryCatch><mover_put_away/><mover_take_out/></TryCatch>")
    not_rescued_after_a_stop(rig, "tree")


def test_a_failure_that_the_tree_asks_for_keeps_its_words_while_the_rescue_takes_its_time(
    tmp_path: Path,
) -> None:
    body = '<TryCatch><AlwaysFailure name="it says 2"/><Sleep msec="300"/></TryCatch>'
    rig = written(tmp_path, xml=body)
    outcome = run(rig, "tree")
    assert outcome.state is TaskState.FAILED
    assert str(rig.plant.intake.tasks[outcome.task].failed_step) == "it says 2"
