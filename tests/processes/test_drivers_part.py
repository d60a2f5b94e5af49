"""Drivers in threads of their own: whatever one of them does, the plant hears of it and goes on."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import pytest

from arboleda.adapters.broker_login import address
from arboleda.drivers import Clock, Command, Hear, NotSent, Stop, StopMode
from arboleda.model.messages import Heartbeat, MotionState, Report, Undelivered
from arboleda.model.plant_model import DriverUse, Link, PlantModel, Robot, Timing
from arboleda.runtime.parts.broker import OtherBroker
from arboleda.runtime.parts.drivers import DriversPart

from ..patience import PATIENCE_S
from ..unit.kinds.station import STATION, plant

EPOCH = 9
BROKER = OtherBroker(address("10.0.0.5:1883"), None)
GO = STATION.command(id="9-1", robot="station", verb="go", values={})
LIGHT = STATION.command(id="9-2", robot="station", verb="light", values={"on": True})
HALT = Stop(id="9-3", robot="station", mode=StopMode.HALT)


class Tame:
    """A driver that does as it is told, and writes down what that was."""

    def __init__(self) -> None:
        self.sent: queue.Queue[Command] = queue.Queue()
        self.stopped = threading.Event()

    def start(self, devices: Sequence[Robot], hear: Hear, clock: Clock) -> None:
        (self.device,) = devices
        self.hear, self.clock = hear, clock
        self.speak()

    def speak(self) -> None:
        self.hear(Report(at=self.clock(), robot=self.device.name, state=MotionState.STOPPED))

    def send(self, command: Command) -> None:
        self.sent.put(command)

    def stop(self) -> None:
        self.stopped.set()


class Plant:
    """What a plant hears of a part with one driver."""

    def __init__(self, *drivers: Any, stale_after_s: float = 60.0) -> None:
        self.made: list[Any] = []
        waiting = list(drivers)

        def make() -> Any:
            self.made.append(waiting.pop(0) if waiting else drivers[-1])
            return self.made[-1]

        use = DriverUse(name="plc", make=make)
        model = plant()
        cells = tuple(
            cell.with_robots(lambda robot: replace(robot, link=Link.DRIVER, driver=use))
            for cell in model.cells
        )
        timing = Timing(stale_after_s=stale_after_s)
        self.crashes: list[BaseException] = []
        model = PlantModel(name="lab", cells=cells, timing=timing)
        self.part = DriversPart(model, EPOCH, lambda name, error: self.crashes.append(error), BROKER)
        self.heard: queue.Queue[Report | Undelivered] = queue.Queue()
        self.part.connect(self.heard.put)

    def hears(self, holds: Callable[[Any], bool]) -> Any:
        """The next of what it hears of which this is true."""
        while not holds(event := self.heard.get(timeout=PATIENCE_S)):
            pass
        return event

    def is_up(self) -> None:
        self.hears(lambda event: isinstance(event, Report) and event.state is MotionState.STOPPED)

    def is_lost(self) -> str:
        """Why its device has no link, once a driver has caused that."""
        lost = self.hears(
            lambda event: "driver plc" in str(getattr(event, "lost", "")) and not is_begin(event)
        )
        assert lost.state is MotionState.NO_LINK
        return str(lost.lost)


def is_begin(report: Report) -> bool:
    return "was started" in str(report.lost)


@pytest.fixture
def running() -> Iterator[Callable[..., Plant]]:
    """Starts plants, and stops them at the end: none of them has broken down itself."""
    made: list[Plant] = []

    def start(*drivers: Any, **options: Any) -> Plant:
        made.append(Plant(*drivers, **options))
        made[-1].part.start()
        return made[-1]

    yield start
    for each in made:
        each.part.stop()
        assert each.crashes == []


class Talker(Tame):
    """A driver that speaks MQTT."""

    broker: Any = None

    def use_broker(self, broker: Any) -> None:
        self.broker = broker


def test_a_driver_that_speaks_mqtt_has_the_broker_of_the_plant_before_it_starts(
    running: Callable[..., Plant],
) -> None:
    driver = Talker()
    there = running(driver)
    there.is_up()
    assert driver.broker is BROKER


def test_a_command_is_sent_by_the_driver_and_it_is_stopped_at_the_end(running: Callable[..., Plant]) -> None:
    driver = Tame()
    there = running(driver)
    there.is_up()
    there.part.send(GO)
    assert driver.sent.get(timeout=PATIENCE_S) == GO
    there.part.stop()
    assert driver.stopped.is_set()


def test_a_driver_that_cannot_start_is_started_again(running: Callable[..., Plant]) -> None:
    class Refused(Tame):
        def start(self, devices: Sequence[Robot], hear: Hear, clock: Clock) -> None:
            raise ConnectionRefusedError("nobody is there")

    first, second = Refused(), Tame()
    there = running(first, second)
    why = "its driver plc cannot start (ConnectionRefusedError: nobody is there), and tries again"
    assert there.is_lost() == why
    there.is_up()
    assert there.made == [first, second] and first.stopped.is_set()


def test_what_send_raises_loses_the_link_and_the_command_may_have_left(running: Callable[..., Plant]) -> None:
    class Rude(Tame):
        def send(self, command: Command) -> None:
            raise SystemExit(3)

    there = running(Rude())
    there.is_up()
    there.part.send(GO)
    lost = there.hears(lambda event: isinstance(event, Undelivered) or "SystemExit" in str(event.lost))
    assert lost.state is MotionState.NO_LINK and "which may have left" in str(lost.lost)
    there.made[0].speak()
    there.is_up()


class Threaded(Tame):
    """Its own thread ends as it is told to."""

    def start(self, devices: Sequence[Robot], hear: Hear, clock: Clock) -> None:
        super().start(devices, hear, clock)
        self.go = threading.Event()
        self.thread = threading.Thread(target=self.read, daemon=True)
        self.thread.start()

    def read(self) -> None:
        self.go.wait(PATIENCE_S)
        raise EOFError("the line is cut")

    def stop(self) -> None:
        self.go.set()
        self.thread.join()
        super().stop()


def test_a_thread_of_a_driver_that_dies_has_lost_the_link_and_the_driver_is_started_again(
    running: Callable[..., Plant],
) -> None:
    first = Threaded()
    there = running(first, Tame())
    there.is_up()
    first.go.set()
    why = "its driver plc broke down (a thread of it died: EOFError: the line is cut), and is started again"
    assert there.is_lost() == why
    there.is_up()
    assert first.stopped.is_set()


def test_a_thread_that_ends_with_an_error_while_the_driver_stops_is_nothing(
    running: Callable[..., Plant], caplog: pytest.LogCaptureFixture
) -> None:
    there = running(Threaded())
    there.is_up()
    there.part.stop()
    assert there.heard.empty() and caplog.records == []


def test_who_hears_of_dead_threads_gives_that_back(running: Callable[..., Plant]) -> None:
    before = threading.excepthook
    there = running(Tame())
    assert threading.excepthook != before
    there.part.stop()
    assert threading.excepthook == before


def test_a_driver_that_hangs_loses_its_device_and_holds_up_nobody(
    running: Callable[..., Plant], caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    go = threading.Event()

    class Hanging(Tame):
        def send(self, command: Command) -> None:
            go.wait(PATIENCE_S)

    monkeypatch.setattr("arboleda.runtime.parts.drivers.PATIENCE_S", 0.0)
    there = running(Hanging(), stale_after_s=0.3)
    there.is_up()
    there.part.send(GO)
    speaker = threading.Thread(target=speak, args=(there.made[0], go))
    speaker.start()
    try:
        assert there.is_lost() == "its driver plc has not come back from send for 0.3 s"
        there.part.stop()
        assert "the driver plc does not end and is left behind" in caplog.text
    finally:
        go.set()
        speaker.join()
    assert there.made[0].stopped.wait(PATIENCE_S)


def test_a_stop_goes_before_orders_that_wait_for_the_driver_and_these_never_leave(
    running: Callable[..., Plant],
) -> None:
    go = threading.Event()

    class Slow(Tame):
        def send(self, command: Command) -> None:
            super().send(command)
            go.wait(PATIENCE_S)

    there = running(Slow(), stale_after_s=1.0)
    there.is_up()
    speaker = threading.Thread(target=speak, args=(there.made[0], go))
    speaker.start()
    there.part.send(GO)
    assert there.made[0].sent.get(timeout=PATIENCE_S) == GO
    for command in (LIGHT, HALT):
        there.part.send(command)
    undelivered = there.hears(lambda event: isinstance(event, Undelivered))
    assert undelivered.id == LIGHT.id and "a stop came first" in str(undelivered.sentence)
    assert "has not come back from send" in there.is_lost()
    go.set()
    speaker.join()
    assert there.made[0].sent.get(timeout=PATIENCE_S) == HALT


def test_a_driver_that_waits_in_send_is_told_that_a_stop_comes(running: Callable[..., Plant]) -> None:
    class Waiting(Tame):
        def __init__(self) -> None:
            super().__init__()
            self.interrupted = threading.Event()

        def send(self, command: Command) -> None:
            super().send(command)
            if command == GO and self.interrupted.wait(PATIENCE_S):
                raise NotSent("half of it was written")

        def interrupt(self, robot: str) -> None:
            assert robot == "station"
            self.interrupted.set()

    there = running(Waiting())
    there.is_up()
    there.part.send(GO)
    assert there.made[0].sent.get(timeout=PATIENCE_S) == GO
    there.part.send(HALT)
    undelivered = there.hears(lambda event: isinstance(event, Undelivered))
    assert undelivered.id == GO.id and "half of it was written" in str(undelivered.sentence)
    assert there.made[0].sent.get(timeout=PATIENCE_S) == HALT


def speak(driver: Tame, until: threading.Event) -> None:
    """The driver's device is heard all the while."""
    while not until.wait(0.05):
        driver.speak()


def test_devices_with_the_same_driver_and_equal_settings_share_one() -> None:
    (robot,) = plant().robots.values()

    def driven(name: str, settings: object) -> Robot:
        use = DriverUse(name="plc", settings=settings, make=lambda: Noting(starts))
        return replace(robot, name=name, link=Link.DRIVER, driver=use)

    starts: queue.Queue[tuple[str, ...]] = queue.Queue()
    names = {"a": 1, "b": 2, "c": 1}
    members = tuple((name, driven(name, settings)) for name, settings in names.items())
    (cell,) = plant().cells
    model = PlantModel(name="lab", cells=(replace(cell, members=members),))
    part = DriversPart(model, EPOCH, lambda name, error: None, BROKER)
    part.start()
    try:
        assert {starts.get(timeout=PATIENCE_S), starts.get(timeout=PATIENCE_S)} == {("a", "c"), ("b",)}
    finally:
        part.stop()


class Noting(Tame):
    """Notes which devices it was started for."""

    def __init__(self, starts: queue.Queue[tuple[str, ...]]) -> None:
        super().__init__()
        self.starts = starts

    def start(self, devices: Sequence[Robot], hear: Hear, clock: Clock) -> None:
        self.starts.put(tuple(device.name for device in devices))


def test_whoever_works_is_halted_when_the_plant_is_not_heard(running: Callable[..., Plant]) -> None:
    driver = Tame()
    there = running(driver)
    there.is_up()
    there.part.send(Heartbeat(epoch=EPOCH))
    there.part.send(GO)
    sent = [driver.sent.get(timeout=PATIENCE_S) for _ in range(2)]
    assert sent == [GO, Stop(id="", robot="station", mode=StopMode.HALT)]


def test_whoever_another_process_leads_is_not_halted(running: Callable[..., Plant]) -> None:
    driver = Tame()
    there = running(driver)
    there.is_up()
    there.part.send(Heartbeat(epoch=EPOCH))
    there.part.send(GO)
    there.part.leave_robots()
    there.part.stop()
    assert [driver.sent.get_nowait(), driver.sent.empty()] == [GO, True]
