"""Trees of examples on the page have no English of ours."""

from __future__ import annotations

from importlib import resources
from pathlib import Path

import pytest

from arboleda.dashboard.wording import words
from arboleda.recipes.authoring import CHOOSE, FAIL, FALLBACK, NO_OTHER, PARALLEL, WAIT
from arboleda.recipes.handles import BECOMES, SAYS
from arboleda.recipes.holding import WORK
from arboleda_proofs.testing.sim import Sim

EXAMPLES = resources.files("arboleda") / "examples"


OURS = {str(each()) for each in (CHOOSE, FAIL, FALLBACK, NO_OTHER, PARALLEL, WAIT, SAYS, BECOMES, WORK)}


@pytest.mark.sampled(2)
@pytest.mark.parametrize("example", ["assembly", "lab_bench", "machine_tending"])
def test_the_tree_of_an_example_has_no_english_of_ours(example: str) -> None:
    sim = Sim()
    plant = sim.plant(Path(str(EXAMPLES / example / "plant.yaml")))
    spanish = words("es")
    for cell in plant.cells:
        recipe = cell.recipes[0]
        values = [next(iter(each.words(cell))) for each in recipe.parameters]
        sim.submit(" ".join([cell.name, recipe.name, *values]))
    sim.run(1.0)
    trees = [cell["tree"] for cell in sim.snapshot()["cells"]]
    names = {spanish.say(row["name"]) for tree in trees for row in tree}
    assert len(names) > 10
    assert not names & OURS
    assert not [name for name in names if name.startswith("is ")]
