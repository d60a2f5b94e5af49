"""A mobile robot whose way comes by a target in a zone, and another one that works there."""

from __future__ import annotations

from pathlib import Path

from arboleda.core.plant import Plant
from arboleda.model.messages import MotionState, OperatorRequest, Report, Verb

from ..plants import plant_text, read

LONELY = plant_text(__file__, "zones_of_mobiles")
THERE_AND_BACK = """
from arboleda.recipes import recipe, work

@recipe("go")
def go(cell):
    one = cell.device("one")
    return work(one.go("far"), one.home())
"""


def test_a_person_who_puts_it_home_gives_back_its_zone_though_nobody_sees_it(tmp_path: Path) -> None:
    plant = Plant(read(tmp_path, LONELY.replace("joints", "state"), THERE_AND_BACK), epoch=7, now=0.0)
    assert plant.zones.request("one", frozenset({"gate"}))
    plant.step(0.1, [Report(at=0.1, robot="one", state=MotionState.STOPPED, epoch=1, plant=7)])
    assert plant.zones.holder("gate") == "one"
    by_hand = OperatorRequest(at=0.2, verb=Verb.HOME, scope="one", by_hand=True)
    plant.step(0.2, [by_hand])
    assert plant.zones.holder("gate") is None
