"""Looks for a mutant seed by seed, and whether the same seed breaks what is shipped."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from importlib.resources import as_file, files

import pytest

from arboleda.model.plant_model import PlantModel
from arboleda.plant_file import loader
from arboleda_proofs.simulator import judged_world
from arboleda_proofs.simulator.invariants import Invariant
from arboleda_proofs.simulator.invariants.hosts import HOSTS
from arboleda_proofs.simulator.judged import INVARIANTS
from arboleda_proofs.simulator.run import Simulation

from .mutant import Mutant

JUDGES = (*INVARIANTS, *HOSTS)
_whole: dict[tuple[object, ...], str | None] = {}  # many mutants are found in the same weather


@cache
def plants() -> tuple[PlantModel, PlantModel]:
    """Those of even and of odd seeds, as `arboleda simulate` takes them."""
    with as_file(files("arboleda").joinpath("plants/shared.yaml")) as shared:
        return loader.load(shared), loader.load()


def found_at(mutant: Mutant) -> int | None:
    """The first of its seeds at which its invariant, the only one that looks, finds the bug."""
    with pytest.MonkeyPatch.context() as patch:
        mutant.plant(patch)
        seeds = sorted(mutant.seeds, key=lambda seed: seed != mutant.likely)
        return next((seed for seed in seeds if _alone(mutant, seed) == mutant.invariant), None)


def breaks_unplanted(mutant: Mutant, seed: int) -> bool:
    """True if its invariant breaks at that seed without the bug, too."""
    weather = str(mutant.weather), mutant.any_of, mutant.standby
    key = (seed, mutant.cycles, mutant.rest_s, *weather)
    if key not in _whole:
        _whole[key] = _broken(mutant, seed, JUDGES if mutant.standby else INVARIANTS)
    return _whole[key] is not None and _alone(mutant, seed) == mutant.invariant


def _alone(mutant: Mutant, seed: int) -> str | None:
    return _broken(mutant, seed, [each for each in JUDGES if each.name == mutant.invariant])


def _broken(mutant: Mutant, seed: int, invariants: Sequence[Invariant]) -> str | None:
    """The name of the invariant that breaks first."""
    model = plants()[seed % 2]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(judged_world, "REST_S", mutant.rest_s)
        faults = mutant.climate(model, seed).faults
        simulation = Simulation(
            model,
            seed,
            faults,
            invariants=invariants,
            any_of=mutant.any_of,
            standby=mutant.standby,
        )
        broken = simulation.run(cycles=mutant.cycles).broken
    return broken.invariant if broken else None
