"""What the simulator found: each bug with the seed and the few faults that showed it."""

from __future__ import annotations

from dataclasses import replace

import pytest

from arboleda.dispatch.ledger import State
from arboleda.kinds.arm import SetEffector
from arboleda.kinds.mobile import FollowPath
from arboleda.model.cell_states import CellState
from arboleda.model.commands import Home
from arboleda.model.messages import Journal, TaskState, Verb
from arboleda.model.plant_model import Evidence, PlantModel, Retry
from arboleda.rig import faults
from arboleda.sim.arm import ArmBody
from arboleda.sim.freshness import Freshness
from arboleda.testing import Rig, shipped
from arboleda.testing.storage_layout import StorageLayout
from arboleda.wire.hop import FromPlant

from ..cells import with_poses


@pytest.fixture
def rig() -> Rig:
    """The shipped sis_a, up and heard."""
    rig = Rig(shipped("sis_a"))
    rig.wait(0.5)
    return rig


@pytest.fixture
def boards_that_know_no_visto(monkeypatch: pytest.MonkeyPatch) -> None:
    """Older ones pass over it, and take commands that waited."""
    monkeypatch.setattr(Freshness, "covers", lambda self, now_us, number: True)


def cut(rig: Rig, board: str) -> None:
    """The board goes on, and nobody hears it or is heard by it."""
    rig.lost = lambda publication: publication.topic.startswith(f"{board}/")
    rig.wait(2.0)


def mend(rig: Rig) -> None:
    rig.lost = lambda publication: False
    rig.wait(2.0)


def sent(rig: Rig, kind: type) -> list[object]:
    return [message for message in rig.sent if isinstance(message, kind)]


def test_a_stop_cleared_while_the_board_was_away_is_cleared_when_it_is_back(rig: Rig) -> None:
    assert rig.operate(Verb.STOP, "sis_a") is None
    cut(rig, "ra_1")
    assert rig.operate(Verb.CLEAR, "sis_a") is None
    mend(rig)
    assert not rig.boards["ra_1"].latched
    assert rig.operate(Verb.RESET, "sis_a") is None
    assert rig.operate(Verb.RESUME, "sis_a") is None
    task = rig.submit("sis_a 0B 7").task
    rig.wait(60.0, until=lambda: rig.outcomes()[task].state is TaskState.DONE)
    assert rig.outcomes()[task].state is TaskState.DONE


def test_an_arm_that_is_stopped_and_offline_is_not_told_to_open_its_effector(rig: Rig) -> None:
    assert rig.operate(Verb.STOP, "sis_a") is None
    cut(rig, "ra_1")
    assert "offline" in str(rig.operate(Verb.RELEASE, "ra1"))
    assert sent(rig, SetEffector) == []


def test_release_of_the_plant_leaves_out_an_arm_that_cannot(rig: Rig) -> None:
    rig = Rig(shipped("sis_a", "sis_b"))
    rig.wait(0.5)
    cut(rig, "ra_2")
    assert rig.operate(Verb.RELEASE) is None
    assert [command.robot for command in sent(rig, SetEffector)] == ["ra1"]  # type: ignore[attr-defined]
    assert [each.verb for each in sent(rig, Journal) if each.outcome is None] == [Verb.RELEASE]  # type: ignore[attr-defined]


@pytest.mark.parametrize("wrong", ["faulted", "stopped by others"])
def test_a_robot_that_is_not_homed_and_worse_is_not_homed(rig: Rig, wrong: str) -> None:
    rig.crash("ra_1")
    rig.wait(0.5)
    if wrong == "faulted":
        rig.boards["ra_1"].fail(round(rig.now * 1e6))
    else:
        rig.boards["ra_1"].latched = True
    rig.wait(0.5)
    assert rig.operate(Verb.HOME, "ra1") is not None
    assert sent(rig, Home) == []


def test_home_at_start_waits_for_the_reset_of_an_earlier_stop() -> None:
    model = shipped("sis_a", home_at_start=True)
    rig = Rig(model)
    rig.wait(5.0)
    assert rig.operate(Verb.STOP, "sis_a") is None
    rig.crash("ra_1")
    rig.wait(1.0)
    assert rig.operate(Verb.CLEAR, "sis_a") is None
    rig.crash()
    rig.wait(1.0)
    assert sent(rig, Home) == []
    assert rig.operate(Verb.RESET, "sis_a") is None
    rig.wait(5.0)
    assert [command.robot for command in sent(rig, Home)] == ["ra1"]  # type: ignore[attr-defined]


def test_cancel_of_a_held_recovery_lets_time_go_on(rig: Rig) -> None:
    rig.submit("sis_a 0B 7")
    rig.wait(0.5)
    rig.lost = lambda publication: publication.topic.startswith("ra_1/")
    rig.wait(1.8)
    assert rig.operate(Verb.CANCEL, "sis_a") is None
    rig.wait(0.5)
    assert rig.operate(Verb.HOLD, "sis_a") is None
    rig.wait(1.0)
    assert rig.operate(Verb.CANCEL, "sis_a") is None
    rig.wait(30.0)
    assert rig.plant.cells["sis_a"].state is CellState.HELD, "the arm is still away"


def test_a_stop_does_not_give_a_halted_move_more_time(rig: Rig) -> None:
    rig.submit("sis_a 0B 7")
    rig.wait(0.5)
    rig.lost = faults.from_board("rm_sis_a")
    assert rig.operate(Verb.HOLD, "sis_a") is None
    rig.wait(0.3)
    (entry,) = rig.plant.dispatcher.ledger.entries.values()
    before = entry.deadline
    assert rig.operate(Verb.STOP, "ra1") is None
    assert entry.deadline == before


def test_a_held_step_does_not_go_on_from_the_reference(rig: Rig) -> None:
    rig.submit("sis_a 0B 7")
    body = rig.boards["ra_1"].body
    assert isinstance(body, ArmBody)
    body.stuck = True
    rig.wait_for("sis_a", "effector on/switch")
    assert rig.operate(Verb.HOLD, "sis_a") is None
    rig.wait(6.0)
    body.stuck = False
    assert rig.operate(Verb.HOME, "ra1") is None
    rig.wait(5.0)
    assert "abandon" in str(rig.operate(Verb.RETRY, "sis_a"))
    assert "abandon" in str(rig.operate(Verb.RESUME, "sis_a"))
    assert rig.operate(Verb.ABANDON, "sis_a") is None
    rig.wait(10.0)
    assert rig.plant.cells["sis_a"].state is CellState.IDLE
    assert not body.effector


def in_one_centre() -> PlantModel:
    """The shipped sis_a and sis_b, their pick-ups in one zone."""
    cells = []
    for cell in shipped("sis_a", "sis_b").cells:
        pickup = replace(StorageLayout(cell).pickup, zones=frozenset({"centre"}))
        cells.append(with_poses(cell, pickup=pickup))
    return replace(shipped("sis_a", "sis_b"), zones=("centre",), cells=tuple(cells))


def test_an_arm_is_not_homed_through_a_zone_that_another_one_holds() -> None:
    rig = Rig(in_one_centre())
    rig.wait(0.5)
    rig.submit("sis_a palletizing")
    rig.wait_for("sis_a", "move to pick-up")
    rig.crash("ra_2")
    rig.wait(0.5)
    assert "centre, which ra1 holds" in str(rig.operate(Verb.HOME, "ra2"))
    assert sent(rig, Home) == []
    rig.wait(30.0)
    assert rig.operate(Verb.HOME, "ra2") is None
    assert rig.plant.zones.holder("centre") == "ra2"
    rig.wait(5.0)
    assert rig.plant.zones.holder("centre") is None


def test_a_bridge_that_restarted_obeys_no_superseded_orchestrator(rig: Rig) -> None:
    rig.stall("plant", 3.0)
    rig.crash("bridge")
    rig.wait(0.5)
    order = FromPlant(at=rig.now, message=SetEffector(id="998-1", robot="ra1", on=True))
    rig.broker.clients["bridge"].inbox.append(order)
    rig.wait(1.0)
    body = rig.boards["ra_1"].body
    assert isinstance(body, ArmBody)
    assert not body.effector


@pytest.mark.usefixtures("boards_that_know_no_visto")
def test_the_late_end_of_an_earlier_homing_is_not_that_of_the_next_one(rig: Rig) -> None:
    """All that the plant hears is 4 s old: a silence, and then the first homing, which took no time."""
    body, belief = rig.boards["ra_1"].body, rig.plant.dispatcher.beliefs["ra1"]
    assert isinstance(body, ArmBody)
    rig.crash("ra_1")
    rig.wait(0.5)
    rig.to_plant.troubles.append(lambda message: (4.0,))
    rig.wait(1.0)
    cut(rig, "ra_1")
    mend(rig)
    assert rig.operate(Verb.HOME, "ra1") is None
    assert rig.wait(2.0, until=lambda: not belief.online) and rig.wait(3.0, until=lambda: belief.online)
    body.motors.lose_steps(1, 500)
    assert rig.operate(Verb.HOME, "ra1") is None
    homing = rig.plant.dispatcher.ledger.last_sent["ra1"]
    assert rig.wait(20.0, until=lambda: not homing.open)
    assert (homing.state, body.moving) == (State.DONE, False)


def test_a_task_starts_once_the_homing_before_it_has_ended(rig: Rig) -> None:
    rig.submit("sis_a 0B 7")
    rig.wait(30.0)
    rig.to_bridge.troubles.append(lambda message: (0.5,))
    assert rig.operate(Verb.HOME, "rm_sis_a") is None
    task = rig.submit("sis_a 0B 7").task
    rig.wait(0.3)
    assert str(rig.outcomes()[task].sentence) == "rm_sis_a is still homing"
    rig.to_bridge.troubles.clear()
    rig.wait(30.0)
    assert rig.outcomes()[task].state is TaskState.DONE


def test_a_robot_that_still_drives_an_earlier_path_gets_the_next_one_when_it_stands() -> None:
    """At `joints` the end of the one would be taken for that of the other."""
    model = shipped("sis_a", evidence=Evidence.JOINTS, assume_homed=True)
    cells = tuple(replace(cell, retry=Retry(times=1, backoff_s=0.5)) for cell in model.cells)
    rig = Rig(replace(model, cells=cells))
    rig.wait(0.5)
    task = rig.submit("sis_a 0B 7").task
    rig.wait(1.0)
    rig.lost = lambda publication: publication.topic == "rm_sis_a/paro"
    rig.crash("bridge")
    rig.wait(1.0)
    body = rig.boards["rm_sis_a"].body
    assert body.moving
    assert len(sent(rig, FollowPath)) == 1
    moving: list[bool] = []  # whether it did, when the next one left

    def look() -> None:
        moving.extend(body.moving for each in rig.moment.sent if isinstance(each, FollowPath))

    rig.watchers.append(look)
    rig.wait(50.0)
    assert moving == [False]
    assert rig.outcomes()[task].state is TaskState.DONE
