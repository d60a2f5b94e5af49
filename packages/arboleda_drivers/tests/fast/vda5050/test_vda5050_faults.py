"""A plant with a vehicle of VDA 5050 under its faults; `tools/driver-faults` runs more seeds."""

from __future__ import annotations

import math

import pytest
from tests.lengths import sample
from tests.packages import ROOT

from arboleda.kinds.mobile.motion import GridMotion
from arboleda.plant_file.loader import load
from arboleda_driver_faults.rig import TASKS, run
from arboleda_driver_faults.vda5050 import CAUSES, AgvRig
from arboleda_drivers.vda5050 import stops
from arboleda_drivers.vda5050.virtual.faults import FAULTS

EXAMPLE = load(ROOT / "examples/agv/plant.yaml")
SEEDS = 8
FEW = 2  # tasks, in which a fault comes by itself
DEAF_AND_REFUSED = 98  # a cancel that is never begun, while an order is refused its update


def breaches(seed: int, *names: str, version: str = "2.1", tasks: int = TASKS) -> list[str]:
    return run(AgvRig(EXAMPLE, version), seed, names, tasks).breaches


@pytest.mark.sampled(7)
@pytest.mark.parametrize("version", ["2.0", "2.1", "3.0"])
@pytest.mark.parametrize("seed", sample(range(SEEDS), every=2))
def test_no_false_success_no_hang_and_the_right_cause(seed: int, version: str) -> None:
    assert breaches(seed, version=version) == []


@pytest.mark.sampled(3)
@pytest.mark.parametrize("fault", sample(FAULTS, every=2))
def test_every_fault_by_itself(fault: str) -> None:
    assert breaches(1, fault, tasks=FEW) == []


def test_a_cancel_that_is_never_begun_is_said_again_until_it_is() -> None:
    assert breaches(DEAF_AND_REFUSED) == []


def test_a_cancel_that_is_said_once_would_be_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stops, "AGAIN_S", math.inf)
    assert any("hang" in each for each in breaches(DEAF_AND_REFUSED))


def test_a_vehicle_that_is_believed_anywhere_would_be_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(GridMotion, "stands_at", lambda self, position, goal: True)
    assert any("false success" in each for seed in range(5) for each in breaches(seed, "lie", "short"))


def test_every_fault_has_the_reasons_that_it_may_give() -> None:
    assert set(CAUSES) == set(FAULTS)
