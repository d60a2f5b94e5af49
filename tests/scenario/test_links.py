"""Links that break in the middle of a move: nothing is reported done that is not, nothing hangs."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from arboleda.model.messages import Reason, TaskChanged, TaskState
from arboleda.model.plant_model import Evidence
from arboleda.testing import Rig, shipped

LEVELS = pytest.mark.parametrize("evidence", list(Evidence))


def moving(evidence: Evidence) -> Rig:
    """A plant whose arm ra1 is on its way to the pick-up pose."""
    rig = Rig(shipped(evidence=evidence))
    rig.wait(0.5)
    rig.submit("sis_a 0B 7")
    on_its_way = rig.wait(20, until=lambda: step(rig) == "move to pick-up")
    rig.wait(0.2)
    assert on_its_way and step(rig) == "move to pick-up"
    return rig


def step(rig: Rig) -> str | None:
    tree = rig.plant.cells["sis_a"].tree
    running = [node.name for node in tree.iterate() if node.status.value == "RUNNING"] if tree else []
    return running[0] if running else None


def outcome(rig: Rig) -> TaskChanged:
    rig.wait(30, until=lambda: rig.plant.at_rest)
    (change,) = rig.outcomes().values()
    return change


def restart_bridge(rig: Rig, gone_s: float) -> None:
    rig.stop_bridge()
    rig.wait(gone_s)
    rig.start_bridge()


@LEVELS
@pytest.mark.parametrize("gone_s", [0.0, 0.4, 1.2, 3.0])
def test_a_bridge_that_restarts_in_a_move_fails_it_as_link_lost(evidence: Evidence, gone_s: float) -> None:
    rig = moving(evidence)
    restart_bridge(rig, gone_s)
    change = outcome(rig)
    assert (change.state, change.reason) == (TaskState.FAILED, Reason.LINK_LOST)
    assert str(change.sentence).startswith("ra1: ")


@LEVELS
def test_a_bridge_that_never_comes_back_leaves_no_task_hanging(evidence: Evidence) -> None:
    rig = moving(evidence)
    rig.stop_bridge()
    change = outcome(rig)
    by_deadline = evidence is Evidence.STATE
    assert change.reason is (Reason.DEADLINE if by_deadline else Reason.LINK_LOST)


@LEVELS
def test_a_board_that_reboots_in_a_move_fails_it(evidence: Evidence) -> None:
    rig = moving(evidence)
    rig.crash("ra_1")
    change = outcome(rig)
    assert (change.state, change.reason) == (TaskState.FAILED, Reason.LINK_LOST)


REBOOTS = {Evidence.IDS: Reason.REBOOTED, Evidence.JOINTS: Reason.NOT_HOMED, Evidence.STATE: Reason.NOT_HOMED}


@LEVELS
def test_a_reboot_without_a_last_will_is_seen_in_the_telemetry(evidence: Evidence) -> None:
    rig = moving(evidence)
    rig.lost = lambda publication: publication.topic == "ra_1/conexion"
    rig.crash("ra_1")
    assert outcome(rig).reason is REBOOTS[evidence]


@LEVELS
def test_a_board_that_stays_away_fails_its_move(evidence: Evidence) -> None:
    rig = moving(evidence)
    rig.lost = lambda publication: publication.topic.startswith("ra_1/")
    change = outcome(rig)
    assert change.state is TaskState.FAILED
    assert change.reason is (Reason.DEADLINE if evidence is Evidence.STATE else Reason.LINK_LOST)


def drop_every(nth: int, topic: str) -> Callable[[object], bool]:
    count = 0

    def lost(publication: object) -> bool:
        nonlocal count
        count += publication.topic.endswith(topic)  # type: ignore[attr-defined]
        return publication.topic.endswith(topic) and count % nth != 0  # type: ignore[attr-defined]

    return lost


@pytest.mark.parametrize("evidence", [Evidence.IDS, Evidence.JOINTS])
def test_four_of_five_telemetry_messages_may_be_lost(evidence: Evidence) -> None:
    rig = Rig(shipped(evidence=evidence))
    rig.lost = drop_every(5, "/sensores")
    rig.submit("sis_a 0B 7")
    rig.submit("sis_b 1C 3")
    rig.wait(120, until=lambda: rig.plant.at_rest and not any(c.queue for c in rig.plant.cells.values()))
    assert {change.state for change in rig.outcomes().values()} == {TaskState.DONE}


def test_nothing_is_replayed_to_a_board_after_the_bridge_came_back() -> None:
    rig = moving(Evidence.IDS)
    restart_bridge(rig, 2.0)
    outcome(rig)
    rig.wait(1.0)
    position = rig.plant.dispatcher.beliefs["ra1"].q
    rig.wait(20.0)
    assert position is not None and rig.plant.dispatcher.beliefs["ra1"].q == position
