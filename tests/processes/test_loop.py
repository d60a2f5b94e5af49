"""The thread of a loop: what wakes it, what ends it, and who reads beside it."""

from __future__ import annotations

import threading

import pytest

from arboleda.runtime.loop import Loop

from ..patience import PATIENCE_S
from ..unit.runtime.echo import clock as clock
from ..unit.runtime.echo import machine as machine
from ..unit.runtime.echo import read


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
