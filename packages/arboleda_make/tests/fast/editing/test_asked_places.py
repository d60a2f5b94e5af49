"""A place between two cells that share an arm, whose recipes are trees with nodes for its parts."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.plants import read
from tests.unit.kinds.test_asked_places import PLANT, RECIPES

from arboleda.core.plant import Plant
from arboleda.model.errors import ConfigError
from arboleda.plant_check import advance_check
from arboleda.plant_file.loader import load
from arboleda_make.editing import copy_recipe
from arboleda_proofs.simulator.judged_world import JudgedWorld
from arboleda_trees.bt_xml import leaves
from arboleda_trees.commands.nodes import of_plant

CARRY = """
<arm_visit target="{source}"><jaw_close width_mm="30" force_n="20"/></arm_visit>
<arm_visit target="{goal}"><jaw_open/></arm_visit>
<arm_home/>
"""
GIVE = f"""<root BTCPP_format="4"><BehaviorTree ID="Give">
<IfThenElse><place_has_room place="pass"/><Sequence>{CARRY.format(source="in_1", goal="pass")}</Sequence>
<AlwaysSuccess/></IfThenElse></BehaviorTree></root>"""
TAKE = f"""<root BTCPP_format="4"><BehaviorTree ID="Take"><Sequence>
<place_gets_part place="pass" at_most_s="8"/>{CARRY.format(source="pass", goal="out_1")}
</Sequence></BehaviorTree></root>"""


def ends(watched: JudgedWorld) -> list[tuple[str, str]]:
    """States of the tasks, each with the sentence of its failure."""
    tasks = watched.world.plant.intake.tasks.values()
    return [(each.state.value, "" if each.failure is None else str(each.failure.sentence)) for each in tasks]


def plant(folder: Path, give: str = GIVE, take: str = TAKE) -> Path:
    """The plant with its recipes as trees."""
    (folder / "give.xml").write_text(give, "utf-8")
    (folder / "take.xml").write_text(take, "utf-8")
    file = folder / "plant.yaml"
    file.write_text(PLANT.replace("[recipes.py]", "[give.xml, take.xml]"), "utf-8")
    return file


def test_a_tree_waits_for_the_part_that_another_cell_brings(tmp_path: Path) -> None:
    model = load(plant(tmp_path))
    assert advance_check.warnings(model) == ()
    watched = JudgedWorld(model)
    watched.world.request_task("right take")
    watched.world.advance(1.0)
    watched.world.request_task("left give")
    watched.world.advance(12.0)
    assert ends(watched) == [("done", ""), ("done", "")]
    assert watched.truth.places.cells["right"].parts == {"pass": 0, "out_1": 1}


def test_a_wait_for_a_part_that_does_not_come_names_its_place(tmp_path: Path) -> None:
    watched = JudgedWorld(load(plant(tmp_path)))
    watched.world.request_task("right take")
    watched.world.advance(9.0)
    assert ends(watched) == [("failed", "no part came to pass within 8 s")]


@pytest.mark.parametrize(
    ("node", "why"),
    [
        ('<place_has_part place="pass"/>', "no part is at pass"),
        ('<place_has_part place="{where}"/>', "no part is at pass"),
        ('<Inverter><place_has_room place="pass"/></Inverter>', ""),
    ],
)
def test_a_condition_that_is_not_so_fails_the_task(tmp_path: Path, node: str, why: str) -> None:
    first = """<Script code="where := 'pass'"/>"""
    tree = TAKE.replace('<place_gets_part place="pass" at_most_s="8"/>', first + node)
    watched = JudgedWorld(load(plant(tmp_path, take=tree)))
    watched.world.request_task("right take")
    watched.world.advance(1.0)
    ((state, sentence),) = ends(watched)
    assert state == "failed" and sentence.startswith(why)


def test_what_is_no_place_is_refused_with_its_line(tmp_path: Path) -> None:
    with pytest.raises(ConfigError) as refused:
        load(plant(tmp_path, give=GIVE.replace('place="pass"', 'place="in_2"')))
    assert "give.xml:2:" in str(refused.value) and "'in_2'" in str(refused.value)


def test_the_nodes_of_a_plant_have_the_places_of_all_its_cells(tmp_path: Path) -> None:
    file = plant(tmp_path, take=TAKE.replace("<arm", "<loader").replace("</arm", "</loader"))
    left, right = file.read_text("utf-8").split("  right:")
    file.write_text(f"{left}  right:{right.replace('arm: {', 'loader: {')}", "utf-8")
    ports = of_plant(load(file), None)[leaves.HAS_PART].ports or {}
    assert ports["place"].words == ("in_1", "pass", "out_1")


def test_a_recipe_that_asks_for_parts_is_drawn_and_does_the_same(tmp_path: Path) -> None:
    asks = 'return work(cell.place("pass").has_room(), cell.place'
    model = read(tmp_path, PLANT, RECIPES.replace("return work(cell.place", asks))
    cells = Plant(model, epoch=0, now=0.0).cells
    texts = [
        copy_recipe.tree(model, cells[cell].context, recipe, f"{recipe}_2").replace(
            f"{recipe.title()}2", recipe
        )
        for cell, recipe in (("left", "give"), ("right", "take"))
    ]
    drawn = load(plant(tmp_path, *texts))
    assert advance_check.warnings(drawn) == ()
    watched = JudgedWorld(drawn)
    for _ in range(2):
        watched.world.request_task("left give")
        watched.world.advance(8.0)
    watched.world.request_task("right take")
    watched.world.advance(8.0)
    assert ends(watched) == [("done", "")] * 3
    assert watched.truth.places.cells["right"].parts == {"pass": 0, "out_1": 1}
