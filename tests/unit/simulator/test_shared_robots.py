"""The simulator judges that a robot which cells share is handed on empty and at home."""

from __future__ import annotations

import pytest

from arboleda.simulator.judged import INVARIANTS
from arboleda.simulator.judged_world import BrokenInvariant, JudgedWorld
from arboleda.trees.cell_devices import CellDevices

from ..kinds.test_shared_robots import plant

RULE = "a_shared_device_is_handed_on_empty_at_home"


def two_tasks(text: str = "left carry") -> None:
    watched = JudgedWorld(plant(), invariants=[each for each in INVARIANTS if each.name == RULE])
    watched.world.advance(5.0)
    watched.world.request_task(text)
    watched.world.advance(60.0)
    watched.world.request_task("right carry")
    watched.world.advance(60.0)


def test_it_holds() -> None:
    two_tasks()


def test_it_bites_where_the_robot_is_left_anywhere(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(CellDevices, "is_home", lambda self, device: True)
    with pytest.raises(BrokenInvariant, match=f"{RULE}.*robot is given back, and stands at"):
        two_tasks()


def test_it_bites_where_the_tool_is_left_with_a_part(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(CellDevices, "may_hold", lambda self, device: False)
    with pytest.raises(BrokenInvariant, match=f"{RULE}.*jaw is given back, and holds a part"):
        two_tasks("left keep")
