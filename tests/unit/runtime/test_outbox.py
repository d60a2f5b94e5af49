"""What is handed to a receiver: in order, never in anybody's way, and nothing lost without a word."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from arboleda.adapters.webhook import DeliveryRefused, NotDelivered
from arboleda.runtime.parts.outbox import Outbox

from ...patience import PATIENCE_S


class Receiver:
    """Takes what comes, or raises what `trouble` has for it; `gate` makes it slow."""

    def __init__(self) -> None:
        self.taken: list[dict[str, Any]] = []
        self.tries = 0
        self.trouble: Callable[[dict[str, Any]], Exception | None] = lambda alarm: None
        self.gate = threading.Event()
        self.gate.set()
        self.busy = threading.Event()
        self.closed = threading.Event()
        self.changed = threading.Condition()

    def __str__(self) -> str:
        return "the receiver"

    def post(self, what: dict[str, Any]) -> None:
        self.busy.set()
        assert self.gate.wait(PATIENCE_S)
        with self.changed:
            self.tries += 1
            trouble = self.trouble(what)
            if trouble is None:
                self.taken.append(what)
            self.changed.notify_all()
        if trouble is not None:
            raise trouble

    def close(self) -> None:
        self.closed.set()

    def wait(self, until: Callable[[], bool]) -> None:
        with self.changed:
            assert self.changed.wait_for(until, PATIENCE_S), (self.tries, self.taken)

    @property
    def ids(self) -> list[str]:
        return [alarm["id"] for alarm in self.taken]


@pytest.fixture
def receiver() -> Receiver:
    return Receiver()


@pytest.fixture
def pauses() -> list[float]:
    """How long it would have waited before each new try."""
    return []


@pytest.fixture
def outbox(receiver: Receiver, pauses: list[float]) -> Iterator[Outbox]:
    made = Outbox(receiver, limit=3, wait=lambda ending, seconds: pauses.append(seconds))
    yield made
    receiver.trouble = lambda alarm: None
    receiver.gate.set()
    made.stop()


def alarm(id: str) -> dict[str, Any]:
    return {"id": id}


def test_alarms_arrive_in_order(outbox: Outbox, receiver: Receiver) -> None:
    outbox.start()
    for id in "abc":
        outbox.put(alarm(id))
    receiver.wait(lambda: receiver.ids == ["a", "b", "c"])
    assert all(each["dropped"] == 0 for each in receiver.taken)


def test_one_that_did_not_arrive_is_tried_again_more_and_more_slowly_and_said_once(
    outbox: Outbox, receiver: Receiver, pauses: list[float], caplog: pytest.LogCaptureFixture
) -> None:
    receiver.trouble = lambda alarm: NotDelivered("no answer within 5 s") if receiver.tries < 9 else None
    outbox.start()
    outbox.put(alarm("a"))
    outbox.put(alarm("b"))
    receiver.wait(lambda: receiver.ids == ["a", "b"])
    assert pauses == [1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 60.0, 60.0]
    outbox.stop()
    assert [line.message for line in caplog.records] == [
        "alarms do not reach the receiver (no answer within 5 s); they wait, trying again",
        "alarms reach the receiver again",
    ]


def test_whatever_a_receiver_raises_is_tried_again(outbox: Outbox, receiver: Receiver) -> None:
    receiver.trouble = lambda alarm: RuntimeError("a defect") if receiver.tries == 1 else None
    outbox.start()
    outbox.put(alarm("a"))
    receiver.wait(lambda: receiver.ids == ["a"])


def test_one_that_is_refused_is_said_and_does_not_stand_in_the_way(
    outbox: Outbox, receiver: Receiver, caplog: pytest.LogCaptureFixture
) -> None:
    receiver.trouble = lambda alarm: DeliveryRefused("it answers 422") if alarm["id"] == "a" else None
    outbox.start()
    outbox.put(alarm("a"))
    outbox.put(alarm("b"))
    receiver.wait(lambda: receiver.ids == ["b"])
    assert "the receiver refuses the alarm a (it answers 422): it is dropped" in caplog.text


def test_who_puts_one_in_never_waits_and_what_does_not_fit_is_said(
    outbox: Outbox, receiver: Receiver, caplog: pytest.LogCaptureFixture
) -> None:
    receiver.gate.clear()
    outbox.start()
    outbox.put(alarm("0"))
    assert receiver.busy.wait(PATIENCE_S)  # 0 is on its way, and the receiver takes its time
    receiver.trouble = lambda alarm: NotDelivered("slow") if receiver.tries == 1 else None
    for id in "123456":
        outbox.put(alarm(id))
    receiver.gate.set()
    receiver.wait(lambda: receiver.ids == ["4", "5", "6"])
    assert [each["dropped"] for each in receiver.taken] == [4, 0, 0]
    outbox.stop()
    assert "3 alarms wait for the receiver: the oldest are dropped" in caplog.text
    assert caplog.text.count("4 alarms for the receiver were dropped: 0 to 3") == 1


def test_one_that_arrives_after_it_made_room_does_not_count_as_dropped(
    outbox: Outbox, receiver: Receiver
) -> None:
    receiver.gate.clear()
    outbox.start()
    outbox.put(alarm("0"))
    assert receiver.busy.wait(PATIENCE_S)
    for id in "1234":
        outbox.put(alarm(id))
    receiver.gate.set()
    receiver.wait(lambda: receiver.ids == ["0", "2", "3", "4"])
    assert [each["dropped"] for each in receiver.taken] == [0, 1, 0, 0]


def test_at_the_end_what_waits_is_tried_once_more_and_what_is_left_is_said(
    outbox: Outbox, receiver: Receiver, caplog: pytest.LogCaptureFixture
) -> None:
    receiver.trouble = lambda alarm: NotDelivered("gone")
    outbox.put(alarm("a"))
    outbox.put(alarm("b"))
    outbox.start()
    receiver.wait(lambda: receiver.tries > 0)
    outbox.stop()
    outbox.stop()
    assert caplog.text.count("2 alarms did not reach the receiver: a to b") == 1
    assert receiver.closed.is_set()


def test_what_waits_arrives_before_the_end_where_the_receiver_is_well(
    outbox: Outbox, receiver: Receiver, caplog: pytest.LogCaptureFixture
) -> None:
    for id in "abc":
        outbox.put(alarm(id))
    outbox.start()
    outbox.stop()
    assert receiver.ids == ["a", "b", "c"] and not caplog.records
