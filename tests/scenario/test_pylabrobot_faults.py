"""A heated shaker of PyLabRobot under faults; `scripts/driver-faults pylabrobot` runs more seeds."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.dispatch import evidence
from arboleda.drivers.pylabrobot import machine
from arboleda.plant_file.loader import load

from ..lengths import sample

pytestmark = pytest.mark.requires("pylabrobot")

EXAMPLE = load(Path(__file__).parents[2] / "examples/plate_bench/plant.yaml")
SEEDS = 8
FEW = 1  # task, in which a fault comes by itself


def breaches(seed: int, *names: str, side_by_side: bool = False, tasks: int = 4) -> list[str]:
    from arboleda_driver_faults.pylabrobot import ShakerRig
    from arboleda_driver_faults.rig import run

    return run(ShakerRig(EXAMPLE, side_by_side=side_by_side), seed, names, tasks).breaches


@pytest.mark.parametrize("side_by_side", [False, True])
@pytest.mark.parametrize("seed", sample(range(SEEDS), every=4))
def test_no_false_success_no_hang_and_the_right_cause(seed: int, side_by_side: bool) -> None:
    assert breaches(seed, side_by_side=side_by_side) == []


def test_every_fault_by_itself_has_only_the_reasons_that_it_may_give() -> None:
    from arboleda_driver_faults.pylabrobot import CAUSES, FAULTS

    assert set(CAUSES) == set(FAULTS)
    assert [fault for fault in FAULTS if breaches(1, fault, tasks=FEW)] == []


def test_a_call_that_is_done_once_it_was_begun_would_be_found(monkeypatch: pytest.MonkeyPatch) -> None:
    tell = machine.Machine._tell
    monkeypatch.setattr(evidence, "reached", lambda entry, belief: True)
    monkeypatch.setattr(
        machine.Machine,
        "_tell",
        lambda self, now, **ids: tell(self, now, **ids, done=ids.get("accepted", "")),
    )
    assert breaches(1, "slow") != []
