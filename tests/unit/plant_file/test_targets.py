"""Robots among the devices of a cell: their targets, tools and zones in a plant file, and wrong ones."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.model.errors import ConfigError
from arboleda.model.messages import Verb
from arboleda.model.plant_model import Interlock, PlantModel
from arboleda.plant_file import loader

from ...plants import plant_text
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
MISTAKES = {  # id: (text, put in its place, the sentence starts with, and has in it)
    "no target": (
        "shuttle: {node: 8}",
        "shutle: {node: 8}",
        "25:49: ",
        'must be loader or shuttle, is "shutle"',
    ),
    "no such node": ("node: 8", "node: 9", "25:65: ", "must be 0 to 8, is 9"),
    "no home": ("home:   {loader", "start:  {loader", "23:7: ", 'loader needs a target "home"'),
    "outside the limits": ("deg: [60, 10]", "deg: [999, 10]", "24:31: ", "is outside the limits of q1"),
    "no targets at all": ("    targets:", "    tragets:", "22:5: ", 'did you mean "targets"?'),
    "group of what is no target": (
        "[feed_1, feed_2]}",
        "[feed_1, feed]}",
        "27:31: ",
        'is "feed"; did you mean',
    ),
    "group named as a target": ("{pallet:", "{vise:", "27:14: ", "a target has this name already"),
    "tool of nobody": (
        "tool_of: loader",
        "tool_of: lodaer",
        "18:41: ",
        'must be loader or shuttle, is "lodaer"',
    ),
    "tool that holds nothing": (
        "{kind: mill}",
        "{kind: mill, tool_of: loader}",
        "19:38: ",
        "mill holds no part",
    ),
    "arm beside devices": ("    devices:\n", "    arm: {}\n    devices:\n", "16:5: ", "{kind: arm, ...}"),
    "interlock of nobody": (
        "free_while: {mill",
        "free_while: {mil",
        "29:48: ",
        'is "mil"; did you mean "mill"?',
    ),
    "an interlock of what says nothing": (
        "free_while: {mill",
        "free_while: {loader",
        "29:48: ",
        'must be jaw or mill, is "loader"',
    ),
    "fact of an interlock": ("{door: open}}}", "{dor: open}}}", "29:", "did you mean door?"),
    "home in a zone": ("[tending vise]", "[tending home]", "29:20: ", "robots wait there"),
    "no such target in a zone": ("[tending vise]", "[tending vice]", "29:20: ", 'did you mean "vise"?'),
    "poses that look the same": ("deg: [60, 30], mm: 80", "deg: [-60, 10], mm: 80", "29:20: ", "cannot tell"),
}


def read(folder: Path, plant: str = PLANT) -> PlantModel:
    folder.joinpath("recipes.py").write_text(RECIPES, "utf-8")
    file = folder / "plant.yaml"
    file.write_text(plant, "utf-8")
    return loader.load(file)


def test_robots_have_their_targets_tools_and_zones(tmp_path: Path) -> None:
    (cell,) = read(tmp_path).cells
    loader, shuttle = cell.spaces
    assert [pose.name for pose in loader.poses] == ["home", "feed_1", "feed_2", "vise"]
    assert loader.tool is cell.roles["jaw"] and loader.home.name == "home"
    assert [(pose.name, pose.q) for pose in shuttle.poses] == [("home", 0), ("feed_2", 8)]
    assert cell.groups == {"pallet": ("feed_1", "feed_2")}
    assert cell.interlocks == (Interlock(device="mill", zone="inside", free_while=(("door", "open"),)),)
    assert [pose.name for pose in loader.poses if pose.zones] == ["vise"]


def test_what_the_file_describes_works(tmp_path: Path) -> None:
    here = Bench(read(tmp_path))
    for blank in ("feed_1", "feed_2"):
        here.submit(f"tending load {blank}")
        here.wait(1.0)
        assert here.operate(Verb.ANSWER, "ana", answer="done") is None
        assert here.outcome().state.value == "done"
    assert here.machines["mill"].facts["door"] == "open"


@pytest.mark.sampled(6)
@pytest.mark.parametrize("mistake", MISTAKES.values(), ids=MISTAKES)
def test_a_mistake_is_named_with_its_line(tmp_path: Path, mistake: tuple[str, str, str, str]) -> None:
    old, new, start, words = mistake
    assert PLANT.count(old) == 1
    with pytest.raises(ConfigError) as caught:
        read(tmp_path, PLANT.replace(old, new))
    found = [each.removeprefix(f"{tmp_path}/plant.yaml:") for each in caught.value.problems]
    assert [each for each in found if each.startswith(start) and words in each], found
