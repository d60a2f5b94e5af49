"""The loop steps once per waking with everything that waits; time is moved by hand."""

from __future__ import annotations

import threading

import pytest

from arboleda.runtime.loop import Loop, StepInFlight

from ..patience import PATIENCE_S


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


def test_an_event_wakes_it(make, sent):
    loop = make()
    loop.start()
    loop.post("a")
    sent.wait("a")
    loop.post("b")
    sent.wait("a", "b")


def test_a_crash_ends_the_loop_and_is_handed_over(make, machine):
    crashes, crashed = [], threading.Event()

    def on_crash(name, error):
        crashes.append((name, error))
        loop.stop()  # from its own thread: must not wait for itself
        crashed.set()

    loop = make(on_crash=on_crash)
    loop.start()
    loop.post("crash")
    assert crashed.wait(PATIENCE_S)
    loop.post("after")
    loop.stop()
    ((name, error),) = crashes
    assert name == "echo"
    assert isinstance(error, ZeroDivisionError)
    assert [events for _now, events in machine.steps] == [("crash",)]
    assert loop.read(lambda echo: echo.alarm) is None


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
        assert reader.wait(PATIENCE_S)
        assert found == []

    threads: list[threading.Thread] = []
    loop = make(send=send)
    read(loop, found)
    assert found.pop() == 0
    loop.post("a")
    loop.turn()
    threads[0].join(PATIENCE_S)
    assert found == [1]


def test_reading_happens_between_two_steps(make, machine, sent):
    loop = make()
    loop.start()
    inside, leave = threading.Event(), threading.Event()

    def look(echo):
        inside.set()
        leave.wait(PATIENCE_S)
        return len(echo.steps)

    result = []
    reader = threading.Thread(target=lambda: result.append(loop.read(look)))
    reader.start()
    assert inside.wait(PATIENCE_S)
    loop.post("a")
    assert machine.steps == []
    leave.set()
    reader.join()
    sent.wait("a")
    assert result == [0]
