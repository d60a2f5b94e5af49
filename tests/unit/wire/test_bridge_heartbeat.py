"""Beats: while a motion is open, and only as long as the plant's own heart beats."""

from __future__ import annotations

import math

import pytest

from arboleda.core.messages import FollowPath, Home, MoveJoints, SetEffector, Stop, StopMode
from arboleda.core.model import Evidence, MotionState
from arboleda.wire.payloads import Beat

EPOCH = 1_000
MOVING, STOPPED, LATCHED = MotionState.MOVING, MotionState.STOPPED, MotionState.STOP_LATCHED
BEAT = [("ra_1/latido", Beat(epoch=EPOCH))]
MOVE = MoveJoints(id="7-1", robot="ra1", q=(math.radians(9), 0.0, 0.0))
TARGET_DEG = (0.01929 * 467, 0.0, 0.0)


def test_no_motion_no_beat(linked, sent) -> None:
    linked.order(SetEffector(id="7-1", robot="ra1", on=True))
    assert sent(linked.heartbeat()) == []


def test_a_heartbeat_is_relayed_to_the_boards_in_motion(linked, sent) -> None:
    linked.order(MOVE)
    assert sent(linked.heartbeat()) == BEAT
    linked.order(FollowPath(id="7-2", robot="rm_sis_a", nodes=(0, 3)))
    assert sent(linked.heartbeat()) == [*BEAT, ("rm_sis_a/latido", Beat(epoch=EPOCH))]


def test_homing_is_a_motion(linked, sent) -> None:
    assert sent(linked.order(Home(id="7-1", robot="ra1")))[0] == BEAT[0]
    assert sent(linked.heartbeat()) == BEAT


@pytest.mark.parametrize(
    "ending",
    [{"ack": 1, "done": 1}, {"refusal": "limite", "refused_seq": 1}],
    ids=["finished", "rejected"],
)
def test_the_beats_end_with_the_motion(linked, ending: dict, sent) -> None:
    linked.order(MOVE)
    linked.tell(ack_epoch=EPOCH, **ending)
    assert sent(linked.heartbeat()) == []


@pytest.mark.parametrize(("mode", "still"), [(StopMode.HALT, STOPPED), (StopMode.LATCH, LATCHED)])
def test_a_halted_motion_is_beaten_until_it_stands_still(linked, sent, mode, still) -> None:
    linked.order(MOVE)
    linked.tell(state=MOVING, ack_epoch=EPOCH, ack=1)
    linked.order(Stop(id="7-2", robot="ra1", mode=mode))
    linked.tell(state=MOVING, ack=2)
    assert sent(linked.heartbeat()) == BEAT
    linked.tell(state=still)
    assert sent(linked.heartbeat()) == []


def test_standing_still_alone_does_not_end_a_motion_of_a_board_with_ids(linked, sent) -> None:
    linked.order(MOVE)
    linked.tell(state=MOVING, ack_epoch=EPOCH, ack=1)
    linked.tell(state=STOPPED)
    assert sent(linked.heartbeat()) == BEAT


@pytest.mark.parametrize("evidence", [Evidence.JOINTS, Evidence.STATE], ids=lambda level: level.value)
def test_without_ids_moving_and_then_still_ends_it(make_linked, sent, evidence: Evidence) -> None:
    bench = make_linked(evidence=evidence)
    bench.order(MOVE)
    bench.tell(state=STOPPED)
    assert sent(bench.heartbeat()) == BEAT
    bench.tell(state=MOVING)
    bench.tell(state=STOPPED)
    assert sent(bench.heartbeat()) == []


def test_at_joints_a_robot_already_at_its_goal_needs_no_beats(make_linked, sent) -> None:
    bench = make_linked(evidence=Evidence.JOINTS)
    bench.order(MOVE)
    bench.tell(state=STOPPED, q=TARGET_DEG)
    assert sent(bench.heartbeat()) == []


def test_at_joints_a_mobile_at_its_last_node_needs_no_beats(make_linked, sent) -> None:
    bench = make_linked(evidence=Evidence.JOINTS)
    bench.order(FollowPath(id="7-1", robot="rm_sis_a", nodes=(0, 3)))
    bench.tell("rm_sis_a", node=3)
    assert sent(bench.heartbeat()) == []


def test_when_the_plant_falls_silent_so_does_the_bridge(linked) -> None:
    linked.heartbeat()
    linked.order(MOVE)
    assert linked.wait(1.0) == []


def test_a_superseded_plant_does_not_beat(linked) -> None:
    linked.heartbeat(epoch=8)
    linked.order(MoveJoints(id="8-1", robot="ra1", q=MOVE.q))
    assert linked.heartbeat(epoch=7) == []


def test_the_first_beat_of_a_new_plant_supersedes_the_old_one(linked, reports) -> None:
    linked.heartbeat(epoch=8)
    (report,) = reports(linked.order(MOVE))
    assert (report.rejected, report.refusal) == ("7-1", "old_epoch")


def test_for_an_orchestrator_without_heartbeat_the_bridge_beats_itself(linked, sent) -> None:
    linked.order(MoveJoints(id="", robot="ra1", q=MOVE.q))
    assert linked.bridge.next_deadline == pytest.approx(linked.now + 0.25)
    assert sent(linked.wait(0.25)) == BEAT
    assert sent(linked.wait(0.1)) == []
    assert sent(linked.wait(0.15)) == BEAT
    linked.tell(ack_epoch=EPOCH, ack=1, done=1)
    assert linked.wait(0.25) == []


def test_a_lost_board_gets_no_beats(linked, sent) -> None:
    linked.order(MOVE)
    linked.presence(False)
    assert sent(linked.heartbeat()) == []
