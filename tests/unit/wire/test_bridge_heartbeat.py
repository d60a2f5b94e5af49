"""Beats: while a motion is open, and only as long as the plant's own heart beats."""

from __future__ import annotations

import math

import pytest

from arboleda.kinds.arm import SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.kinds.mobile import FollowPath
from arboleda.model.commands import Home, Stop, StopMode
from arboleda.model.messages import Heartbeat, MotionState
from arboleda.model.plant_model import Evidence
from arboleda.wire.hop import FromPlant
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


@pytest.mark.parametrize(
    ("epoch", "unix_s"), [(2**32 - 1, None), (2**32 - 1, 1_800_000_000), (1_832_000_000, 1_800_000_000)]
)
def test_a_plant_of_the_far_future_is_refused_and_ours_goes_on(
    linked, sent, reports, epoch: int, unix_s: int | None
) -> None:
    linked.order(MOVE)
    beat = FromPlant(at=linked.now, message=Heartbeat(epoch=epoch), unix_s=unix_s)
    assert linked.step(beat) == []
    strays = linked.bridge.counters[""]
    assert strays.refused == 1 and f"plant {epoch} is refused" in str(strays.last)
    assert sent(linked.heartbeat()) == BEAT
    assert {report.plant for report in reports(linked.tell())} == {7}


@pytest.mark.parametrize(
    ("epoch", "unix_s"),
    [(1_800_000_000, 1_800_000_000), (1_810_000_000, 1_800_000_000), (4_000_000_000, None)],
)
def test_a_plant_whose_clock_is_a_little_ahead_is_obeyed(bench, reports, epoch, unix_s) -> None:
    bench.connect()
    bench.step(FromPlant(at=bench.now, message=Heartbeat(epoch=epoch), unix_s=unix_s))
    assert {report.plant for report in reports(bench.tell())} == {epoch}


NOW, TEN_YEARS_ON = 1_800_000_000, 2_116_000_000


def beats(bench, seconds: int, *epochs: int) -> None:
    """Plants of these numbers beat once a second, at once; the clock of the bridge says NOW."""
    for _ in range(seconds):
        for epoch in epochs or (TEN_YEARS_ON,):
            bench.step(FromPlant(at=bench.now, message=Heartbeat(epoch=epoch), unix_s=NOW))
        bench.now += 1.0


def test_a_plant_that_has_a_number_of_a_wrong_clock_is_obeyed_once_it_goes_on_beating(bench, reports) -> None:
    bench.connect()
    beats(bench, 3)
    assert {report.plant for report in reports(bench.tell())} == {None}
    beats(bench, 1)
    assert {report.plant for report in reports(bench.tell())} == {TEN_YEARS_ON}
    beats(bench, 4, TEN_YEARS_ON + 1)
    assert {report.plant for report in reports(bench.tell())} == {TEN_YEARS_ON + 1}, "its next start"


def test_stray_beats_above_a_plant_that_is_far_ahead_are_refused(bench, reports) -> None:
    bench.connect()
    beats(bench, 4)
    for days in (300, 600):
        beats(bench, 1, TEN_YEARS_ON + days * 86_400, TEN_YEARS_ON)
    assert {report.plant for report in reports(bench.tell())} == {TEN_YEARS_ON}


def test_stray_beats_far_ahead_are_refused_where_they_do_not_go_on(bench, reports) -> None:
    bench.connect()
    for _ in range(4):
        beats(bench, 1)
        bench.wait(60.0)
    assert {report.plant for report in reports(bench.tell())} == {None}


def test_of_two_plants_far_ahead_that_beat_at_once_the_newer_is_obeyed(bench, reports) -> None:
    bench.connect()
    beats(bench, 4, TEN_YEARS_ON - 9, TEN_YEARS_ON)
    assert {report.plant for report in reports(bench.tell())} == {TEN_YEARS_ON}


def test_where_a_plant_is_heard_none_that_is_far_ahead_is_obeyed(bench, reports) -> None:
    bench.connect()
    beats(bench, 1, NOW)
    beats(bench, 20)
    assert {report.plant for report in reports(bench.tell())} == {NOW}


def test_homing_is_a_motion(linked, sent) -> None:
    assert sent(linked.order(Home(id="7-1", robot="ra1")))[0] == BEAT[0]
    assert sent(linked.heartbeat()) == BEAT


@pytest.mark.parametrize(
    "ending", [{"ack": 1, "done": 1}, {"refusal": "limite", "refused_seq": 1}], ids=["finished", "rejected"]
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
    assert sent(bench.heartbeat()) == BEAT
    stays(bench, state=STOPPED)
    assert sent(bench.heartbeat()) == []


@pytest.mark.parametrize("evidence", [Evidence.JOINTS, Evidence.STATE], ids=lambda level: level.value)
def test_without_ids_the_late_end_of_an_earlier_move_ends_no_beats(make_linked, sent, evidence) -> None:
    bench = make_linked(evidence=evidence)
    bench.order(MOVE)
    bench.tell(state=MOVING)
    bench.tell(state=STOPPED)
    bench.tell(state=MOVING)
    stays(bench, state=MOVING)
    assert sent(bench.heartbeat()) == BEAT


def test_at_joints_a_robot_already_at_its_goal_needs_no_beats(make_linked, sent) -> None:
    bench = make_linked(evidence=Evidence.JOINTS)
    bench.order(MOVE)
    stays(bench, state=STOPPED, q_deg=TARGET_DEG)
    assert sent(bench.heartbeat()) == []


def test_at_joints_a_mobile_at_its_last_node_needs_no_beats(make_linked, sent) -> None:
    bench = make_linked(evidence=Evidence.JOINTS)
    bench.order(FollowPath(id="7-1", robot="rm_sis_a", nodes=(0, 3)))
    stays(bench, "rm_sis_a", node=3)
    assert sent(bench.heartbeat()) == []


def stays(bench, robot: str = "ra_1", **said: object) -> None:
    """The board says the same for longer than it would drive on without beats."""
    for _ in range(12):
        bench.tell(robot, **said)


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
