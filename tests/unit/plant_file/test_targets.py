"""Robots among the devices of a cell: their targets, tools and zones in a plant file, and wrong ones."""

from __future__ import annotations

from pathlib import Path

from arboleda.model.messages import Verb
from arboleda.model.plant_model import Interlock

from ...plants import plant_text, read
from ..kinds.lab import Bench

PLANT = plant_text(__file__, "targets")
RECIPES = """\
from arboleda.recipes import Target, recipe, work

@recipe("load")
def load(cell, blank=Target("pallet")):
    loader, jaw, mill, shuttle = cell.devices("loader", "jaw", "mill", "shuttle")
    return work(
        cell.device("ana").ask("Is the mill free?"),
        shuttle.go("feed_2"),
        loader.visit(blank, jaw.close()),
        loader.visit("vise", jaw.open()),
        mill.close(),
        mill.open(),
        shuttle.home(),
    )
"""


def test_robots_have_their_targets_tools_and_zones(tmp_path: Path) -> None:
    (cell,) = read(tmp_path, PLANT, RECIPES).cells
    loader, shuttle = cell.spaces
    assert [pose.name for pose in loader.poses] == ["home", "feed_1", "feed_2", "vise"]
    assert loader.tool is cell.roles["jaw"] and loader.home.name == "home"
    assert [(pose.name, pose.q) for pose in shuttle.poses] == [("home", 0), ("feed_2", 8)]
    assert cell.groups == {"pallet": ("feed_1", "feed_2")}
    assert cell.interlocks == (Interlock(device="mill", zone="inside", free_while=(("door", "open"),)),)
    assert [pose.name for pose in loader.poses if pose.zones] == ["vise"]


def test_what_the_file_describes_works(tmp_path: Path) -> None:
    here = Bench(read(tmp_path, PLANT, RECIPES))
    for blank in ("feed_1", "feed_2"):
        here.submit(f"tending load {blank}")
        here.wait(1.0)
        assert here.operate(Verb.ANSWER, "ana", answer="done") is None
        assert here.outcome().state.value == "done"
    assert here.machines["mill"].facts["door"] == "open"
