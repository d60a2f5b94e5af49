"""Pairs of faults in one run: which there are, in which order, and what is said of the share that was run."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from arboleda.campaigns.plants import Plant
from arboleda.campaigns.proof.calm import calm_run
from arboleda.campaigns.proof.forks import CAN_FORK, run_groups
from arboleda.campaigns.proof.pairs import PairProof
from arboleda.campaigns.proof.proof import Proof
from arboleda.campaigns.proof.scenario import scenarios
from arboleda.plant_file import loader

from ..unit.campaigns.test_prove import GOOD, PLANT


@pytest.fixture
def plant(tmp_path: Path) -> Path:
    (tmp_path / "small.yaml").write_text(PLANT)
    (tmp_path / "small.py").write_text(GOOD)
    return tmp_path / "small.yaml"


def pairs_of(plant: Path, *kinds: str) -> PairProof:
    model = Plant(declared=loader.load(plant)).model
    return PairProof(proof=Proof(model=model, calm=(calm_run(model, next(scenarios(model))),), kinds=kinds))


def portions(pairs: PairProof) -> Iterator[int]:
    """The portions in which there is something."""
    return (number for number in pairs.numbers() if pairs.count(number))


@pytest.mark.skipif(not CAN_FORK, reason="this system cannot fork")
def test_pairs_do_the_same_in_forks_as_from_the_beginning(plant: Path) -> None:
    pairs = pairs_of(plant, "partition", "refuses")
    first = next(portions(pairs))
    model, calm, both = pairs.proof.model, pairs.proof.calm[0], pairs.pairs(first)[:4]
    forked = run_groups(model, calm, both, lambda: None, forks=True)
    assert both and forked == run_groups(model, calm, both, lambda: None, forks=False)
