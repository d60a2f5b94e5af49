"""The bridge's epoca: above all that a board has heard, raised once when it says `viejo`, and beaten."""

from __future__ import annotations

import pytest

from arboleda.kinds.arm import SetEffector
from arboleda.model.plant_model import Evidence
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


def test_viejo_rejects_the_command_and_raises_the_epoca(linked, sent, reports) -> None:
    linked.order(grip(1))
    (report,) = reports(linked.tell(ack_epoch=EPOCH + 9, ack=4, refusal="viejo", refused_seq=1))
    assert (report.rejected, report.refusal, report.epoch) == ("7-1", "viejo", EPOCH + 10)
    assert sent(linked.order(grip(2))) == [
        ("ra_1/efector", EffectorGoal(on=True, seq=2, epoch=EPOCH + 10, heard=2))
    ]


def test_a_second_viejo_is_only_reported(linked, reports) -> None:
    linked.order(grip(1))
    linked.tell(ack_epoch=EPOCH + 9, ack=4, refusal="viejo", refused_seq=1)
    linked.order(grip(2))
    (report,) = reports(linked.tell(ack_epoch=EPOCH + 20, ack=9, refusal="viejo", refused_seq=2))
    assert (report.rejected, report.refusal, report.epoch) == ("7-2", "viejo", EPOCH + 10)


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


def test_a_bridge_that_has_led_in_silence_does_not_rise_above_the_next(bench, sent) -> None:
    bench.connect()
    bench.tell(least_epoch=EPOCH)
    bench.tell(least_epoch=EPOCH + 9)
    assert sent(bench.heartbeat()) == []
    assert sent(bench.order(grip(1))) == [
        ("ra_1/efector", EffectorGoal(on=True, seq=1, epoch=EPOCH, heard=2))
    ]


def test_a_bridge_that_was_superseded_hears_it_and_does_not_rise_above_the_next(
    linked, sent, reports
) -> None:
    linked.order(grip(1))
    linked.tell(ack_epoch=EPOCH, ack=1)
    linked.order(grip(2))
    (report,) = reports(linked.tell(least_epoch=EPOCH + 9, refusal="viejo", refused_seq=2))
    assert (report.rejected, report.refusal, report.epoch) == ("7-2", "viejo", EPOCH)
    assert sent(linked.order(grip(3))) == [
        ("ra_1/efector", EffectorGoal(on=True, seq=3, epoch=EPOCH, heard=3))
    ]
