"""A base behind the actions of Nav2, under faults; `tools/driver-faults` runs more seeds."""

from __future__ import annotations

import pytest
from tests.packages import ROOT

from arboleda.kinds.mobile.motion import GridMotion
from arboleda.plant_file.loader import load
from arboleda_driver_faults.nav2 import BASE_CAUSES, RoundRig, WaypointsRig
from arboleda_driver_faults.rig import TASKS, run
from arboleda_drivers.nav2.virtual.machine import FAULTS
from arboleda_drivers.ros_action.goal import Rest

EXAMPLE = load(ROOT / "examples/nav2/plant.yaml")
SEEDS = 2
FEW = 2  # tasks, in which a fault comes by itself


def breaches(seed: int, *names: str, rig: type[RoundRig] = RoundRig, tasks: int = TASKS) -> list[str]:
    return run(rig(EXAMPLE), seed, [f"cart.{name}" for name in names], tasks).breaches


@pytest.mark.sampled(4)
@pytest.mark.parametrize("rig", [RoundRig, WaypointsRig])
@pytest.mark.parametrize("seed", range(SEEDS))
def test_no_false_success_no_hang_and_the_right_cause(seed: int, rig: type[RoundRig]) -> None:
    assert breaches(seed, rig=rig) == []


@pytest.mark.sampled(7)
@pytest.mark.parametrize("fault", ["lie", "early", "short", "stuck", "jump", "unlocalised", "no_odometry"])
def test_faults_by_themselves(fault: str) -> None:
    assert breaches(1, fault, tasks=FEW) == []


def test_waypoints_that_are_missed() -> None:
    assert breaches(1, "missed", rig=WaypointsRig) == []


def test_a_base_that_is_believed_anywhere_would_be_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(GridMotion, "stands_at", lambda self, position, goal: True)
    assert any("false success" in each for seed in range(3) for each in breaches(seed, "lie"))


def test_a_result_that_is_believed_before_rest_would_be_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Rest, "holds", lambda self, now, since=0.0: True)
    monkeypatch.setitem(BASE_CAUSES, "early", set())
    assert any("wrong cause" in each for seed in range(3) for each in breaches(seed, "early"))


def test_every_fault_has_the_reasons_that_it_may_give() -> None:
    assert set(BASE_CAUSES) == set(FAULTS)
