"""The bridge's epoca: above everything a board has heard, raised once when a board says `viejo`."""

from __future__ import annotations

from arboleda.kinds.arm import SetEffector
from arboleda.wire.payloads import EffectorGoal

EPOCH = 1_000


def grip(number: int) -> SetEffector:
    return SetEffector(id=f"7-{number}", robot="ra1", on=True)


def test_a_restarted_bridge_starts_above_what_the_board_has_heard(bench, sent, reports) -> None:
    bench.connect()
    (report,) = reports(bench.tell(ack_epoch=EPOCH + 5, ack=1, done=1))
    assert (report.epoch, report.accepted, report.done) == (EPOCH + 6, None, None)
    assert sent(bench.order(grip(1))) == [("ra_1/efector", EffectorGoal(on=True, seq=1, epoch=EPOCH + 6))]


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
    assert sent(linked.order(grip(2))) == [("ra_1/efector", EffectorGoal(on=True, seq=2, epoch=EPOCH + 10))]


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
