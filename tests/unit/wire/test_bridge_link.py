"""Who is there: broker, presence, staleness, reboots; and nothing is ever sent twice."""

from __future__ import annotations

import pytest

from arboleda.kinds.joints import MoveJoints
from arboleda.model.messages import MotionState, Report
from arboleda.model.plant_model import Evidence

MOVING, STOPPED, NO_LINK = MotionState.MOVING, MotionState.STOPPED, MotionState.NO_LINK
STALE_AFTER_S = 1.5


def move(number: int) -> MoveJoints:
    return MoveJoints(id=f"7-{number}", robot="ra1", q=(0.5, 0.1, 0.05))


def states(messages: list) -> list[tuple[str, MotionState]]:
    return [(message.robot, message.state) for message in messages]


def test_at_start_no_robot_has_a_link(bench) -> None:
    assert states(bench.start) == [("ra1", NO_LINK), ("rm_sis_a", NO_LINK)]
    assert bench.bridge.next_deadline is None


def test_it_listens_to_what_boards_say(bench) -> None:
    assert bench.bridge.subscriptions == (
        "ra_1/sensores",
        "ra_1/conexion",
        "rm_sis_a/sensores",
        "rm_sis_a/conexion",
    )


def test_telemetry_becomes_a_report_in_si_units(bench, reports) -> None:
    bench.connect()
    (report,) = reports(bench.tell(q_deg=(45.0036, 9.9, 127.8), effector=True, piece=False, boot_id=3))
    assert report.q == pytest.approx((0.78546, 0.17279, 0.05019), abs=1e-5)
    assert (report.at, report.robot, report.epoch, report.boot_id) == (bench.now, "ra1", 1_000, 3)
    assert (report.state, report.homed, report.effector, report.piece) == (STOPPED, True, True, False)


def test_a_mobile_reports_its_node(bench, reports) -> None:
    bench.connect()
    (report,) = reports(bench.tell("rm_sis_a", node=4))
    assert (report.robot, report.node, report.q) == ("rm_sis_a", 4, None)


def unheard(bench) -> None:
    bench.connect()


def without_broker(bench) -> None:
    bench.connect()
    bench.tell()
    bench.connect(up=False)


def absent(bench) -> None:
    bench.connect()
    bench.tell()
    bench.presence(False)


def stale(bench) -> None:
    bench.connect()
    bench.tell()
    bench.wait(STALE_AFTER_S)


def back_but_silent(bench) -> None:
    without_broker(bench)
    bench.connect()
    bench.presence(True)


@pytest.mark.parametrize(
    "situation", [unheard, without_broker, absent, stale, back_but_silent], ids=lambda case: case.__name__
)
def test_no_command_leaves_without_a_link(bench, sent, reports, situation) -> None:
    situation(bench)
    out = bench.order(move(1))
    assert sent(out) == []
    assert [(report.rejected, report.refusal, report.state) for report in reports(out)] == [
        ("7-1", "no_link", NO_LINK)
    ]


def test_presence_0_is_reported_once_and_telemetry_then_means_nothing(linked) -> None:
    assert states(linked.presence(False)) == [("ra1", NO_LINK)]
    assert linked.presence(False) == []
    assert linked.tell() == []
    assert "conexion is 0" in str(linked.bridge.counters["ra1"].last)


def lost(messages: list) -> list[tuple[MotionState, str | None]]:
    return [(each.state, each.lost and str(each.lost)) for each in messages if each.robot == "ra1"]


def talks_on(linked) -> list:
    """What comes of a board that talks for 2 s after its absence, of which the last message is returned."""
    linked.presence(False)
    linked.now += 1.85
    assert lost(linked.tell()) == [], "it may have been under way"
    return linked.tell()


def test_a_board_that_goes_on_talking_in_its_absence_is_named_once(linked) -> None:
    ((state, why),) = lost(talks_on(linked))
    assert state is NO_LINK and why.startswith("its board talks, but its `conexion` says 0")
    assert linked.tell() == []


def test_a_board_that_no_longer_talks_in_its_absence_is_only_lost(linked) -> None:
    talks_on(linked)
    linked.now = linked.bridge.next_deadline
    assert lost(linked.step()) == [(NO_LINK, None)]


def test_a_board_that_talked_in_its_absence_is_back_with_its_presence(linked) -> None:
    talks_on(linked)
    assert linked.presence(True) == []
    assert lost(linked.tell()) == [(STOPPED, None)]


def of_ra1(messages: list) -> list[Report]:
    return [each for each in messages if isinstance(each, Report) and each.robot == "ra1"]


def talk_in_turn(linked, times: int) -> list:
    """What comes of the last message of two boards of one name, which count their own messages."""
    said = []
    for number in range(times):
        said = linked.tell(boot_id=30 + number % 2, seq=100 + number)
    return of_ra1(said)


def test_two_boards_of_one_name_are_named_once_and_commanded_by_nobody(linked) -> None:
    ((state, why),) = lost(talk_in_turn(linked, 5))
    assert state is NO_LINK and why.startswith(
        "two boards call themselves ra_1, as their boot numbers alternate"
    )
    assert talk_in_turn(linked, 3) == []
    (refused,) = of_ra1(linked.order(move(1)))
    assert refused.refusal == "no_link"


def test_a_board_whose_twin_was_switched_off_is_back_as_one_that_booted(linked) -> None:
    talk_in_turn(linked, 5)
    linked.tell(boot_id=31, seq=200)
    linked.now += 10.0
    (report,) = of_ra1(linked.tell(boot_id=31, seq=201))
    assert (report.state, report.boot_id) == (STOPPED, 31)


def test_a_board_that_boots_often_has_no_twin(linked) -> None:
    for boot in range(40, 60):
        (report,) = of_ra1(linked.tell(boot_id=boot, seq=1))
        assert (report.state, report.boot_id) == (STOPPED, boot)


def test_a_board_is_back_when_it_speaks_again(linked) -> None:
    linked.presence(False)
    assert linked.presence(True) == []
    assert states(linked.tell()) == [("ra1", STOPPED)]


def test_silence_is_reported_once_when_it_has_lasted(linked) -> None:
    linked.tell("rm_sis_a")
    heard_ra1 = linked.now - 0.2
    assert linked.bridge.next_deadline == pytest.approx(heard_ra1 + STALE_AFTER_S)
    linked.now = linked.bridge.next_deadline
    assert states(linked.step()) == [("ra1", NO_LINK)]
    linked.now = linked.bridge.next_deadline
    assert states(linked.step()) == [("rm_sis_a", NO_LINK)]
    assert linked.bridge.next_deadline is None


def test_a_robot_at_state_is_never_stale(make_linked) -> None:
    assert make_linked(evidence=Evidence.STATE).wait(1_000.0) == []


def test_losing_the_broker_loses_every_robot_once(linked) -> None:
    assert states(linked.connect(up=False)) == [("ra1", NO_LINK), ("rm_sis_a", NO_LINK)]
    assert linked.connect(up=False) == []


def test_nothing_is_replayed_after_a_reconnect(linked, sent) -> None:
    linked.order(move(1))
    linked.connect(up=False)
    assert linked.connect() == []
    assert sent(linked.presence(True)) == []
    assert sent(linked.tell()) == []
    assert sent(linked.heartbeat()) == []


def test_telemetry_after_the_broker_was_lost_is_not_a_link(linked) -> None:
    linked.connect(up=False)
    assert linked.tell() == []


def test_retained_telemetry_is_refused(linked) -> None:
    assert (
        linked.deliver("ra_1/sensores", b'{"q1_mov":0,"q2_mov":0,"q3_mov":0,"estado":0}', retain=True) == []
    )
    assert "retained" in str(linked.bridge.counters["ra1"].last)


def test_telemetry_that_was_overtaken_is_counted_and_dropped(linked) -> None:
    linked.tell(seq=9)
    assert linked.tell(seq=9) == []
    assert linked.tell(seq=8) == []
    assert linked.bridge.counters["ra1"].old == 2
    assert states(linked.tell(seq=10)) == [("ra1", STOPPED)]


def test_a_number_that_was_too_high_makes_a_board_mute_for_a_while_only(linked) -> None:
    linked.tell(seq=2**31)
    linked.wait(STALE_AFTER_S)
    heard = [bool(linked.tell(seq=number)) for number in range(40)]
    assert heard.index(True) * 0.1 == pytest.approx(STALE_AFTER_S, abs=0.11)
    assert all(heard[heard.index(True) :])


def test_old_numbers_that_do_not_rise_bring_no_lost_board_back(linked) -> None:
    linked.tell(seq=99)
    linked.wait(STALE_AFTER_S)
    assert all(linked.tell(seq=number % 8) == [] for number in range(80))


def test_overtaken_telemetry_is_no_sign_of_life(linked) -> None:
    linked.tell(seq=9)
    deadline = linked.bridge.next_deadline
    linked.tell(seq=9)
    assert linked.bridge.next_deadline == deadline


def test_a_reboot_starts_its_own_count_and_forgets_what_was_open(linked, sent, reports) -> None:
    linked.order(move(1))
    linked.tell(state=MOVING, seq=500, ack_epoch=1_000, ack=1)
    (report,) = reports(linked.tell(state=STOPPED, seq=1, boot_id=2, ack_epoch=None, ack=None, homed=False))
    assert (report.boot_id, report.accepted, report.homed) == (2, None, False)
    assert sent(linked.heartbeat()) == []


@pytest.mark.parametrize(
    ("topic", "payload", "named", "robot"),
    [
        ("ra_1/sensores", b"{", "JSON", "ra1"),
        ("ra_1/sensores", b'{"q1_mov":true,"q2_mov":0,"q3_mov":0,"estado":0}', "q1_mov", "ra1"),
        ("ra_1/conexion", b"2", "conexion", "ra1"),
        ("ra_1/paro", b'{"paro":1}', "not for the bridge", "ra1"),
        ("rm_sis_a/sensores", b'{"nodo":9,"estado":0}', "nodo is 9", "rm_sis_a"),
        ("ra_9/sensores", b"{}", "ra_9", ""),
        ("ra_1/otro", b"{}", "otro", ""),
    ],
)
def test_a_bad_message_is_counted_by_robot_and_changes_nothing(
    linked, topic: str, payload: bytes, named: str, robot: str
) -> None:
    deadline = linked.bridge.next_deadline
    assert linked.deliver(topic, payload) == []
    assert linked.bridge.counters[robot].refused == 1
    assert named in str(linked.bridge.counters[robot].last)
    assert linked.bridge.next_deadline == deadline


def test_a_board_without_ids_reports_what_it_has(make_linked, reports) -> None:
    bench = make_linked(evidence=Evidence.JOINTS)
    bench.order(move(1))
    (report,) = reports(bench.tell(state=MOVING, q_deg=(9.0, 0.0, 0.0)))
    assert report.state is MOVING
    assert report.q == pytest.approx((0.15708, 0.0, 0.0), abs=1e-5)
    assert (report.accepted, report.done, report.rejected) == (None,) * 3


def test_a_board_without_ids_that_comes_back_counts_as_booted_anew(make_linked, reports) -> None:
    bench = make_linked(evidence=Evidence.JOINTS)
    (before,) = reports(bench.tell(state=STOPPED))
    bench.presence(False)
    bench.presence(True)
    (after,) = reports(bench.tell(state=STOPPED))
    assert after.boot_id == before.boot_id + 1


def test_a_plant_is_told_at_its_first_heartbeat_that_it_is_heard(linked, reports) -> None:
    assert [report.plant for report in reports(linked.heartbeat(epoch=7))] == [7, 7]
    assert reports(linked.heartbeat(epoch=7)) == []
    assert [report.plant for report in reports(linked.tell(state=STOPPED))] == [7]
    assert [report.plant for report in reports(linked.heartbeat(epoch=8))] == [8, 8]


def test_a_robot_without_link_tells_no_plant_that_it_is_heard(bench, reports) -> None:
    assert reports(bench.heartbeat(epoch=7)) == []
