"""A task is done only with its part, where the arm's board says whether it has one; else it says so."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from tests.scenario.restarts import restart
from tests.scenario.test_piece_check import CELL, TASKS, ended, lost_part, mute

from arboleda.model.messages import Check, Reason, TaskState, Verb
from arboleda.model.plant_model import Evidence
from arboleda.rig.world import PLANT
from arboleda.testing import Rig
from arboleda_proofs.testing import Witness

Stage = Callable[..., tuple[Rig, Witness]]


def test_a_check_that_is_needed_fails_without_a_sensor(stage: Stage) -> None:
    rig, _ = stage(piece_check=True)
    mute(rig)
    rig.crash("ra_1")
    rig.wait(2.0)
    rig.operate(Verb.HOME, "ra1")
    rig.wait(30.0)
    rig.submit(TASKS["storage"])
    assert ended(rig).reason is Reason.NO_PIECE


def test_where_nothing_is_to_be_checked_a_lost_part_is_not_missed_and_the_task_says_so(stage: Stage) -> None:
    rig, witness = stage(piece_check=False)
    rig.submit(TASKS["storage"])
    lost_part(rig)
    change = ended(rig)
    assert (change.state, change.unchecked) == (TaskState.DONE, (Check.GRIP,))
    assert witness.part["ra1"] == "floor"


@pytest.mark.parametrize("evidence", [Evidence.JOINTS, Evidence.STATE])
def test_a_release_that_a_reboot_cut_off_is_not_told_as_checked(stage: Stage, evidence: Evidence) -> None:
    rig, _ = stage(evidence, arm={"assume_homed": True})
    rig.submit(TASKS["storage"])
    rig.wait_for(CELL, "effector off/switch")
    rig.stall(PLANT, 10.0)
    rig.stop_bridge()
    rig.crash("ra_1")
    rig.wait(1.0)
    restart(rig)
    rig.wait(8.0)
    assert rig.plant.advice(CELL)[0].do is Verb.RETRY
    assert rig.operate(Verb.RETRY, CELL) is None
    change = ended(rig)
    assert (change.state, change.unchecked) == (TaskState.DONE, (Check.RELEASE,))
