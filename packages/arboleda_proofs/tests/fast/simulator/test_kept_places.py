"""People who keep supplies and outputs see to these while a task waits for that."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.plants import read
from tests.unit.kinds.test_places import PLANT, recipe_of

from arboleda_proofs.simulator.faults.kind import Fault
from arboleda_proofs.simulator.people import Attendant
from arboleda_proofs.simulator.run import Simulation
from arboleda_proofs.simulator.shrink import explicit

WAITS = 'mover.home(), cell.wait(5), cell.place("{}").gets_{}(at_most_s=3600)'


@pytest.mark.parametrize(
    ("place", "what", "verb", "sees_to_it"),
    [("bin", "room", "load", True), ("rack_1", "part", "unload", True), ("bin", "room", "load", False)],
    ids=["output", "supply", "nobody"],
)
def test_a_task_gets_what_people_keep(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, place: str, what: str, verb: str, sees_to_it: bool
) -> None:
    if not sees_to_it:
        monkeypatch.setattr(Attendant, "_keep_places", lambda self, cell: None)
    model = read(tmp_path, PLANT, recipe_of(WAITS.format(place, what)))
    faults = [Fault(kind=f"operator_{verb}", at=at, target="lab", word=place) for at in (3.0, 5.5, 8.0)]
    broken = Simulation(model, 1, explicit(faults)).run(cycles=2).broken
    assert (broken is None) is sees_to_it
    assert sees_to_it or broken.invariant == "at_rest_at_end"
