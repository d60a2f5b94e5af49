"""The names of steps that a test sees are those of the table in test-your-plant.md."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda_proofs.testing import Sim

PAGE = Path("docs/how-to/test-your-plant.md").read_text("utf-8").split("## The names of steps")[1]
PAGE = PAGE.split("\n## ")[0]
KITTING = ["system start", "visit bay_1", "visit tray_4", "lift down", "visit platform", "lift up", "go home"]


def names(sim: Sim, cell: str, text: str) -> list[str]:
    task, found = sim.submit(text), {}

    def look() -> bool:
        found[sim.cell(cell).step] = None
        return task.ended

    sim.run(until=look)
    return [each for each in found if each is not None]


@pytest.mark.long
def test_a_cell_names_the_step_and_not_what_is_around_it() -> None:
    sim = Sim()
    sim.plant("examples/kitting/plant.yaml")
    assert set(names(sim, "kitting", "kitting kit 1 tray_4")) == set(KITTING)


@pytest.mark.long
def test_a_tree_as_xml_names_its_nodes() -> None:
    sim = Sim()
    sim.plant("examples/own_tree/plant.yaml")
    found = names(sim, "cell", "cell tend slot_1 1001")
    assert {"system start", "mill_run", "move to slot_1", "loader_home"} <= set(found)


@pytest.mark.parametrize(
    "name", ["system start", "visit rack", "go home", "mill_run", "move to slot_1", "ask ana"]
)
def test_the_page_lists_them(name: str) -> None:
    assert f"`{name}`" in PAGE
