"""In a cell of storage with places the twin's hands are judged by what its effector was told."""

from __future__ import annotations

from dataclasses import replace

import pytest

from arboleda.model.plant_model import Place, PlantModel
from arboleda.testing import shipped
from arboleda.trees.part_places import Places
from arboleda_proofs.simulator.climate import Climate
from arboleda_proofs.simulator.faults import Fault
from arboleda_proofs.simulator.run import Simulation


def model() -> PlantModel:
    plant = shipped("sis_a")
    places = (Place(target="station_7"), Place(target="station_2", output=True))
    return replace(plant, cells=(replace(plant.cells[0], places=places),))


def none(minute: int) -> list[Fault]:
    return []


@pytest.mark.long
def test_what_is_drawn_holds_with_and_without_faults() -> None:
    assert Simulation(model(), 1, none).run(cycles=4).broken is None
    assert Simulation(model(), 5, Climate.draw(model(), 5, "normal").faults).run(cycles=4).broken is None


@pytest.mark.sampled(2)
@pytest.mark.parametrize("carriers", [{}, {"ra1": False}], ids=["nothing", "never for sure"])
def test_a_part_that_is_drawn_wrongly_is_found(
    monkeypatch: pytest.MonkeyPatch, carriers: dict[str, bool]
) -> None:
    true = Places.carriers.fget
    assert true is not None
    monkeypatch.setattr(Places, "carriers", property(lambda places: carriers if true(places) else {}))
    broken = Simulation(model(), 1, none).run(cycles=4).broken
    assert broken is not None and broken.invariant == "screens_show_what_is"
    assert "the parts of sis_a are drawn at None and in" in broken.sentence
