"""Recipes of one's own in cells of an arm, a mobile robot and a rack, beside those that come with them."""

from __future__ import annotations

from functools import cache
from importlib.resources import files
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from tests.following import follow

from arboleda.model.errors import ConfigError
from arboleda.model.messages import TaskState, Verb
from arboleda.model.plant_model import PlantModel
from arboleda.model.text import parse
from arboleda.plant_file import loader
from arboleda.rig.rig import Rig
from arboleda.sim.arm import ArmBody
from arboleda.testing import shipped
from arboleda.views import forms

RECIPES = """
from arboleda.recipes import Target, parallel, recipe, work


@recipe("sort")
def sort(cell, source=Target("stations"), goal=Target("stations")):
    arm = cell.device("arm")
    return work(arm.visit(source, arm.grip()), arm.visit(goal, arm.let_go()), arm.home())


@recipe("fetch")
def fetch(cell, path=Target("paths"), goal=Target("stations")):
    arm, mobile = cell.devices("arm", "mobile")
    taken = arm.visit("pickup_" + path[1].lower(), arm.grip())
    return work(mobile.go(path), taken, parallel(mobile.home(), arm.visit(goal, arm.let_go())), arm.home())
"""
TAKE = """
from arboleda.recipes import Target, recipe, work


@recipe("take")
def take(cell, goal=Target("stations")):
    arm = cell.device("arm")
    return work(arm.visit("pickup", arm.grip()), arm.visit(goal, arm.let_go()), arm.home())
"""
KIND = """
from arboleda.kinds import Kind, kind, motion


@kind("saw")
def saw():
    return Kind(
        facts={"guard": ["open", "closed"]}, verbs={"open": motion(sets={"guard": "open"}, takes_s=1)}
    )
"""
ENDED = (TaskState.DONE, TaskState.FAILED, TaskState.CANCELLED)


def read(recipes: str, plant: str = "plant.yaml") -> PlantModel:
    """A packaged plant that uses these recipes."""
    with TemporaryDirectory() as made:
        text = files("arboleda").joinpath(f"plants/{plant}").read_text("utf-8")
        Path(made, "plant.yaml").write_text(text.replace("\nname: ", "\nuses: [own.py]\nname: ", 1), "utf-8")
        Path(made, "own.py").write_text(recipes, "utf-8")
        return loader.load(Path(made, "plant.yaml"))


@cache
def own() -> PlantModel:
    return read(RECIPES)


def do(rig: Rig, task: str, seconds: float = 200.0) -> TaskState:
    rig.submit(task)
    assert rig.wait(seconds, lambda: rig.changes[-1].state in ENDED), rig.changes[-1]
    return rig.changes[-1].state


def arm_of(rig: Rig) -> ArmBody:
    body = rig.boards[rig.model.cell("sis_a").roles["arm"].mqtt].body
    assert isinstance(body, ArmBody)
    return body


@pytest.mark.long
def test_they_are_offered_beside_storage_which_stays_what_a_task_means_that_names_none() -> None:
    for cell in own().cells:
        assert [each.name for each in cell.recipes] == ["storage", "palletizing", "sort", "fetch"]
    for text in ("sis_a 0B 7", "sis_b 1C 3 #lot", "ra1 palletizing"):
        assert parse(text, own()) == parse(text, shipped())
    (first, *_) = forms.offers(own())
    assert [row["name"] for row in first["recipes"] if row["default"]] == ["storage"]
    assert {word for row in first["recipes"][2]["parameters"] for word in row["choices"]} == {
        f"station_{number}" for number in range(9)
    }


def test_a_part_is_carried_from_station_to_station() -> None:
    rig = Rig(own())
    assert rig.operate(Verb.LOAD, "sis_a", place="station_1") is None
    assert do(rig, "sis_a sort station_1 station_5") is TaskState.DONE
    arm = own().cell("sis_a").roles["arm"]
    assert arm.motion.stands_at(arm_of(rig).true_place, own().cell("sis_a").reach[arm.name].targets["home"].q)
    counts = rig.plant.cells["sis_a"].context.places.counts
    assert [place for place, parts in counts.items() if parts] == ["station_5"]


def test_the_mobile_robot_drives_to_the_end_of_a_path_and_back_to_where_the_first_one_begins() -> None:
    rig = Rig(own())
    mobile = rig.boards[own().cell("sis_a").roles["mobile"].mqtt].body
    seen = []
    rig.submit("sis_a fetch 1C station_2")
    while rig.changes[-1].state not in ENDED:
        rig.wait(0.1)
        seen.append(mobile.true_place)
    assert rig.changes[-1].state is TaskState.DONE
    assert 8 in seen and mobile.true_place == 0


def test_what_is_held_when_a_task_fails_goes_back_where_it_was_taken() -> None:
    rig = Rig(own())
    rig.submit("sis_a sort station_1 station_5")
    assert rig.wait(60.0, lambda: arm_of(rig).effector and rig.runs("sis_a", "move to station 5"))
    spot = own().cell("sis_a").reach["ra1"].targets["station_1"].q
    assert rig.operate(Verb.CANCEL, "sis_a") is None
    let_go_at: list[object] = []
    while rig.changes[-1].state not in ENDED:
        before = arm_of(rig).effector
        rig.wait(0.05)
        let_go_at += [arm_of(rig).true_place] if before and not arm_of(rig).effector else []
    (place,) = let_go_at
    assert own().robots["ra1"].motion.stands_at(place, own().robots["ra1"].motion.held_at(spot))


def test_storage_after_it_is_carried_out_and_recovered_as_ever() -> None:
    rig = Rig(own())
    assert do(rig, "sis_a sort station_1 station_5") is TaskState.DONE
    plain = Rig(own())
    for each in (rig, plain):
        each.submit("sis_a 0B 7")
    trees = [[node.name for node in each.plant.cells["sis_a"].tree.iterate()] for each in (rig, plain)]  # type: ignore[union-attr]
    assert trees[0] == trees[1]


def test_after_a_stop_the_first_advice_leads_back_to_work() -> None:
    for seconds in (1.0, 4.0, 8.0, 12.0):
        rig = Rig(own())
        rig.submit("sis_a fetch 0B station_2")
        rig.wait(seconds)
        assert rig.operate(Verb.STOP, "sis_a") is None
        rig.wait(1.0)
        follow(rig, "sis_a")
        assert not arm_of(rig).effector
        assert do(rig, "sis_a fetch 0B station_2") is TaskState.DONE


def test_its_ways_take_the_zones_that_they_lead_into() -> None:
    rig = Rig(read(TAKE, "shared.yaml"))
    for cell in ("left", "right"):
        rig.submit(f"{cell} take station_0")
    arms = {cell: rig.model.cell(cell).roles["arm"] for cell in ("left", "right")}
    spots = {cell: rig.model.cell(cell).reach[arm.name].targets["pickup"].q for cell, arm in arms.items()}
    inside = set()
    while len([each for each in rig.changes if each.state in ENDED]) < 2:
        rig.wait(0.05)
        places = {cell: rig.boards[arm.mqtt].body.true_place for cell, arm in arms.items()}
        there = [cell for cell, arm in arms.items() if arm.motion.stands_at(places[cell], spots[cell])]
        inside.add(tuple(there))
        assert [rig.plant.zones.holder("table") for _ in there] == [arms[cell].name for cell in there]
    assert inside == {(), ("left",), ("right",)}
    assert {each.state for each in rig.changes if each.state in ENDED} == {TaskState.DONE}


@pytest.mark.sampled(4)
@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('"arm", "mobile"', '"arm", "mobil"', "did you mean mobile?"),
        ("arm.visit(source, arm", 'arm.visit("station_9", arm', "no target 'station_9'"),
        ("mobile.go(path)", 'mobile.go("pickup")', "no target 'pickup'"),
        ('@recipe("sort")', '@recipe("storage")', "comes with Arboleda"),
    ],
)
def test_a_mistake_is_named_with_its_line(old: str, new: str, words: str) -> None:
    assert old in RECIPES
    with pytest.raises(ConfigError) as refusal:
        read(RECIPES.replace(old, new))
    assert any(words in each and "own.py:" in each for each in refusal.value.problems), refusal.value.problems


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("answer = 42\n", "has neither a recipe nor a kind"),
        (KIND, "brings no recipe, so this has no effect; delete it"),
    ],
)
def test_a_file_that_brings_no_recipe_has_no_effect_there(text: str, words: str) -> None:
    with pytest.raises(ConfigError) as refusal:
        read(text)
    assert any(words in each for each in refusal.value.problems), refusal.value.problems
