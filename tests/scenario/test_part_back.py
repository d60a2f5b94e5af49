"""Where an arm takes its part and where it brings it back after a failure."""

from __future__ import annotations

from pathlib import Path

from arboleda.kinds.joints import MoveJoints
from arboleda.model.commands import Switch
from arboleda.model.messages import Verb
from arboleda.model.plant_model import PlantModel
from arboleda.testing import Rig, shipped

from ..plants import plant_text, read
from .restarts import ENDED, crash_without_trail

PLANT = plant_text(__file__, "part_back")
RECIPES = """
from arboleda.recipes import recipe, work

@recipe("fetch")
def fetch(cell):
    arm = cell.device("arm")
    return work(arm.visit("rack", arm.grip()), arm.home(), cell.fail("nobody wants it"))
"""


def test_a_part_is_put_down_at_its_target_by_way_of_its_approach(tmp_path: Path) -> None:
    rig = Rig(read(tmp_path, PLANT, RECIPES))
    rig.wait(5.0)
    rack = rig.model.cell("bay").workspaces["arm"].targets["rack"]
    told: list[object] = []
    rig.watchers.append(lambda: told.extend(_goals(rig)))
    rig.submit("bay fetch")
    assert rig.wait(120.0, until=lambda: any(each.state in ENDED for each in rig.outcomes().values()))
    let_go = told.index("let go")
    assert told[let_go - 2 : let_go + 2] == [rack.above, rack.q, "let go", rack.above]


def _goals(rig: Rig) -> list[object]:
    """Where the arm is sent to in this step, and that it lets go."""
    sent = [each for each in rig.moment.sent if isinstance(each, MoveJoints | Switch)]
    return [each.q if isinstance(each, MoveJoints) else "grip" if each.grips else "let go" for each in sent]


def held_with_a_part(model: PlantModel) -> Rig:
    """sis_a is held while its arm carries a part from exit A to station 7."""
    rig = Rig(model)
    rig.wait(0.5)
    rig.submit("sis_a 0A 7")
    rig.wait_for("sis_a", "main/move to station 7")
    rig.wait(0.3)
    assert rig.operate(Verb.HOLD, "sis_a") is None
    rig.wait(1.0)
    return rig


def test_a_plant_that_starts_anew_brings_a_part_to_where_the_mobile_stands() -> None:
    rig = held_with_a_part(shipped("sis_a"))
    crash_without_trail(rig)
    rig.wait(3.0)
    assert rig.operate(Verb.RETRY, "sis_a") is None
    rig.wait_for("sis_a", "carry back/move to pick-up A")
