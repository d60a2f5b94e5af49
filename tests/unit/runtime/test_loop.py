"""The loop steps once per waking with everything that waits; time is moved by hand."""

from __future__ import annotations

import threading

import pytest

from arboleda.model.errors import ArboledaError
from arboleda.runtime.loop import Loop, StepInFlight

from ...patience import PATIENCE_S


class Echo:
    """Answers each event with itself; `alarm` is its next deadline, which it answers once."""

    def __init__(self) -> None:
        self.steps: list[tuple[float, tuple]] = []
        self.alarm: float | None = None

    @property
    def next_deadline(self) -> float | None:
        return self.alarm

    def step(self, now, events):
        self.steps.append((now, tuple(events)))
        rings = self.alarm is not None and now >= self.alarm
        if rings:
            self.alarm = None
        if "crash" in events:
            raise ZeroDivisionError("by design")
        return [*events, *(["ring"] if rings else [])]


class Clock:
    """Stands still until it is moved; counts who looks."""

    def __init__(self) -> None:
        self.now = 10.0
        self.looks = 0

    def __call__(self) -> float:
        self.looks += 1
        return self.now


class Sent(list):
    """What the loop sent, which a test can wait for."""

    def __init__(self) -> None:
        self._more = threading.Condition()

    def put(self, message) -> None:
        with self._more:
            self.append(message)
            self._more.notify_all()

    def wait(self, *messages) -> None:
        with self._more:
            assert self._more.wait_for(lambda: self == list(messages), timeout=PATIENCE_S), self


@pytest.fixture
def machine():
    return Echo()


@pytest.fixture
def clock():
    return Clock()


@pytest.fixture
def sent():
    return Sent()


@pytest.fixture
def make(machine, clock, sent):
    """Makes loops and stops them."""
    made = []

    def make_one(**options):
        made.append(Loop("echo", machine, options.pop("send", sent.put), **{"clock": clock, **options}))
        return made[-1]

    yield make_one
    for loop in made:
        loop.stop()


def test_one_step_takes_everything_that_waits_at_one_time(make, machine, clock, sent):
    loop = make()
    loop.post("a")
    loop.post("b")
    loop.turn()
    assert machine.steps == [(10.0, ("a", "b"))]
    assert clock.looks == 1
    assert sent == ["a", "b"]


def test_an_event_that_may_wait_is_stepped_with_the_next_one_in_its_place(make, sent, machine):
    loop = make(wait=lambda condition, timeout: condition.wait())
    loop.start()
    loop.post("a", within_s=60.0)
    loop.post("b", within_s=60.0)
    loop.post("c")
    sent.wait("a", "b", "c")
    assert machine.steps == [(10.0, ("a", "b", "c"))]


def test_an_event_that_may_wait_past_the_next_deadline_wakes_nobody(make, machine, sent):
    asked = []

    def wait(condition, timeout):
        asked.append(timeout)
        condition.wait()

    machine.alarm = 11.0
    loop = make(wait=wait)
    loop.start()
    loop.post("a", within_s=2.0)
    loop.post("b")
    sent.wait("a", "b")
    assert set(asked) <= {1.0}


def test_an_event_waits_no_longer_than_it_may(make, machine, clock, sent):
    def wait(condition, timeout):
        if timeout is None:
            condition.wait()
        else:
            clock.now += timeout

    loop = make(wait=wait)
    loop.post("a", within_s=0.5)
    loop.post("b", within_s=0.25)
    loop.post("c", within_s=0.75)
    loop.start()
    sent.wait("a", "b", "c")
    assert machine.steps == [(10.25, ("a", "b", "c"))]


def test_an_event_wakes_it(make, sent):
    loop = make()
    loop.start()
    loop.post("a")
    sent.wait("a")
    loop.post("b")
    sent.wait("a", "b")


def test_a_deadline_wakes_it_and_it_sleeps_no_longer_than_that(make, machine, clock, sent):
    asked = []

    def wait(condition, timeout):
        asked.append(timeout)
        if timeout is None:
            condition.wait()
        else:
            clock.now += timeout

    machine.alarm = 12.5
    make(wait=wait).start()
    sent.wait("ring")
    assert asked[0] == 2.5
    assert machine.steps == [(12.5, ())]


def test_waking_early_steps_nothing(make, machine, clock, sent):
    def wait(condition, timeout):
        if timeout is None:
            condition.wait()
        else:
            clock.now += 1.0

    machine.alarm = 13.0
    make(wait=wait).start()
    sent.wait("ring")
    assert machine.steps == [(13.0, ())]


def test_a_deadline_that_has_passed_needs_no_sleep(make, machine, sent):
    machine.alarm = 1.0
    make().start()
    sent.wait("ring")


def test_stopping_steps_what_was_posted_and_no_more(make, machine, sent):
    loop = make()
    loop.post("a")
    loop.start()
    loop.stop()
    loop.stop()
    loop.post("late")
    loop.turn()
    assert "a" in sent
    assert "late" not in sent


def test_it_can_be_stopped_before_it_was_started(make):
    make().stop()


def test_a_message_that_cannot_be_sent_is_handed_back_and_the_rest_goes_on(make, sent):
    failed = []

    def send(message):
        if message == "bad":
            raise ArboledaError("no link")
        sent.put(message)

    loop = make(send=send, on_send_error=lambda message, error: failed.append((message, str(error))))
    loop.start()
    for message in ("bad", "good"):
        loop.post(message)
    sent.wait("good")
    assert failed == [("bad", "no link")]


def test_without_a_handler_an_unsent_message_is_logged(make, caplog):
    def send(_message):
        raise ArboledaError("no link")

    loop = make(send=send)
    loop.post("a")
    loop.turn()
    assert caplog.messages == ["a was not sent: no link"]


def test_a_crash_ends_the_loop_and_is_handed_over(make, machine):
    crashes, crashed = [], threading.Event()

    def on_crash(name, error):
        crashes.append((name, error))
        loop.stop()  # from its own thread: must not wait for itself
        crashed.set()

    loop = make(on_crash=on_crash)
    loop.start()
    loop.post("crash")
    assert crashed.wait(5)
    loop.post("after")
    loop.stop()
    ((name, error),) = crashes
    assert name == "echo"
    assert isinstance(error, ZeroDivisionError)
    assert [events for _now, events in machine.steps] == [("crash",)]
    assert loop.read(lambda echo: echo.alarm) is None


def test_without_a_handler_a_crash_is_one_line(make, caplog):
    loop = make()
    loop.post("crash")
    loop.start()
    loop.stop()
    assert caplog.messages == ["echo has stopped on an internal error: ZeroDivisionError('by design')"]


def test_what_comes_out_of_a_step_is_sent_in_the_order_that_is_wanted(make, sent):
    steps = []
    loop = make(arrange=lambda messages: messages[::-1], on_step=lambda *step: steps.append(step))
    loop.post("a")
    loop.post("b")
    loop.turn()
    assert sent == ["b", "a"]
    assert steps == [(10.0, ("a", "b"), ["a", "b"])]


def read(loop: Loop, found: list) -> None:
    try:
        found.append(loop.read_handed_on(lambda machine: len(machine.steps), within_s=1.0))
    except StepInFlight:
        found.append("under way")


def test_a_step_is_read_once_what_came_out_of_it_is_sent(make, clock):
    found, reader = [], threading.Event()

    def send(message):
        thread = threading.Thread(target=lambda: (reader.set(), read(loop, found)))
        thread.start()
        threads.append(thread)
        assert reader.wait(5)
        assert found == []

    threads: list[threading.Thread] = []
    loop = make(send=send)
    read(loop, found)
    assert found.pop() == 0
    loop.post("a")
    loop.turn()
    threads[0].join(5)
    assert found == [1]


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


def test_an_observer_may_ask_for_another_step_before_the_next_deadline(make, machine, clock, sent):
    def wait(condition, timeout):
        if timeout is None:
            condition.wait()
        else:
            clock.now += timeout

    def ask(now, events, messages):
        if now < 11.0:
            loop.wake_by(11.0)

    machine.alarm = 12.5
    loop = make(wait=wait, on_step=ask)
    loop.post("a")
    loop.start()
    sent.wait("a", "ring")
    assert machine.steps == [(10.0, ("a",)), (11.0, ()), (12.5, ())]


def test_reading_happens_between_two_steps(make, machine, sent):
    loop = make()
    loop.start()
    inside, leave = threading.Event(), threading.Event()

    def look(echo):
        inside.set()
        leave.wait(5)
        return len(echo.steps)

    result = []
    reader = threading.Thread(target=lambda: result.append(loop.read(look)))
    reader.start()
    assert inside.wait(5)
    loop.post("a")
    assert machine.steps == []
    leave.set()
    reader.join()
    sent.wait("a")
    assert result == [0]


def test_a_sender_may_read_and_post(make, sent):
    def send(message):
        sent.put((message, loop.read(lambda echo: len(echo.steps))))
        if message == "a":
            loop.post("b")

    loop = make(send=send)
    loop.start()
    loop.post("a")
    sent.wait(("a", 1), ("b", 2))
