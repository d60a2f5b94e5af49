"""After a failure an arm puts its part down where it took it, not from above."""

from __future__ import annotations

from pathlib import Path

from arboleda.kinds.joints import MoveJoints
from arboleda.model.commands import Switch
from arboleda.testing import Rig

from ..plants import plant_text, read
from .restarts import ENDED

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
