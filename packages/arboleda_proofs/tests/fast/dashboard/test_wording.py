"""Sentences of a plant under every kind of fault are said in Spanish."""

from __future__ import annotations

from typing import Any

import pytest
from tests.lengths import length

from arboleda.core.plant import Plant
from arboleda.dashboard.wording import words
from arboleda.model.sentence import Sentence
from arboleda_proofs.campaigns.request import Request
from arboleda_proofs.simulator.run import Simulation


@pytest.mark.long
def test_what_a_plant_says_under_every_kind_of_fault_is_said_in_spanish() -> None:
    said: set[Sentence] = set()
    for seed in length((2, 5, 6), whole=range(1, 7)):  # these three say the most
        run(seed, said)
    assert len(said) > 100
    assert [each for each in said if words("es").say(each) == str(each)] == []


def run(seed: int, said: set[Sentence]) -> None:
    """Add what a plant says to people in a simulation."""

    def look(message: Any) -> None:
        told = getattr(message, "sentence", None) or getattr(message, "refusal", None)
        if isinstance(told, Sentence):
            said.add(told)

    setting = Request(cycles=8, faults="many").setting
    with pytest.MonkeyPatch.context() as patch:
        step = Plant.step

        def heard(plant: Plant, now: float, events: Any) -> list[Any]:
            out = step(plant, now, events)
            for message in out:
                look(message)
            return out

        patch.setattr(Plant, "step", heard)
        Simulation(setting.plant(seed), seed, setting.climate(seed).faults, invariants=()).run(cycles=8)
