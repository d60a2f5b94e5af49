"""Plants with a gantry behind GRBL, Marlin and Moonraker under their faults.

`tools/driver-faults gcode-grbl`, `gcode-marlin` and `gcode-moonraker` run more seeds.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import pytest
from tests.lengths import sample
from tests.packages import ROOT

from arboleda.kinds.joints.motion import JointMotion
from arboleda.plant_file.loader import load
from arboleda_driver_faults.gcode import (
    GRBL_CAUSES,
    MARLIN_CAUSES,
    MOONRAKER_CAUSES,
    GantryRig,
    LimpRig,
    MarlinRig,
    MoonrakerRig,
)
from arboleda_driver_faults.rig import TASKS, Rig, run
from arboleda_drivers.gcode import marlin, moonraker_work
from arboleda_drivers.gcode.grbl_book import Book
from arboleda_drivers.gcode.grbl_lines import Status
from arboleda_drivers.gcode.grbl_work import GrblLook, LastAlarm, Move
from arboleda_drivers.gcode.virtual.faults import GRBL_FAULTS, MARLIN_FAULTS, MOONRAKER_FAULTS

EXAMPLES = ROOT / "examples/gantry"
GRBL = partial(GantryRig, load(EXAMPLES / "bench.yaml"))
LIMP = partial(LimpRig, load(EXAMPLES / "bench.yaml"))
MARLIN = partial(MarlinRig, load(EXAMPLES / "marlin.yaml"))
MOONRAKER = partial(MoonrakerRig, load(EXAMPLES / "moonraker.yaml"))
SEEDS = 8
FEW = 1  # task, in which a fault comes by itself


def breaches(seed: int, *names: str, tasks: int = TASKS, rig: Callable[[], Rig] = GRBL) -> list[str]:
    return run(rig(), seed, names, tasks).breaches


@pytest.mark.sampled(6)
@pytest.mark.parametrize("rig", [GRBL, LIMP, MARLIN, MOONRAKER])
@pytest.mark.parametrize("seed", sample(range(SEEDS), every=4))
def test_no_false_success_no_hang_and_the_right_cause(seed: int, rig: Callable[[], Rig]) -> None:
    assert breaches(seed, rig=rig) == []


@pytest.mark.sampled(6)
@pytest.mark.parametrize("fault", sample(GRBL_FAULTS, every=3))
def test_every_fault_by_itself(fault: str) -> None:
    assert breaches(1, fault, tasks=FEW) == []


@pytest.mark.sampled(6)
@pytest.mark.parametrize("fault", sample(MARLIN_FAULTS, every=3))
def test_every_fault_of_marlin_by_itself(fault: str) -> None:
    assert breaches(1, fault, tasks=FEW, rig=MARLIN) == []


@pytest.mark.sampled(3)
@pytest.mark.parametrize("fault", sample(MOONRAKER_FAULTS, every=3))
def test_every_fault_of_moonraker_by_itself(fault: str) -> None:
    assert breaches(1, fault, tasks=FEW, rig=MOONRAKER) == []


def test_a_machine_that_is_believed_anywhere_would_be_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(JointMotion, "stands_at", lambda self, position, goal: True)
    assert any("false success" in each for seed in range(3) for each in breaches(seed, "lie", "short"))


def test_a_place_that_is_believed_after_a_boot_would_be_found(monkeypatch: pytest.MonkeyPatch) -> None:
    assert [each for seed in range(4) for each in breaches(seed, "boot", rig=LIMP)] == []
    monkeypatch.setattr(Book, "lose", Book.trust)
    assert any("false success" in each for seed in range(4) for each in breaches(seed, "boot", rig=LIMP))


def test_an_ok_that_is_an_end_would_be_found(monkeypatch: pytest.MonkeyPatch) -> None:
    def look(self: Move, now: float, status: Status, alarm: LastAlarm) -> GrblLook:
        return GrblLook(done=now > self.taken_at)

    monkeypatch.setattr(Move, "look", look)
    assert any("wrong cause" in each for each in breaches(3, "late_start", tasks=2))


def test_a_switch_at_an_end_that_is_not_heard_would_be_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(marlin.Marlin, "_take_trouble", lambda self, now, word: None)
    assert any(
        "false success" in each for seed in range(3) for each in breaches(seed, "endstop_hit", rig=MARLIN)
    )


def test_pieces_that_are_sent_twice_would_be_found(monkeypatch: pytest.MonkeyPatch) -> None:
    send = moonraker_work.Requests.script

    def twice(self: moonraker_work.Requests, ask: moonraker_work.Ask, *lines: str) -> None:
        send(self, ask, *lines)
        if ask is moonraker_work.Ask.PIECE:
            send(self, ask, *lines)

    monkeypatch.setattr(moonraker_work.Requests, "script", twice)
    assert any("moves were said" in each for each in breaches(3, "noise", tasks=2, rig=MOONRAKER))


def test_every_fault_has_the_reasons_that_it_may_give() -> None:
    assert set(GRBL_CAUSES) == set(GRBL_FAULTS)
    assert set(MARLIN_CAUSES) == set(MARLIN_FAULTS)
    assert set(MOONRAKER_CAUSES) == set(MOONRAKER_FAULTS)
