"""The bugs of the laboratory are found by `check` or by `simulate`; in the laboratory itself nothing is."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.lengths import length, sample

from arboleda.plant_file.loader import load
from arboleda_proofs.simulator.climate import Climate
from arboleda_proofs.simulator.invariants.zones import one_robot_per_zone
from arboleda_proofs.simulator.run import Simulation

from .lab_bug import LabBug
from .lab_bugs import LAB_BUGS, NOT_FOUND
from .planted_lab import sighted, written

FOUND = [bug for bug in LAB_BUGS if bug.about not in NOT_FOUND]
UNSEEN = [bug for bug in LAB_BUGS if bug.about in NOT_FOUND]


@pytest.mark.timeout(3600)  # as a whole it takes minutes
def test_in_the_laboratory_nothing_is_found(tmp_path: Path) -> None:
    assert sighted(written(tmp_path), range(1, length(2, whole=41))) is None


@pytest.mark.parametrize("bug", sample(FOUND, every=9), ids=lambda bug: bug.about[:60])
def test_a_bug_of_the_laboratory_is_found(tmp_path: Path, bug: LabBug) -> None:
    assert sighted(written(tmp_path, bug)) is not None


@pytest.mark.timeout(3600)
@pytest.mark.parametrize("bug", UNSEEN, ids=lambda bug: bug.about[:60])
def test_what_is_said_to_be_found_by_nobody_is_not_found(tmp_path: Path, bug: LabBug) -> None:
    assert sighted(written(tmp_path, bug), range(1, length(2, whole=21))) is None


def test_nobody_is_advised_to_move_the_mover_onto_an_arm(tmp_path: Path) -> None:
    """Its deck is in the way at one end of its way or at the other, as a lift is."""
    model = load(written(tmp_path))
    simulation = Simulation(
        model, 5, Climate.draw(model, 5, "normal").faults, invariants=[one_robot_per_zone]
    )
    assert simulation.run(cycles=4).broken is None


def test_few_bugs_are_not_found() -> None:
    known = {bug.about for bug in LAB_BUGS}
    assert set(NOT_FOUND) < known
    assert len(FOUND) / len(LAB_BUGS) > 55 / 60
    assert len(known) == len(LAB_BUGS)
