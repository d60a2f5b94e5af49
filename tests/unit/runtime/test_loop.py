"""The loop steps once per waking with everything that waits; time is moved by hand."""

from __future__ import annotations

import pytest
from tests.threads import AtOnce, stand_in

from arboleda.model.errors import ArboledaError
from arboleda.runtime import loop as module
from arboleda.runtime.loop import Loop

from .echo import Clock, read
from .echo import clock as clock
from .echo import machine as machine


class Outside:
    """What happens while the loop sleeps: one act after the other, and after the last one the loop ends."""

    def __init__(self, clock: Clock) -> None:
        self.asked: list[float | None] = []  # for how long the loop wants to sleep
        self.acts = []
        self._clock = clock

    def __call__(self, condition, timeout):
        self.asked.append(timeout)
        if self.acts:
            self.acts.pop(0)()
        elif timeout is None:
            self.loop.stop()
        else:
            self._clock.now += timeout


@pytest.fixture
def sent():
    return []


@pytest.fixture
def outside(clock):
    return Outside(clock)


@pytest.fixture
def make(machine, clock, sent, outside, monkeypatch):
    """Makes a loop that runs in this thread, from its start to its end."""
    stand_in(module, AtOnce, monkeypatch)

    def make_one(**options):
        given = {"clock": clock, "wait": outside, **options}
        outside.loop = Loop("echo", machine, given.pop("send", sent.append), **given)
        return outside.loop

    return make_one


def test_one_step_takes_everything_that_waits_at_one_time(make, machine, clock, sent):
    loop = make()
    loop.post("a")
    loop.post("b")
    loop.turn()
    assert machine.steps == [(10.0, ("a", "b"))]
    assert clock.looks == 1
    assert sent == ["a", "b"]


def test_an_event_that_may_wait_is_stepped_with_the_next_one_in_its_place(make, outside, machine):
    loop = make()
    outside.acts = [
        lambda: loop.post("a", within_s=60.0),
        lambda: loop.post("b", within_s=60.0),
        lambda: loop.post("c"),
    ]
    loop.start()
    assert machine.steps == [(10.0, ("a", "b", "c"))]


def test_an_event_that_may_wait_past_the_next_deadline_lets_it_sleep_on(make, machine, outside):
    machine.alarm = 11.0
    loop = make()
    outside.acts = [lambda: loop.post("a", within_s=2.0), lambda: loop.post("b")]
    loop.start()
    assert machine.steps[0] == (10.0, ("a", "b"))
    assert outside.asked[:2] == [1.0, 1.0]


def test_an_event_waits_no_longer_than_it_may(make, machine):
    loop = make()
    loop.post("a", within_s=0.5)
    loop.post("b", within_s=0.25)
    loop.post("c", within_s=0.75)
    loop.start()
    assert machine.steps == [(10.25, ("a", "b", "c"))]


def test_a_deadline_wakes_it_and_it_sleeps_no_longer_than_that(make, machine, outside):
    machine.alarm = 12.5
    make().start()
    assert outside.asked[0] == 2.5
    assert machine.steps == [(12.5, ())]


def test_waking_early_steps_nothing(make, machine, clock, outside):
    def wake_early():
        clock.now += 1.0

    machine.alarm = 13.0
    outside.acts = [wake_early, wake_early]
    make().start()
    assert machine.steps == [(13.0, ())]


def test_a_deadline_that_has_passed_needs_no_sleep(make, machine, outside):
    machine.alarm = 1.0
    make().start()
    assert machine.steps == [(10.0, ())]
    assert outside.asked == [None]


def test_stopping_steps_what_was_posted_and_no_more(make, machine, sent):
    loop = make()
    loop.post("a")
    loop.stop()
    loop.stop()
    loop.post("late")
    loop.start()
    assert sent == ["a"]


def test_one_that_is_stopped_before_its_start_steps_nothing(make, machine):
    loop = make()
    loop.stop()
    loop.post("late")
    loop.start()
    assert machine.steps == []


def test_a_message_that_cannot_be_sent_is_handed_back_and_the_rest_goes_on(make, sent):
    failed = []

    def send(message):
        if message == "bad":
            raise ArboledaError("no link")
        sent.append(message)

    loop = make(send=send, on_send_error=lambda message, error: failed.append((message, str(error))))
    for message in ("bad", "good"):
        loop.post(message)
    loop.turn()
    assert sent == ["good"]
    assert failed == [("bad", "no link")]


def test_without_a_handler_an_unsent_message_is_logged(make, caplog):
    def send(_message):
        raise ArboledaError("no link")

    loop = make(send=send)
    loop.post("a")
    loop.turn()
    assert caplog.messages == ["a was not sent: no link"]


def test_without_a_handler_a_crash_is_one_line(make, caplog):
    loop = make()
    loop.post("crash")
    loop.start()
    assert caplog.messages == ["echo has stopped on an internal error: ZeroDivisionError('by design')"]


def test_what_comes_out_of_a_step_is_sent_in_the_order_that_is_wanted(make, sent):
    steps = []
    loop = make(arrange=lambda messages: messages[::-1], on_step=lambda *step: steps.append(step))
    loop.post("a")
    loop.post("b")
    loop.turn()
    assert sent == ["b", "a"]
    assert steps == [(10.0, ("a", "b"), ["a", "b"])]


def test_nobody_waits_for_a_step_longer_than_he_will(make, clock):
    found = []

    def send(message):
        clock.now += 1.0
        read(loop, found)

    loop = make(send=send)
    loop.post("a")
    loop.turn()
    read(loop, found)
    assert found == ["under way", 1]


def test_it_is_busy_from_the_taking_in_to_the_end_of_what_follows_a_step(make):
    seen = []
    loop = make(send=lambda message: seen.append(loop.busy), on_step=lambda *_: seen.append(loop.busy))
    assert not loop.busy
    loop.post("a")
    loop.turn()
    assert seen == [True, True] and not loop.busy


def test_an_observer_sees_every_step(make):
    seen = []
    loop = make(on_step=lambda *step: seen.append(step))
    loop.post("a")
    loop.turn()
    assert seen == [(10.0, ("a",), ["a"])]


def test_an_observer_may_ask_for_another_step_before_the_next_deadline(make, machine):
    def ask(now, events, messages):
        if now < 11.0:
            loop.wake_by(11.0)

    machine.alarm = 12.5
    loop = make(on_step=ask)
    loop.post("a")
    loop.start()
    assert machine.steps == [(10.0, ("a",)), (11.0, ()), (12.5, ())]


def test_a_sender_may_read_and_post(make, sent):
    def send(message):
        sent.append((message, loop.read(lambda echo: len(echo.steps))))
        if message == "a":
            loop.post("b")

    loop = make(send=send)
    loop.post("a")
    loop.start()
    assert sent == [("a", 1), ("b", 2)]
