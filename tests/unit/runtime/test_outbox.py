"""What is handed to a receiver: in order, never in anybody's way, and nothing lost without a word."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from tests.threads import AtOnce, stand_in

from arboleda.adapters.webhook import DeliveryRefused, NotDelivered
from arboleda.runtime.parts import outbox as module
from arboleda.runtime.parts.outbox import Outbox


class Receiver:
    """Takes what comes, or raises what `trouble` has for it; the plant ends once it has the `last`."""

    def __init__(self) -> None:
        self.taken: list[dict[str, Any]] = []
        self.tries = 0
        self.last = "b"
        self.trouble: Callable[[dict[str, Any]], Exception | None] = lambda alarm: None
        self.meanwhile: Callable[[], None] = lambda: None  # what happens while the first is on its way
        self.at_the_end: Callable[[], None] = lambda: None
        self.closed = False

    def __str__(self) -> str:
        return "the receiver"

    def post(self, what: dict[str, Any]) -> None:
        self.tries += 1
        if self.tries == 1:
            self.meanwhile()
        if trouble := self.trouble(what):
            raise trouble
        self.taken.append(what)
        if what["id"] == self.last:
            self.at_the_end()

    def close(self) -> None:
        self.closed = True

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
def outbox(receiver: Receiver, pauses: list[float], monkeypatch: pytest.MonkeyPatch) -> Outbox:
    """One that does all its work as it is started."""
    stand_in(module, AtOnce, monkeypatch)
    made = Outbox(receiver, limit=3, wait=lambda ending, seconds: pauses.append(seconds))
    receiver.at_the_end = made.end
    return made


def alarm(id: str) -> dict[str, Any]:
    return {"id": id}


def test_alarms_arrive_in_order(outbox: Outbox, receiver: Receiver) -> None:
    receiver.last = "c"
    for id in "abc":
        outbox.put(alarm(id))
    outbox.start()
    assert receiver.ids == ["a", "b", "c"]
    assert all(each["dropped"] == 0 for each in receiver.taken)


def test_one_that_did_not_arrive_is_tried_again_more_and_more_slowly_and_said_once(
    outbox: Outbox, receiver: Receiver, pauses: list[float], caplog: pytest.LogCaptureFixture
) -> None:
    receiver.trouble = lambda alarm: NotDelivered("no answer within 5 s") if receiver.tries < 9 else None
    outbox.put(alarm("a"))
    outbox.put(alarm("b"))
    outbox.start()
    assert receiver.ids == ["a", "b"]
    assert pauses == [1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 60.0, 60.0]
    outbox.stop()
    assert [line.message for line in caplog.records] == [
        "alarms do not reach the receiver (no answer within 5 s); they wait, trying again",
        "alarms reach the receiver again",
    ]


def test_whatever_a_receiver_raises_is_tried_again(outbox: Outbox, receiver: Receiver) -> None:
    receiver.trouble = lambda alarm: RuntimeError("a defect") if receiver.tries == 1 else None
    receiver.last = "a"
    outbox.put(alarm("a"))
    outbox.start()
    assert receiver.ids == ["a"]


def test_one_that_is_refused_is_said_and_does_not_stand_in_the_way(
    outbox: Outbox, receiver: Receiver, caplog: pytest.LogCaptureFixture
) -> None:
    receiver.trouble = lambda alarm: DeliveryRefused("it answers 422") if alarm["id"] == "a" else None
    outbox.put(alarm("a"))
    outbox.put(alarm("b"))
    outbox.start()
    assert receiver.ids == ["b"]
    assert "the receiver refuses the alarm a (it answers 422): it is dropped" in caplog.text


def test_what_does_not_fit_is_dropped_and_said(
    outbox: Outbox, receiver: Receiver, caplog: pytest.LogCaptureFixture
) -> None:
    receiver.last = "6"
    receiver.meanwhile = lambda: [outbox.put(alarm(id)) for id in "123456"]
    receiver.trouble = lambda alarm: NotDelivered("slow") if receiver.tries == 1 else None
    outbox.put(alarm("0"))
    outbox.start()
    assert receiver.ids == ["4", "5", "6"]
    assert [each["dropped"] for each in receiver.taken] == [4, 0, 0]
    outbox.stop()
    assert "3 alarms wait for the receiver: the oldest are dropped" in caplog.text
    assert caplog.text.count("4 alarms for the receiver were dropped: 0 to 3") == 1


def test_one_that_arrives_after_it_made_room_does_not_count_as_dropped(
    outbox: Outbox, receiver: Receiver
) -> None:
    receiver.last = "4"
    receiver.meanwhile = lambda: [outbox.put(alarm(id)) for id in "1234"]
    outbox.put(alarm("0"))
    outbox.start()
    assert receiver.ids == ["0", "2", "3", "4"]
    assert [each["dropped"] for each in receiver.taken] == [0, 1, 0, 0]


def test_at_the_end_what_waits_is_tried_once_more_and_what_is_left_is_said(
    outbox: Outbox, receiver: Receiver, caplog: pytest.LogCaptureFixture
) -> None:
    receiver.trouble = lambda alarm: NotDelivered("gone")
    outbox.put(alarm("a"))
    outbox.put(alarm("b"))
    outbox.end()
    outbox.start()
    outbox.stop()
    outbox.stop()
    assert caplog.text.count("2 alarms did not reach the receiver: a to b") == 1
    assert receiver.closed


def test_what_waits_arrives_before_the_end_where_the_receiver_is_well(
    outbox: Outbox, receiver: Receiver, caplog: pytest.LogCaptureFixture
) -> None:
    for id in "abc":
        outbox.put(alarm(id))
    outbox.end()
    outbox.start()
    assert receiver.ids == ["a", "b", "c"] and not caplog.records
