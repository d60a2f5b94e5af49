"""The invariants bite: for each one there is a bug that it finds, and that nothing else broke it."""

from __future__ import annotations

from collections import Counter

import pytest

from arboleda_proofs.simulator.invariants.devices import DEVICES
from arboleda_proofs.simulator.invariants.kinds import KINDS
from arboleda_proofs.simulator.invariants.part_places import PLACES
from arboleda_proofs.simulator.run import NO_EXCEPTION

from .mutant import Mutant
from .mutants import MUTANTS
from .planted import PLANTED
from .search import JUDGES, breaks_unplanted, found_at


@pytest.mark.parametrize("mutant", [*MUTANTS, *PLANTED], ids=lambda mutant: mutant.bug[:60])
def test_a_bug_is_found_by_the_invariant_that_it_breaks(mutant: Mutant) -> None:
    seed = found_at(mutant)
    assert seed is not None, f"{mutant.invariant} does not find within 200 seeds: {mutant.bug}"
    assert not breaks_unplanted(mutant, seed), (
        f"{mutant.invariant} breaks at seed {seed} without the bug, too"
    )


def test_every_invariant_has_one_mutant() -> None:
    """Those of devices, kinds and places have theirs in test_general_invariants.py, on a plant of devices."""
    names = Counter(mutant.invariant for mutant in MUTANTS)
    judged = [each.name for each in JUDGES if each not in (*DEVICES, *KINDS, *PLACES)]
    assert names == Counter([*judged, NO_EXCEPTION])
