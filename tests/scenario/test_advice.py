"""The advice: from whatever state a cell is in, its first line leads on, until the cell works again."""

from __future__ import annotations

from typing import Any

import pytest

from arboleda.model.commands import Stop, StopMode
from arboleda.model.messages import TaskState, Verb
from arboleda.model.plant_model import Evidence
from arboleda.rig.world import BRIDGE
from arboleda.testing import Rig, shipped, slowed
from arboleda.wire.hop import FromPlant

from ..following import advised, follow

TASK = "sis_a 0B 7"
levels = pytest.mark.parametrize("evidence", list(Evidence))


def cell(rig: Rig, name: str = "sis_a") -> Any:
    return rig.plant.cells[name]


def at(rig: Rig, leaf: str) -> None:
    rig.submit(TASK)
    rig.wait_for("sis_a", leaf)
    rig.wait(0.5)


def stop(rig: Rig) -> None:
    at(rig, "move to station 7")
    rig.operate(Verb.STOP)


def stopped_at_its_bridge(evidence: Evidence) -> Rig:
    """A cell of robots without a stop; somebody stopped the arm, and its next move was refused for that."""
    rig = Rig(shipped("sis_a", evidence=evidence, has_stop=False))
    rig.wait(0.5)
    stop = Stop(id="", robot="ra1", mode=StopMode.LATCH)
    rig.broker.clients[BRIDGE].inbox.append(FromPlant(at=rig.now, message=stop, sender="/stranger"))
    rig.wait(0.5)
    rig.submit("sis_a palletizing")
    assert rig.wait(60.0, until=lambda: cell(rig).task is None)
    assert str(rig.changes[-1].sentence) == "ra1: refused the command for moving to home (paro)"
    return rig


@levels
def test_a_robot_that_cannot_say_that_it_is_stopped_is_stopped_and_cleared_too(evidence: Evidence) -> None:
    rig = stopped_at_its_bridge(evidence)
    assert str(rig.plant.dispatcher.obstacles.of("ra1").sentence) == "ra1 is stopped (latched)"
    assert advised(rig, "sis_a") == ["stop sis_a", "clear sis_a", "reset sis_a"]
    assert follow(rig, "sis_a") == ["stop sis_a", "clear sis_a", "reset sis_a", "resume sis_a"]
    rig.submit("sis_a palletizing")
    assert rig.wait(60.0, until=lambda: rig.changes[-1].state is TaskState.DONE)


def test_a_bridge_that_restarted_has_forgotten_the_stop_of_a_robot_without_one() -> None:
    rig = stopped_at_its_bridge(Evidence.IDS)
    rig.crash(BRIDGE)
    rig.wait(2.0)
    assert rig.plant.dispatcher.obstacles.of("ra1") is None
    assert advised(rig, "sis_a")[0] == "retry sis_a"


def test_a_robot_that_has_a_routine_and_says_that_it_is_not_homed_runs_it() -> None:
    rig = Rig(slowed(shipped("sis_a", assume_homed=True), 8))
    rig.wait(0.5)
    assert rig.operate(Verb.HOME, "ra1", by_hand=True) is None
    rig.crash("ra_1")
    rig.wait(1.0)
    assert advised(rig, "sis_a") == ["home ra1 --by-hand"]
    rig.boards["ra_1"].homed = False
    rig.wait(1.0)
    assert advised(rig, "sis_a") == ["home ra1"]
    assert "home ra1 runs its routine" in str(rig.operate(Verb.HOME, "ra1", by_hand=True))
