"""The bridge's epoca: above all that a board has heard, raised once when it says `viejo`, and beaten."""

from __future__ import annotations

import pytest

from arboleda.kinds.arm import SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.model.commands import Stop, StopMode
from arboleda.model.messages import Heartbeat, MotionState
from arboleda.model.plant_model import Evidence
from arboleda.wire.hop import FromPlant
from arboleda.wire.payloads import Beat, EffectorGoal

EPOCH = 1_000
FENCE = ("ra_1/latido", Beat(epoch=EPOCH))


def grip(number: int) -> SetEffector:
    return SetEffector(id=f"7-{number}", robot="ra1", on=True)


def test_a_restarted_bridge_starts_above_what_the_board_has_heard(bench, sent, reports) -> None:
    bench.connect()
    (report,) = reports(bench.tell(ack_epoch=EPOCH + 5, ack=1, done=1))
    assert (report.epoch, report.accepted, report.done) == (EPOCH + 6, None, None)
    assert sent(bench.order(grip(1))) == [
        ("ra_1/efector", EffectorGoal(on=True, seq=1, epoch=EPOCH + 6, heard=1))
    ]


def test_a_second_start_within_the_same_second_gets_its_own_epoca(bench, reports) -> None:
    bench.connect()
    assert reports(bench.tell(ack_epoch=EPOCH, ack=3))[0].epoch == EPOCH + 1


def test_one_board_raises_only_its_own_epoca(bench, reports) -> None:
    bench.connect()
    bench.tell("ra_1", ack_epoch=EPOCH + 5)
    assert reports(bench.tell("rm_sis_a"))[0].epoch == EPOCH


def test_viejo_rejects_the_command_and_the_next_one_is_above(linked, sent, reports) -> None:
    linked.order(grip(1))
    (report,) = reports(linked.tell(ack_epoch=EPOCH + 9, ack=4, refusal="viejo", refused_seq=1))
    assert (report.rejected, report.refusal, report.epoch) == ("7-1", "viejo", EPOCH)
    assert sent(linked.order(grip(2))) == [
        ("ra_1/efector", EffectorGoal(on=True, seq=2, epoch=EPOCH + 10, heard=2))
    ]


def test_a_board_that_takes_ever_higher_numbers_is_followed_three_times_a_minute(linked, sent) -> None:
    given = []
    for turn in range(1, 7):
        linked.wait(1.0)
        linked.tell(ack_epoch=EPOCH + 100 * turn, ack=4)
        ((_, goal),) = sent(linked.order(grip(turn)))
        given.append(goal.epoch)
    assert given == [EPOCH + number for number in (101, 201, 301, 301, 301, 301)]
    linked.wait(60.0)
    linked.tell(ack_epoch=EPOCH + 1000, ack=4)
    ((_, goal),) = sent(linked.order(grip(7)))
    assert goal.epoch == EPOCH + 1001


def test_numbers_given_before_the_epoca_rose_mean_nothing_after(linked, reports) -> None:
    linked.order(grip(1))
    linked.order(grip(2))
    linked.tell(ack_epoch=EPOCH + 9, refusal="viejo", refused_seq=2)
    (report,) = reports(linked.tell(ack_epoch=EPOCH + 10, ack=1))
    assert report.accepted is None


def test_a_refusal_left_from_before_is_nobodys(bench, reports) -> None:
    bench.connect()
    bench.tell(ack_epoch=EPOCH - 1, ack=3, refusal="viejo", refused_seq=1)
    bench.order(grip(1))
    assert [report.rejected for report in reports(bench.tell())] == [None]


def test_viejo_for_a_number_that_the_board_has_not_reached_is_a_strangers(linked, reports) -> None:
    linked.order(grip(1))
    linked.tell(ack_epoch=EPOCH, ack=1)
    linked.order(grip(2))
    (report,) = reports(linked.tell(ack_epoch=EPOCH, ack=1, refusal="viejo", refused_seq=2))
    assert report.rejected is None


def test_a_plant_that_beats_has_each_board_refuse_whoever_commanded_before(bench, sent) -> None:
    bench.connect()
    bench.tell(ack_epoch=EPOCH - 5, ack=7, least_epoch=None)
    assert sent(bench.heartbeat()) == [FENCE]
    assert sent(bench.heartbeat()) == [FENCE]  # a beat may be lost
    bench.tell(least_epoch=EPOCH)
    assert sent(bench.heartbeat()) == []


@pytest.mark.parametrize("said", [{}, {"ack_epoch": EPOCH - 5, "ack": 7}], ids=["never told", "told before"])
def test_a_board_that_booted_is_told_anew_who_commands_it(linked, sent, said: dict) -> None:
    assert sent(linked.heartbeat()) == []
    linked.tell(boot_id=2, seq=0, least_epoch=None, **said)
    assert sent(linked.heartbeat()) == [FENCE]


def test_a_command_that_was_taken_tells_a_board_who_commands_it(bench, sent) -> None:
    bench.connect()
    bench.tell(least_epoch=None)
    bench.order(grip(1))
    bench.tell(ack_epoch=EPOCH, ack=1)
    assert sent(bench.heartbeat()) == []


def test_without_a_plant_nobody_is_fenced_off(bench) -> None:
    bench.connect()
    bench.tell(least_epoch=None)
    assert bench.wait(1.0) == []


@pytest.mark.parametrize("evidence", [Evidence.JOINTS, Evidence.STATE], ids=lambda level: level.value)
def test_boards_that_know_no_numbers_are_not_beaten_for_them(make_linked, sent, evidence) -> None:
    assert sent(make_linked(evidence=evidence).heartbeat()) == []


def test_a_bridge_that_starts_begins_above_what_has_beaten(bench, sent) -> None:
    bench.connect()
    bench.tell(least_epoch=EPOCH + 5)
    assert sent(bench.heartbeat()) == [("ra_1/latido", Beat(epoch=EPOCH + 6))]


def test_a_bridge_that_leads_is_numbered_above_the_next_once_its_plant_still_beats(
    bench, sent, reports
) -> None:
    bench.connect()
    bench.tell(least_epoch=EPOCH)
    out = bench.tell(least_epoch=EPOCH + 9)
    assert sent(out) == []
    (report,) = reports(out)
    assert "another bridge has come to its board (epoca 1009)" in str(report.foreign)
    assert sent(bench.heartbeat()) == [("ra_1/latido", Beat(epoch=EPOCH + 10))]
    ((_, goal),) = sent(bench.order(grip(1)))
    assert goal.epoch == EPOCH + 10


def test_a_bridge_that_was_superseded_and_whose_plant_is_silent_does_not_rise(linked, sent, reports) -> None:
    linked.order(grip(1))
    linked.tell(ack_epoch=EPOCH, ack=1)
    linked.order(grip(2))
    (report,) = reports(linked.tell(least_epoch=EPOCH + 9, refusal="viejo", refused_seq=2))
    assert (report.rejected, report.refusal, report.epoch) == ("7-2", "viejo", EPOCH)
    assert "another bridge has come" in str(report.foreign)
    assert sent(linked.wait(3.0)) == []


def test_a_word_of_the_plant_from_before_the_other_bridge_came_proves_nothing(bench, sent) -> None:
    bench.connect()
    bench.tell(least_epoch=EPOCH)
    early = bench.now
    bench.wait(1.0)
    bench.tell(least_epoch=EPOCH + 9)
    assert sent(bench.step(FromPlant(at=early, message=Heartbeat(epoch=7)))) == []


def test_the_bridge_that_came_later_yields_to_the_one_that_rose_above_it(bench, sent, reports) -> None:
    bench.connect()
    bench.tell(least_epoch=None)
    assert sent(bench.heartbeat()) == [FENCE]
    bench.tell(least_epoch=EPOCH)
    (report,) = reports(bench.tell(least_epoch=EPOCH + 1))
    assert "another bridge was at its board before this one (epoca 1001 now)" in str(report.foreign)
    assert sent(bench.heartbeat()) == []
    out = bench.order(grip(1))
    (report,) = reports(out)
    assert (sent(out), report.rejected, report.refusal) == ([], "7-1", "other_bridge")
    halted = bench.order(Stop(id="7-2", robot="ra1", mode=StopMode.HALT))
    assert [address for address, _ in sent(halted)] == ["ra_1/paro"]


def test_a_bridge_whose_plant_has_a_lease_rises_above_one_that_was_there_before(make_bench, sent) -> None:
    bench = make_bench(has_lease=True)
    bench.connect()
    bench.heartbeat()
    bench.tell(least_epoch=EPOCH + 1)
    assert sent(bench.heartbeat()) == [("ra_1/latido", Beat(epoch=EPOCH + 2))]


def test_a_bridge_that_has_long_been_there_does_not_yield(bench, sent) -> None:
    bench.connect()
    bench.tell(least_epoch=EPOCH)
    for _ in range(11):
        bench.wait(1.0)
        bench.tell(least_epoch=EPOCH)
    bench.tell(least_epoch=EPOCH + 1)
    assert sent(bench.heartbeat()) == [("ra_1/latido", Beat(epoch=EPOCH + 2))]


def test_of_two_bridges_the_one_that_was_there_first_goes_on(bench, make_bench, sent) -> None:
    """Each hears what the other has the board say, for a minute."""
    first, second, least = bench, make_bench(epoch=EPOCH + 40), None
    for turn in range(240):
        for each in (first, second)[: 1 if turn < 60 else 2]:
            if turn in (0, 60):
                each.connect()
            each.wait(0.25)
            each.tell(least_epoch=least)
            beats = [goal.epoch for _, goal in sent(each.heartbeat()) if isinstance(goal, Beat)]
            least = max([least or 0, *beats]) or None
    assert least == EPOCH + 41
    ((_, goal),) = sent(first.order(grip(1)))
    assert goal.epoch == EPOCH + 41
    assert sent(second.order(grip(1))) == []


def test_work_under_way_is_ended_before_the_bridge_rises_above_another(bench, sent, reports) -> None:
    bench.connect()
    bench.tell(least_epoch=EPOCH)
    bench.order(MoveJoints(id="7-1", robot="ra1", q=(0.5, 0.0, 0.0)))
    bench.tell(ack_epoch=EPOCH, ack=1, least_epoch=EPOCH + 9, state=MotionState.MOVING)
    assert sent(bench.heartbeat()) == [("ra_1/latido", Beat(epoch=EPOCH))]
    (report,) = reports(bench.tell(ack_epoch=EPOCH, ack=1, done=1, least_epoch=EPOCH + 9))
    assert (report.done, report.epoch) == ("7-1", EPOCH)
    ((_, goal),) = sent(bench.order(grip(2)))
    assert (goal.seq, goal.epoch) == (2, EPOCH + 10)
    (report,) = reports(bench.tell(ack_epoch=EPOCH + 10, ack=2))
    assert (report.accepted, report.epoch) == ("7-2", EPOCH)
