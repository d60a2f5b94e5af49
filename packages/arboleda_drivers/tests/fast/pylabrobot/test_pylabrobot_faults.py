"""A heated shaker of PyLabRobot under faults; `tools/driver-faults pylabrobot` runs more seeds."""

from __future__ import annotations

from contextlib import suppress

import pytest
from tests.lengths import sample
from tests.packages import ROOT

from arboleda.dispatch import evidence
from arboleda.plant_file.loader import load
from arboleda_drivers.pylabrobot.adapter import Bench
from arboleda_drivers.pylabrobot.settings import Call

pytestmark = pytest.mark.requires("pylabrobot")

EXAMPLE = load(ROOT / "examples/plate_bench/bench.yaml")
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


def test_an_exception_that_is_taken_for_a_return_would_be_found(monkeypatch: pytest.MonkeyPatch) -> None:
    one = Bench._one

    async def quiet(bench: Bench, call: Call) -> object:
        with suppress(Exception):
            return await one(bench, call)
        return None

    monkeypatch.setattr(evidence, "reached", lambda entry, belief: True)
    monkeypatch.setattr(Bench, "_one", quiet)
    found = [each for seed in range(6) for each in breaches(seed, "refuses", "unplugged")]
    assert any("false success" in each for each in found)
