"""Commands: checked, quantised, numbered; and what the boards answer, by command id."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from arboleda.kinds.arm import SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.kinds.mobile import FollowPath
from arboleda.model.commands import Home, Stop, StopMode
from arboleda.model.messages import MotionState, Tokens
from arboleda.model.plant_model import Evidence
from arboleda.wire.hop import FromPlant
from arboleda.wire.payloads import Beat, EffectorGoal, HomeGoal, JointsGoal, PathGoal, StopGoal

EPOCH = 1_000
MOVING, STOPPED = MotionState.MOVING, MotionState.STOPPED


def move(number: int, q: tuple[float, ...] = (0.5, 0.1, 0.05), epoch: int = 7) -> MoveJoints:
    return MoveJoints(id=f"{epoch}-{number}", robot="ra1", q=q)


def test_a_move_leaves_quantised_to_motor_steps_after_one_beat(linked, sent) -> None:
    q = (math.radians(45), math.radians(10), 0.05)
    assert sent(linked.order(move(1, q))) == [
        ("ra_1/latido", Beat(epoch=EPOCH)),
        ("ra_1/juntas", JointsGoal(q_deg=(45.0036, 9.9, 126.9), seq=1, epoch=EPOCH, heard=1)),
    ]


def test_what_lay_here_while_the_process_was_stopped_is_refused_but_a_stop_is_not(
    linked, sent, reports
) -> None:
    linked.heartbeat()
    ordered_at, linked.now = linked.now, linked.now + 20.0
    grip, halt = (
        SetEffector(id="7-2", robot="ra1", on=False),
        Stop(id="7-3", robot="ra1", mode=StopMode.HALT),
    )
    out = linked.step(*(FromPlant(at=ordered_at, message=each) for each in (move(1), grip, halt)))
    assert [topic for topic, _ in sent(out)] == ["ra_1/paro"]
    refused = [(each.rejected, each.refusal) for each in reports(out)]
    assert refused[:2] == [("7-1", "no_link"), ("7-2", "no_link")]


def test_quantising_rounds_and_never_truncates(linked, sent) -> None:
    almost_two_steps = (math.radians(0.01929 * 1.9), math.radians(-0.9 * 1.9), 0.0)
    (_, (_, goal)) = sent(linked.order(move(1, almost_two_steps)))
    assert goal.q_deg == (0.0386, -1.8, 0.0)


def test_commands_are_qos_1_beats_qos_0_and_nothing_is_retained(linked) -> None:
    beat, goal = linked.order(move(1))
    assert (beat.qos, beat.retain) == (0, False)
    assert (goal.qos, goal.retain) == (1, False)


def test_one_board_counts_over_all_its_topics_and_each_board_for_itself(linked, sent) -> None:
    out = linked.order(
        SetEffector(id="7-1", robot="ra1", on=True),
        Home(id="7-2", robot="ra1"),
        Stop(id="7-3", robot="ra1", mode=StopMode.HALT),
        FollowPath(id="7-4", robot="rm_sis_a", nodes=(0, 3, 6)),
    )
    assert [pair for pair in sent(out) if not isinstance(pair[1], Beat)] == [
        ("ra_1/efector", EffectorGoal(on=True, seq=1, epoch=EPOCH, heard=1)),
        ("ra_1/referencia", HomeGoal(seq=2, epoch=EPOCH, heard=1)),
        ("ra_1/paro", StopGoal(mode=StopMode.HALT, seq=3, epoch=EPOCH)),
        ("rm_sis_a/camino", PathGoal(nodes=(0, 3, 6), seq=1, epoch=EPOCH, heard=1)),
    ]


@pytest.mark.parametrize("evidence", [Evidence.JOINTS, Evidence.STATE], ids=lambda level: level.value)
def test_a_board_without_ids_gets_no_numbers(make_linked, sent, evidence: Evidence) -> None:
    (_, (_, goal)) = sent(make_linked(evidence=evidence).order(move(1)))
    assert (goal.seq, goal.epoch) == (None, None)


def test_accepted_and_done_come_back_by_command_id(linked, reports) -> None:
    linked.order(move(1))
    (started,) = reports(linked.tell(state=MOVING, ack_epoch=EPOCH, ack=1))
    assert (started.accepted, started.done, started.epoch) == ("7-1", None, EPOCH)
    (ended,) = reports(linked.tell(state=STOPPED, done=1))
    assert (ended.accepted, ended.done, ended.state) == ("7-1", "7-1", STOPPED)


def test_numbers_count_only_for_our_epoca(linked, reports) -> None:
    linked.order(move(1))
    (report,) = reports(linked.tell(ack_epoch=EPOCH - 1, ack=1, done=1, refusal="limite", refused_seq=1))
    assert (report.accepted, report.done, report.rejected) == (None, None, None)


def test_numbers_are_matched_by_equality(linked, reports) -> None:
    linked.order(move(1))
    (report,) = reports(linked.tell(ack_epoch=EPOCH, ack=2, done=2))
    assert (report.accepted, report.done) == (None, None)


def test_a_rejection_names_command_and_word(linked, reports) -> None:
    linked.order(move(1))
    (report,) = reports(linked.tell(ack_epoch=EPOCH, refusal="sin_ref", refused_seq=1))
    assert (report.rejected, report.refusal) == ("7-1", "sin_ref")


def test_a_command_delivered_twice_is_not_a_rejected_command(linked, reports) -> None:
    linked.order(move(1))
    out = linked.tell(state=MOVING, ack_epoch=EPOCH, ack=1, refusal="viejo", refused_seq=1)
    assert [report.rejected for report in reports(out)] == [None]


def test_an_unlabelled_command_is_passed_on_and_never_named(linked, sent, reports) -> None:
    assert len(sent(linked.order(MoveJoints(id="", robot="ra1", q=(0.5, 0.1, 0.05))))) == 2
    assert len(sent(linked.order(MoveJoints(id="", robot="ra1", q=(0.5, 0.1, 0.05))))) == 2
    out = linked.tell(ack_epoch=EPOCH, ack=2, done=2, refusal="limite", refused_seq=1)
    assert [(report.accepted, report.done, report.rejected) for report in reports(out)] == [(None,) * 3]


def test_the_same_command_id_leaves_once(linked) -> None:
    linked.order(move(1))
    assert linked.order(move(1)) == []


def test_a_superseded_plant_is_refused(linked, reports) -> None:
    linked.heartbeat(8)
    linked.order(move(1, epoch=8))
    (report,) = reports(linked.order(move(2, epoch=7)))
    assert (report.rejected, report.refusal) == ("7-2", "old_epoch")


def test_a_plant_is_refused_before_it_was_heard_beating(linked, reports) -> None:
    """A bridge that restarted does not know yet which of two plants is superseded."""
    linked.heartbeat(0)
    (report,) = reports(linked.order(move(1, epoch=8)))
    assert (report.rejected, report.refusal) == ("8-1", "old_epoch")


def test_a_stop_is_obeyed_even_from_a_superseded_plant(linked, sent) -> None:
    linked.heartbeat(8)
    linked.order(move(1, epoch=8))
    out = linked.order(Stop(id="7-2", robot="ra1", mode=StopMode.HALT))
    assert sent(out) == [("ra_1/paro", StopGoal(mode=StopMode.HALT, seq=2, epoch=EPOCH))]


REFUSED = {
    "beyond a limit": (MoveJoints(id="7-1", robot="ra1", q=(2.7, 0.0, 0.0)), "limite"),
    "below a limit": (MoveJoints(id="7-1", robot="ra1", q=(0.0, 0.0, -0.001)), "limite"),
    "too few joints": (MoveJoints(id="7-1", robot="ra1", q=(0.0, 0.0)), "formato"),
    "not a number": (MoveJoints(id="7-1", robot="ra1", q=(0.0, math.nan, 0.0)), "formato"),
    "off the grid": (FollowPath(id="7-1", robot="rm_sis_a", nodes=(0, 9)), "limite"),
    "an empty path": (FollowPath(id="7-1", robot="rm_sis_a", nodes=()), "formato"),
    "a path too long for a message": (FollowPath(id="7-1", robot="rm_sis_a", nodes=(0, 1) * 200), "formato"),
    "joints for a mobile": (MoveJoints(id="7-1", robot="rm_sis_a", q=(0.0, 0.0, 0.0)), "formato"),
    "a path for an arm": (FollowPath(id="7-1", robot="ra1", nodes=(0,)), "formato"),
    "an effector for a mobile": (SetEffector(id="7-1", robot="rm_sis_a", on=True), "formato"),
    "an id without an epoch": (Home(id="seven", robot="ra1"), "formato"),
    "a robot of nobody": (Home(id="7-1", robot="ra9"), "no_link"),
}


@pytest.mark.parametrize(("command", "word"), REFUSED.values(), ids=REFUSED.keys())
def test_the_bridge_refuses_what_cannot_be_done_without_sending(
    linked, sent, reports, command: MoveJoints, word: str
) -> None:
    out = linked.order(command)
    assert sent(out) == []
    assert [(report.robot, report.rejected, report.refusal) for report in reports(out)] == [
        (command.robot, command.id, word)
    ]


def test_a_goal_at_its_limit_survives_binary32(linked, sent) -> None:
    at_the_limit_as_float32 = (0.0, 0.0, 0.10000000149011612)
    assert len(sent(linked.order(move(1, at_the_limit_as_float32)))) == 2


def test_a_refused_unlabelled_command_is_counted(linked, reports) -> None:
    before = linked.bridge.counters["ra1"].refused
    assert reports(linked.order(MoveJoints(id="", robot="ra1", q=(9.0, 0.0, 0.0)))) == []
    assert linked.bridge.counters["ra1"].refused == before + 1
    assert "limite" in str(linked.bridge.counters["ra1"].last)


def test_boards_without_a_stop_are_sent_none(make_linked, reports) -> None:
    bench = make_linked(has_stop=False)
    (report,) = reports(bench.order(Stop(id="7-1", robot="ra1", mode=StopMode.HALT)))
    assert (report.rejected, report.refusal) == ("7-1", "no_stop")


def test_a_refusal_by_the_bridge_stays_the_last_word(linked, reports) -> None:
    linked.order(move(1, (9.0, 0.0, 0.0)))
    (report,) = reports(linked.tell())
    assert (report.rejected, report.refusal) == ("7-1", "limite")


def test_a_command_names_the_telemetry_that_the_plant_had_heard(linked, sent) -> None:
    linked.tell()
    (_, (_, goal)) = sent(linked.order(replace(move(1), heard=1)))
    assert goal.heard == 1


def test_a_command_carries_its_token_and_a_stop_none(linked, sent) -> None:
    (_, (_, goal)) = sent(linked.order(replace(move(1), token="0a3f9x001a01")))
    assert goal.token == "0a3f9x001a01"
    ((_, halt),) = sent(linked.order(Stop(id="7-2", robot="ra1", mode=StopMode.HALT, token="0a3f9x001a01")))
    assert isinstance(halt, StopGoal)


def test_what_a_board_echoes_is_reported_with_its_numbers(linked, reports) -> None:
    (said,) = reports(linked.tell(seq=2, ack_epoch=5, ack=8, done=7, ack_token="b", done_token="a"))
    assert said.tokens == Tokens(accepted="b", done="a")
    (said,) = reports(linked.tell(seq=3, ack=9, ack_token=None, done_token=None))
    assert said.tokens is None


def test_for_who_names_none_a_command_names_what_the_bridge_had_heard(linked, sent) -> None:
    linked.tell()
    (_, (_, goal)) = sent(linked.order(move(1)))
    assert goal.heard == 2


def test_reports_say_which_telemetry_they_are_of_and_so_does_one_that_repeats_the_last(
    linked, reports
) -> None:
    numbers = [reports(linked.tell())[0].number for _ in range(3)]
    assert numbers == [2, 3, 4]
