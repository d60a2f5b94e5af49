"""A stop on the line of a PLC that is polled: whatever waits, it is the next telegram, and nothing is
completed."""

from __future__ import annotations

import threading
from collections.abc import Callable, Hashable, Iterator
from queue import Queue
from types import SimpleNamespace
from typing import Any

import pytest
from tests.patience import PATIENCE_S

from arboleda.drivers import Command, NotSent, Report, Stop, StopMode
from arboleda_drivers.plc import polled
from arboleda_drivers.plc.plc_snapshot import Writing
from arboleda_drivers.plc.polled import RequestRefused

GO: Any = SimpleNamespace(id="9-1", robot="press")
HALT = Stop(id="9-2", robot="press", mode=StopMode.HALT)


class Telegrams(polled.Line):
    """A line on which each telegram waits for its answer until a test gives it."""

    def __init__(self) -> None:
        super().__init__()
        self.sent: Queue[str] = Queue()
        self._answers: Queue[Callable[[], None]] = Queue()
        self._is_free = False
        self.hung_up = 0

    def hang_up(self) -> None:
        self.hung_up += 1

    def ask(self, telegram: str) -> None:
        with self.turn():
            self.sent.put(telegram)
            if not self._is_free:
                self._answers.get(timeout=PATIENCE_S)()

    def next(self) -> str:
        """The telegram on the line, which has no answer yet."""
        return self.sent.get(timeout=PATIENCE_S)

    def answer(self, how: Callable[[], None] = lambda: None) -> None:
        """Have it answered; `how` is done with the line still held."""
        self._answers.put(how)

    def refuse(self) -> None:
        raise RequestRefused("the PLC refuses to take it", "busy")

    def answer_all(self) -> None:
        """Have the telegram on the line answered, and all that come."""
        self._is_free = True
        self.answer()


class Press(polled.Polled[Any, Telegrams, str]):
    """A device of three telegrams an order, two a stop, and one a poll, which a test asks for."""

    protocol = "press"
    lines: polled.Lines[Telegrams] = polled.Lines()

    def __init__(self, line: Telegrams, begins_last: bool = True) -> None:
        super().__init__(SimpleNamespace(poll_s=PATIENCE_S, timeout_s=0.1, peer="the PLC"))
        self.its_line, self._begins_last = line, begins_last
        self.heard: list[Report] = []
        self.ready = threading.Event()

    def prepare(self, device: object) -> None:
        """Nothing to make."""

    def address(self) -> Hashable:
        return id(self.its_line)

    def make_line(self) -> Telegrams:
        return self.its_line

    def begin(self, line: Telegrams) -> None:
        """It is there."""

    def reads(self, line: Telegrams) -> Iterator[None]:
        self.ready.set()
        if self._said:
            line.ask("read")
        self._said = True
        yield

    _said = False

    def report(self, at: float) -> Report:
        return Report(at=at, robot="press")

    def writing(self, command: Command) -> Writing[str]:
        puts = ("halt", "drop") if isinstance(command, Stop) else ("place", "speed", "number")
        return Writing(puts=puts, begins_last=self._begins_last)

    def write(self, line: Telegrams, put: str) -> None:
        line.ask(put)

    def heartbeat(self, number: int) -> None:
        """None."""

    def poll(self) -> None:
        """Have it read once more."""
        self._wake.set()


class Sending:
    """A command that is being sent in a thread of its own, and what came of it."""

    def __init__(self, driver: Press, command: Command) -> None:
        self._ended: Queue[Exception | None] = Queue()
        self._driver, self._command = driver, command
        threading.Thread(target=self._run, daemon=True).start()

    def _run(self) -> None:
        try:
            self._driver.send(self._command)
        except Exception as error:  # noqa: BLE001 - the test looks at it
            self._ended.put(error)
        else:
            self._ended.put(None)

    @property
    def error(self) -> Exception | None:
        return self._ended.get(timeout=PATIENCE_S)


@pytest.fixture
def line() -> Telegrams:
    return Telegrams()


def begun(line: Telegrams, *, begins_last: bool = True) -> Press:
    made = Press(line, begins_last)
    device: Any = SimpleNamespace(name="press")
    made.start([device], made.heard.append, lambda: 10.0 + len(made.heard))
    assert made.ready.wait(PATIENCE_S)
    while not made.heard:
        threading.Event().wait(0.001)
    return made


@pytest.fixture
def press(line: Telegrams) -> Iterator[Press]:
    made = begun(line)
    yield made
    line.answer_all()
    made.stop()


def test_an_order_that_is_half_written_is_not_completed_and_the_stop_is_next(
    line: Telegrams, press: Press
) -> None:
    order = Sending(press, GO)
    assert line.next() == "place"
    press.interrupt("press")
    line.answer()
    error = order.error
    assert isinstance(error, NotSent) and str(error) == "a stop came first"
    stop = Sending(press, HALT)
    assert [line.next(), line.answer(), line.next(), line.answer()] == ["halt", None, "drop", None]
    assert stop.error is None


def test_a_poll_and_another_devices_order_wait_until_the_stop_has_left(line: Telegrams, press: Press) -> None:
    other = begun(line)
    order = Sending(other, GO)
    assert line.next() == "place"
    press.interrupt("press")
    press.poll()
    line.answer()
    stop = Sending(press, HALT)
    for telegram in ("halt", "drop"):
        assert line.next() == telegram
        line.answer()
    assert stop.error is None
    line.answer_all()
    assert order.error is None
    assert [each for each in line.sent.queue if each != "read"] == ["speed", "number"]
    other.stop()


def test_an_order_does_not_go_on_over_another_connection(line: Telegrams, press: Press) -> None:
    order = Sending(press, GO)
    assert line.next() == "place"
    line.answer(line.close)
    error = order.error
    assert isinstance(error, NotSent) and str(error) == "the PLC was lost meanwhile" and line.sent.empty()


def test_of_an_order_that_begins_at_once_nobody_says_that_nothing_has_left(line: Telegrams) -> None:
    press = begun(line, begins_last=False)
    order = Sending(press, GO)
    assert line.next() == "place"
    line.answer()
    assert line.next() == "speed"
    press.interrupt("press")
    line.answer()
    assert order.error is None  # it counts as given; the stop follows
    stop = Sending(press, HALT)
    assert line.next() == "halt"
    line.answer_all()
    assert stop.error is None
    press.stop()


def test_a_stop_that_is_refused_ends_the_connection(line: Telegrams, press: Press) -> None:
    stop = Sending(press, HALT)
    assert line.next() == "halt"
    line.answer(line.refuse)
    error = stop.error
    assert isinstance(error, ConnectionError) and "it was a stop" in str(error) and line.hung_up


def test_a_driver_that_ends_holds_nobody_back(line: Telegrams) -> None:
    ended, other = begun(line), begun(line)
    ended.interrupt("press")
    ended.stop()
    line.answer_all()
    assert Sending(other, GO).error is None
    other.stop()
