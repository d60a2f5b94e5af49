"""Plants whose files are changed while they run and faults happen, judged in every step."""

from __future__ import annotations

import pytest
from tests.lengths import length, sample

from arboleda.core.cell import CellRun
from arboleda.core.revisions import Revisions
from arboleda.model.messages import CellRevised
from arboleda.testing import shipped
from arboleda_proofs.simulator import judged_world
from arboleda_proofs.simulator.climate import Climate
from arboleda_proofs.simulator.judged import judged_by
from arboleda_proofs.simulator.run import Result, Simulation

SEEDS = sample(range(24), 24)
CALM_S = length(60.0, whole=150.0)  # enough for a version


def simulation(seed: int, level: str = "normal") -> Simulation:
    model = shipped("sis_a", "sis_b")
    faults = Climate.draw(model, seed, level).faults
    return Simulation(model, seed, faults, invariants=judged_by(revises=True), revises=True)


def calm(seed: int) -> Result:
    return simulation(seed, "none").run(seconds=CALM_S)


@pytest.mark.long
@pytest.mark.parametrize("seed", SEEDS)
def test_what_is_under_way_ends_with_its_own_and_the_next_begins_with_the_new(seed: int) -> None:
    simulated = simulation(seed)
    result = simulated.run(seconds=150.0)
    assert result.broken is None
    assert len(simulated.world.versions) >= 2 and result.outcomes["done"] > 5
    assert result.checks["cells_take_versions_between_tasks"] > 0


@pytest.mark.long
def test_a_run_without_faults_fails_no_task_and_is_the_same_again() -> None:
    first, again = calm(7), calm(7)
    assert first.broken is None and first.outcomes.keys() <= {"done", "cancelled"}
    assert first.checks["cells_take_versions_between_tasks"] > 0 and first.digest == again.digest


def test_a_cell_that_takes_a_version_in_the_middle_of_a_task_is_found(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(CellRun, "is_between_tasks", True)
    broken = calm(0).broken
    assert broken is not None and broken.invariant == "cells_take_versions_between_tasks"


@pytest.mark.long
def test_a_cell_that_never_takes_one_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(CellRun, "is_between_tasks", False)
    monkeypatch.setattr(judged_world, "REST_S", 60.0)  # nothing comes that would be waited for
    broken = calm(0).broken
    assert broken is not None and broken.invariant == "versions_are_taken"


def test_a_task_of_a_recipe_that_is_gone_is_found_where_it_is_not_ended(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(Revisions, "_without_unfit", lambda self, run, version: [])
    broken = calm(10).broken
    assert broken is not None and "is not a recipe of sis_b" in broken.sentence


def test_versions_are_told_of_only_where_some_are_put_to_work() -> None:
    model = shipped("sis_a")
    world = Simulation(model, 1, Climate.draw(model, 1, "none").faults)
    world.run(seconds=60.0)
    assert not world.world.versions
    assert not any(isinstance(each, CellRevised) for each in world.world.moment.sent)
