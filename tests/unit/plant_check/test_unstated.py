"""What `check` offers to state of a plant: where parts lie, who else is in a zone, what work needs."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.model.plant_files import PlantFiles
from arboleda.plant_check import draft_check, unstated
from arboleda.plant_check.mend import edited
from arboleda.plant_check.offers import offers
from arboleda.plant_file import loader

from ...plants import changed, plant_text, read, written

PLANT = plant_text(__file__, "unstated")
RECIPE = """
from arboleda.recipes import recipe, work

@recipe("bake")
def bake(cell):
    loader, jaw, oven = cell.devices("loader", "jaw", "oven")
    take = lambda at: loader.visit(at, jaw.close(width_mm=20, force_n=20))
    put = lambda at: loader.visit(at, jaw.open())
    return work(take("rack"), oven.open(), put("inside"), loader.home(), oven.close(), oven.bake())
"""
KIND = """
from dataclasses import dataclass
from arboleda.kinds import Kind, kind, motion, process

@dataclass(frozen=True)
class Oven: ...

@kind("oven")
def oven(settings: Oven) -> Kind:
    verbs = {
        "open": motion(sets={"door": "open"}),
        "close": motion(sets={"door": "closed"}),
        "bake": process(takes_s=5),
    }
    return Kind(facts={"door": ["closed", "open"]}, verbs=verbs)
"""
OVEN = PLANT[PLANT.index("kinds:") : PLANT.index("cells:")]
OF_PYTHON = changed(PLANT, (OVEN, ""), ("[recipes.py]", "[recipes.py, kinds.py]"))
PLACES = "lab: nothing is known of where parts lie"
GUARD = "lab: nothing is known of who else is in the zone in_the_oven of loader"
NEEDS = "lab: nothing is known of what bake of oven needs"
STATED = (
    PLANT.replace("takes_s: 5", "takes_s: 5, needs: {door: closed}").replace(
        "poses: [lab inside]", "poses: [lab inside], free_while: {oven: {door: open}}"
    )
).replace("zones:", "    places: {rack: {supply: true}, inside: {of: oven}}\nzones:")


def test_nothing_is_offered_where_all_of_it_is_stated(tmp_path: Path) -> None:
    assert unstated.notes(read(tmp_path, STATED, RECIPE)) == ()


def test_work_may_need_nothing(tmp_path: Path) -> None:
    free = PLANT.replace("takes_s: 5", "takes_s: 5, needs: {}")
    assert NEEDS not in unstated.unknowns(read(tmp_path, free, RECIPE))


@pytest.mark.parametrize(("more", "is_known"), [("", False), (", needs={}", True)])
def test_work_of_a_kind_in_python_may_need_nothing(tmp_path: Path, more: str, is_known: bool) -> None:
    kinds = {"kinds.py": KIND.replace("takes_s=5", f"takes_s=5{more}")}
    plant = read(tmp_path, OF_PYTHON, RECIPE, kinds)
    assert (NEEDS not in unstated.unknowns(plant)) is is_known


def test_a_zone_with_two_robots_guards_them(tmp_path: Path) -> None:
    both = changed(
        PLANT,
        ("      oven: {kind: oven}\n", "      oven: {kind: oven}\n      cart: {kind: mobile}\n"),
        ("      rack:", "      gate: {cart: {node: 3}}\n      rack:"),
        ("home: {loader: {deg: [0, 0], mm: 0}}", "home: {loader: {deg: [0, 0], mm: 0}, cart: {node: 0}}"),
        ("[lab inside]", "[lab inside, lab gate]"),
    )
    assert GUARD not in unstated.unknowns(read(tmp_path, both, RECIPE))


@pytest.mark.parametrize("number", range(3))
def test_an_offer_is_edits_of_which_each_alone_states_it(tmp_path: Path, number: int) -> None:
    file = written(tmp_path, PLANT, RECIPE)
    offer = offers(file.name, PLANT, loader.load(file))[number]
    for edit in offer.edits:
        file.write_text(edited({file.name: PLANT}, [edit])[file.name])
        assert offer.sentence not in unstated.unknowns(loader.load(file))


def test_no_edit_is_offered_for_what_is_to_stand_in_another_file(tmp_path: Path) -> None:
    file = written(tmp_path, OF_PYTHON, RECIPE, {"kinds.py": KIND})
    found = offers(file.name, file.read_text(), loader.load(file))
    assert [each.sentence for each in found] == [PLACES, GUARD]
    of_draft = draft_check.check(PlantFiles(plant=file.name, contents={file.name: file.read_bytes()}), file)
    assert [each.unknown for each in of_draft.unstated] == [PLACES, GUARD]
