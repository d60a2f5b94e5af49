"""Tasks that earlier versions kept, of recipes in Python and of trees beside them, are found alike."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.engine import Plant
from arboleda.model.task import Order
from arboleda.plant_file.loader import load
from arboleda.resume import fingerprint

OVENS = """
name: bakery
uses: [recipes.py, bake.xml]
kinds:
  oven:
    facts: {celsius: number}
    verbs: {heat: {effect: motion, sets: {celsius: 60}}, look: {effect: query, answers: [done, raw]}}
cells:
  bench:
    devices: {oven: {kind: oven}}
"""
RECIPES = """
from arboleda.recipes import recipe, work

@recipe("warm", ends_with={"oven.celsius": 60})
def warm(cell):
    oven = cell.device("oven")
    return work(oven.heat(), oven.becomes(celsius=60, at_most_s=9))
"""
TREE = """<root BTCPP_format="4"><BehaviorTree ID="Bake"><Sequence>
<oven_heat/><oven_becomes celsius="60" at_most_s="9"/><oven_look answer="{seen}"/>
</Sequence></BehaviorTree></root>"""
KEPT = {
    "warm": ("7abfdbb8055dbf86595c3351904199ba", "6e74ba0547cc4ddd00e009436e783ea8"),
    "bake": ("334e9fc44095ca5fcf2c1c5b70bfe794", "d4e5668d36231ef6045a7b8d82e898f4"),
}
"""By recipe the fingerprints of its cell and of its tree; a task of another one could not go on."""


@pytest.mark.parametrize("recipe", KEPT)
def test_a_task_that_an_earlier_version_kept_is_found_alike(tmp_path: Path, recipe: str) -> None:
    for name, text in (("plant.yaml", OVENS), ("recipes.py", RECIPES), ("bake.xml", TREE)):
        (tmp_path / name).write_text(text, "utf-8")
    model, seen = load(tmp_path / "plant.yaml"), fingerprint.Seen()
    context = Plant(model, epoch=0, now=0.0).cells["bench"].context
    declared = next(each for each in context.cell.recipes if each.name == recipe)
    of_cell = fingerprint.of_cell(context.cell, recipe, seen)
    tree = declared.build(Order(text=f"bench {recipe}", cell="bench", recipe=recipe), context)
    assert (of_cell, fingerprint.of_tree(tree, seen, source=declared.source)) == KEPT[recipe]
