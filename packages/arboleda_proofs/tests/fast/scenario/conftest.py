from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import pytest
from tests.cells import with_robot

from arboleda.model.plant_model import Evidence
from arboleda.rig import faults
from arboleda.testing import Rig, shipped, slowed
from arboleda_proofs.testing import Witness

NOTHING: Mapping[str, Any] = {}
Stage = Callable[..., tuple[Rig, Witness]]


@pytest.fixture
def stage() -> Stage:
    """A rig of one cell whose robots prove `evidence`, and its witness; `arm`, `cell`: what else these are.

    Its arm moves for 1 s and its effector takes a moment to switch, so that much can happen meanwhile; its
    piece sensor speaks at every level.
    """

    def make(
        evidence: Evidence = Evidence.IDS, arm: Mapping[str, Any] = NOTHING, **cell: Any
    ) -> tuple[Rig, Witness]:
        (only,) = slowed(shipped("sis_a", evidence=evidence), 2).cells
        rig = Rig(replace(shipped("sis_a"), cells=(replace(with_robot(only, "arm", **arm), **cell),)))
        rig.carry = faults.hand(rig, "ra_1", tells_all=evidence is Evidence.IDS)
        rig.wait(0.5)
        return rig, Witness(rig)

    return make
