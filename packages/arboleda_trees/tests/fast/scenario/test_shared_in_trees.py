"""A tree of a file has a shared device from the first step that tells it something, as a recipe in Python."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.plants import plant_text, read
from tests.scenario.restarts import ENDED, restart

from arboleda.model.messages import TaskState, Verb
from arboleda.testing import Rig

PLANT = plant_text(__file__, "shared_in_trees")
ASKS = '<ana_ask question="Ready?" answers="yes" answer="{said}"/>'
UP = "<lift_up/>"
TREES = {
    "sequence": f"<Sequence>{ASKS}<lift_up/><lift_down/></Sequence>",
    "sequence in sequence": f"<Sequence><lamp_light on='true'/><Sequence>{ASKS}{UP}</Sequence></Sequence>",
    "subtree": f'<Sequence>{ASKS}<SubTree ID="Up"/><lift_down/></Sequence>',
    "retry": f"<Sequence>{ASKS}<RetryUntilSuccessful num_attempts='2'>{UP}</RetryUntilSuccessful></Sequence>",
}
HELD = {
    "first": f"<Sequence><lift_up/>{ASKS}<lift_down/></Sequence>",
    "fallback": f"<Fallback><Sequence>{ASKS}<lift_up/></Sequence><lift_down/></Fallback>",
}


def asking(folder: Path, body: str) -> Rig:
    up = '<BehaviorTree ID="Up"><Sequence><lift_up/></Sequence></BehaviorTree>'
    tree = f'<BehaviorTree ID="T">{body}</BehaviorTree>'
    ride = f'<root BTCPP_format="4" main_tree_to_execute="T">{tree}{up}</root>'
    rig = Rig(read(folder, PLANT, beside={"ride.xml": ride}))
    rig.wait(5.0)
    rig.submit("below ride #one")
    assert rig.wait(20.0, until=lambda: rig.plant.dispatcher.ledger.question("ana") is not None)
    return rig


def answered(rig: Rig) -> TaskState:
    for _ in range(20):
        if rig.plant.dispatcher.ledger.question("ana") is not None:
            assert rig.operate(Verb.ANSWER, "ana", answer="yes") is None
        if rig.wait(5.0, until=lambda: rig.outcomes()["one"].state in ENDED):
            break
    return rig.outcomes()["one"].state


@pytest.mark.parametrize("body", TREES.values(), ids=TREES)
def test_it_is_free_while_a_person_is_asked_before(tmp_path: Path, body: str) -> None:
    rig = asking(tmp_path, body)
    assert rig.plant.zones.holder("lift") is None
    assert answered(rig) is TaskState.DONE
    rig.wait(1.0)
    assert rig.plant.zones.holder("lift") is None


@pytest.mark.parametrize("body", HELD.values(), ids=HELD)
def test_it_stays_with_a_tree_that_has_told_it_something_or_may_go_another_way(
    tmp_path: Path, body: str
) -> None:
    rig = asking(tmp_path, body)
    assert rig.plant.zones.holder("lift") == "below"
    assert answered(rig) is TaskState.DONE


def test_a_tree_that_takes_it_late_goes_on_after_a_restart(tmp_path: Path) -> None:
    rig = asking(tmp_path, TREES["sequence"])
    assert rig.operate(Verb.ANSWER, "ana", answer="yes") is None
    rig.wait(1.0)
    assert rig.plant.zones.holder("lift") == "below"
    restart(rig, after_s=1.5)
    rig.wait(8.0)
    assert rig.operate(Verb.RESUME, "below") is None
    assert answered(rig) is TaskState.DONE
