"""What is remembered of a view, and what is made anew."""

from __future__ import annotations

from importlib.resources import as_file, files
from typing import Any

import pytest

from arboleda.model.messages import Verb
from arboleda.plant_file.loader import load
from arboleda.testing import Rig, shipped
from arboleda.views import view
from arboleda.views.resting_cells import RestingCells

CELLS = {"sis_a", "sis_b", "sis_c"}


class Screen:
    """A screen that is shown a plant again and again."""

    def __init__(self, rig: Rig) -> None:
        self._rig, self._resting = rig, RestingCells()
        self._shown: dict[str, Any] = {}

    def kept(self) -> set[str]:
        """The cells whose rows are those of the last look."""
        before = self._shown
        return {name for name, row in self.rows().items() if row is before.get(name)}

    def rows(self) -> dict[str, Any]:
        """The rows of the cells, by name; what is shown is as in a view made anew."""
        view_now = view.snapshot(self._rig.plant, self._resting.part)
        assert view_now == view.snapshot(self._rig.plant)
        self._shown = {row["name"]: row for row in view_now["cells"]}
        return self._shown


@pytest.fixture
def rig() -> Rig:
    rig = Rig(shipped())
    rig.wait(2.0)
    return rig


@pytest.fixture
def screen(rig: Rig) -> Screen:
    return Screen(rig)


def test_cells_at_rest_are_remembered_while_their_robots_repeat_themselves(screen: Screen, rig: Rig) -> None:
    assert screen.kept() == set()
    rig.wait(3.0)
    assert screen.kept() == CELLS


def test_a_cell_at_work_is_another_row_in_every_view_and_the_others_are_not(screen: Screen, rig: Rig) -> None:
    screen.kept()
    rig.submit("sis_a 0B 7")
    rig.wait_for("sis_a", "move to pick-up")
    screen.kept()
    rig.wait(0.1)
    assert screen.kept() == CELLS - {"sis_a"}


def test_a_cell_at_work_to_which_nothing_happens_is_shown_with_the_times_of_now(
    screen: Screen, rig: Rig
) -> None:
    rig.submit("sis_a 0B 7")
    rig.wait_for("sis_a", "move to pick-up")
    before = screen.rows()["sis_a"]
    rig.plant.step(rig.plant.now + 0.01, [])
    later = screen.rows()["sis_a"]
    assert later["refused"] is before["refused"]
    assert later["task"]["elapsed_s"] > before["task"]["elapsed_s"]
    assert later["tree"] != before["tree"]


def test_a_robot_that_falls_silent_is_shown_so(screen: Screen, rig: Rig) -> None:
    screen.kept()
    rig.power_off("ra_1")
    rig.wait(10.0)
    assert screen.kept() == CELLS - {"sis_a"}


def test_whatever_people_ask_for_is_shown(screen: Screen, rig: Rig) -> None:
    screen.kept()
    rig.operate(Verb.HOLD, "sis_b")
    assert screen.kept() == set()


def test_cells_that_share_zones_are_made_anew_in_every_view() -> None:
    with as_file(files("arboleda.plants") / "shared.yaml") as path:
        rig = Rig(load(path))
    rig.wait(2.0)
    screen = Screen(rig)
    screen.kept()
    assert all(cell.zone_users for cell in rig.plant.model.cells)
    assert screen.kept() == set()
