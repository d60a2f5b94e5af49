"""Drivers of one's own in a plant: a thread for each, and the machine that supervises them in a loop."""

from __future__ import annotations

import logging
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator
from functools import partial
from traceback import walk_tb
from typing import Any, TypeGuard

from arboleda.adapters import clock
from arboleda.adapters.rate_limit import RateLimit
from arboleda.drivers import supervisor
from arboleda.drivers.port import Driver, Interruptible, NotSent, UsesBroker
from arboleda.drivers.supervisor import (
    Begin,
    DeviceHalt,
    DriverCrash,
    DriverOutput,
    End,
    Give,
    Leaving,
    Life,
    OutputRefused,
    SendResult,
    Supervisor,
)
from arboleda.model.commands import Command, Stop, StopMode
from arboleda.model.messages import Heartbeat, Notice, Report, Undelivered
from arboleda.model.outside import plain
from arboleda.model.plant_model import DriverUse, PlantModel, Robot
from arboleda.model.sentence import OWN

from ..loop import Loop
from .part import BrokerAddress, Crash

LOG = logging.getLogger("arboleda.drivers")
PATIENCE_S = 3.0  # for drivers to end


class DriversPart:
    """The drivers of a plant; `connect` the plant before `start`. It is the plant's port to their devices."""

    def __init__(self, model: PlantModel, epoch: int, crash: Crash, broker: BrokerAddress) -> None:
        groups = list(_groups(model))
        self._workers = [Worker(use, robots, self._post, broker) for use, robots in groups]
        self._hear: Callable[[Report | Undelivered], None] = lambda event: None
        self._seldom = RateLimit()
        named = [(use.name, robots) for use, robots in groups]
        machine = Supervisor(named, epoch=epoch, stale_after_s=model.timing.stale_after_s)
        self.loop: Loop[Any, Any] = Loop("drivers", machine, self._send, on_crash=crash)
        self._threads = DeadThreads(self._died)

    def connect(self, hear: Callable[[Report | Undelivered], None]) -> None:
        """Connect the receiver of reports and of commands that could not leave."""
        self._hear = hear

    def send(self, message: Command | Notice) -> None:
        """The plant's port to the devices behind drivers; of notices only its heartbeat is for them."""
        if isinstance(message, Command):
            self.loop.post(supervisor.CommandRequest(at=clock.seconds(), command=message))
        elif isinstance(message, Heartbeat):
            self.loop.post(supervisor.PlantBeat(at=clock.seconds()))

    def start(self) -> None:
        self._threads.watch()
        for worker in self._workers:
            worker.start()
        self.loop.start()

    def leave_robots(self) -> None:
        """End the drivers without halting a robot, as another process leads them now."""
        self.loop.post(Leaving(at=clock.seconds(), halts=False))

    def stop(self) -> None:
        """Halt what may still move, then end every driver; one that does not end is left behind."""
        self.loop.post(Leaving(at=clock.seconds()))
        self.loop.stop()
        until = time.monotonic() + PATIENCE_S
        for worker in self._workers:
            worker.end(until)
        self._threads.forget()

    def _post(self, event: supervisor.Event) -> None:
        self.loop.post(event)

    def _send(self, message: supervisor.Message) -> None:
        if isinstance(message, Report | Undelivered):
            self._hear(message)
        elif isinstance(message, OutputRefused | DeviceHalt):
            if self._seldom.is_due(message.sentence, message.at):
                LOG.warning("%s", message.sentence)
        else:
            self._workers[message.life.driver].do(message)

    def _died(self, error: BaseException) -> bool:
        """Take the error that ended a thread; True if it was one of a driver of this plant."""
        at_work = [worker for worker in self._workers if worker.is_at_work_in(error)]
        owners = at_work or [worker for worker in self._workers if worker.wrote(error)]
        for worker in owners:
            worker.lost_thread(error)
        return bool(owners)


Job = Begin | Give | End | None


class Worker:
    """Worker: one driver in a thread of its own: an error becomes an event, a slow call delays no other.

    A stop goes before the orders that wait, and those of its device are never sent.
    """

    def __init__(
        self,
        use: DriverUse,
        robots: tuple[Robot, ...],
        post: Callable[[supervisor.Event], None],
        broker: BrokerAddress,
    ) -> None:
        self._use, self._robots = use, robots
        self._post, self._broker = post, broker
        self._jobs: deque[Job] = deque()
        self._come = threading.Condition()  # around the jobs
        self._driver: Driver | None = None
        self._life: Life | None = None
        self._thread = threading.Thread(target=self._run, name=f"driver {use.name}", daemon=True)

    def start(self) -> None:
        self._thread.start()

    def do(self, job: Begin | Give | End) -> None:
        """Queue a call to the driver; from any thread, never blocks."""
        stop = _stop_in(job)
        if stop is None:
            self._queue(job)
            return
        with self._come:
            overtaken = [each for each in self._jobs if _is_order(each, stop.robot)]
            kept = [each for each in self._jobs if not _is_order(each, stop.robot)]
            lives = [at for at, each in enumerate(kept) if not isinstance(each, Give) or _stop_in(each)]
            kept.insert(lives[-1] + 1 if lives else 0, job)
            self._jobs = deque(kept)
            self._come.notify()
        for each in overtaken:
            self._back(each, error=supervisor.OVERTAKEN())
        self._interrupt(job.life, stop.robot)

    def end(self, until: float) -> None:
        """End after the queued calls, at that monotonic time at the latest."""
        self._queue(None)
        if self._thread.ident is not None:
            self._thread.join(max(0.0, until - time.monotonic()))
        if self._thread.is_alive():
            LOG.warning("the driver %s does not end and is left behind", self._use.name)

    def is_at_work_in(self, error: BaseException) -> bool:
        """True if an error passed through a call of this driver."""
        return any(
            value is self._driver
            for frame, _ in walk_tb(error.__traceback__)
            for value in frame.f_locals.values()
            if self._driver is not None
        )

    def wrote(self, error: BaseException) -> bool:
        """True if an error passed through the file in which this driver is written."""
        if self._driver is None:
            return False
        file = type(self._driver).start.__code__.co_filename
        return any(frame.f_code.co_filename == file for frame, _ in walk_tb(error.__traceback__))

    def lost_thread(self, error: BaseException) -> None:
        """Report that a thread of the driver died with this error, unless the driver is ending."""
        if self._life is not None:
            self._broke(self._life, f"a thread of it died: {in_words(error)}", error)

    def _run(self) -> None:
        while (job := self._next()) is not None:
            if isinstance(job, Begin):
                self._begin(job.life)
            elif isinstance(job, Give):
                self._give(job)
            else:
                self._end()

    def _queue(self, job: Job) -> None:
        with self._come:
            self._jobs.append(job)
            self._come.notify()

    def _next(self) -> Job:
        with self._come:
            while not self._jobs:
                self._come.wait()
            return self._jobs.popleft()

    def _interrupt(self, life: Life, robot: str) -> None:
        """Have a driver that waits in `send` come back soon."""
        driver = self._driver
        if life != self._life or not isinstance(driver, Interruptible):
            return
        try:
            driver.interrupt(robot)
        except (Exception, SystemExit) as error:  # noqa: BLE001 - it is user code: whatever it raises is told
            self._broke(life, in_words(error), error)

    def _begin(self, life: Life) -> None:
        self._life = life
        try:
            self._driver = self._use.make()
            if isinstance(self._driver, UsesBroker):
                self._driver.use_broker(self._broker)
            self._driver.start(self._robots, partial(self._hear, life), clock.seconds)
        except (Exception, SystemExit) as error:  # noqa: BLE001 - it is user code: whatever it raises is told
            self._broke(life, in_words(error), error, started=False)

    def _give(self, job: Give) -> None:
        back: dict[str, Any] = {}
        try:
            if clock.seconds() > job.until:
                back = {"error": supervisor.LATE()}
            elif self._driver is not None and job.life == self._life:
                self._driver.send(job.command)
        except NotSent as error:
            back = {"error": error.sentence}
        except (Exception, SystemExit) as error:  # noqa: BLE001 - it is user code: whatever it raises is told
            self._log(in_words(error), error)
            back = {"error": OWN(text=in_words(error)), "broken": True}
        self._back(job, **back)

    def _back(self, job: Give, **back: Any) -> None:
        """Post what came of a command."""
        self._post(SendResult(at=clock.seconds(), life=job.life, command=job.command, **back))

    def _end(self) -> None:
        self._life = None
        try:
            if self._driver is not None:
                self._driver.stop()
        except (Exception, SystemExit) as error:  # noqa: BLE001 - it is user code: whatever it raises is told
            self._log(in_words(error), error)
        self._driver = None

    def _hear(self, life: Life, report: object) -> None:
        """Post a report of the driver; each life of it gets this as `hear`."""
        self._post(DriverOutput(at=clock.seconds(), life=life, report=report))

    def _broke(self, life: Life, why: str, error: BaseException, *, started: bool = True) -> None:
        self._log(why, error)
        self._post(DriverCrash(at=clock.seconds(), life=life, error=why, started=started))

    def _log(self, why: str, error: BaseException) -> None:
        LOG.warning("the driver %s: %s", self._use.name, why)
        LOG.debug("the error of the driver %s, whole", self._use.name, exc_info=error)


def _stop_in(job: Job) -> Stop | None:
    """The stop that is to be sent; None for all else, also for the word that clears a stop."""
    command = job.command if isinstance(job, Give) else None
    return command if isinstance(command, Stop) and command.mode is not StopMode.CLEAR else None


def _is_order(job: Job, robot: str) -> TypeGuard[Give]:
    """True for what is to be sent to this device, and is no stop."""
    return isinstance(job, Give) and job.command.robot == robot and _stop_in(job) is None


class DeadThreads:
    """Hears of threads of this process that end with an error, while it watches.

    `died(error)` is True for a thread of its own; errors of all others are printed by Python as usual.
    """

    def __init__(self, died: Callable[[BaseException], bool]) -> None:
        self._died = died
        self._before: Callable[[Any], Any] | None = None

    def watch(self) -> None:
        self._before, threading.excepthook = threading.excepthook, self._hear

    def forget(self) -> None:
        """Stop watching; idempotent."""
        if self._before is not None and threading.excepthook == self._hear:
            threading.excepthook = self._before
        self._before = None

    def _hear(self, args: Any) -> None:
        before = self._before or threading.__excepthook__
        if args.exc_value is None or not self._died(args.exc_value):
            before(args)


def in_words(error: BaseException) -> str:
    """An error as the end of a sentence: its class and its text."""
    try:
        text = str(error)
    except Exception:  # noqa: BLE001 - an error of the user's may have no words
        text = ""
    kind = type(error).__name__
    return plain(f"{kind}: {text}" if text else kind)


def _groups(model: PlantModel) -> Iterator[tuple[DriverUse, tuple[Robot, ...]]]:
    """The robots behind each driver: those of one name and equal settings share one."""
    uses: list[tuple[DriverUse, list[Robot]]] = []
    for robot in model.driven:
        assert robot.driver is not None
        there = next((robots for use, robots in uses if use == robot.driver), None)
        if there is None:
            uses.append((robot.driver, [robot]))
        else:
            there.append(robot)
    return ((use, tuple(robots)) for use, robots in uses)
