"""State machine over all drivers of a plant: it routes commands, checks reports, and notices losses.

Drivers are other people's code. Whatever one of them does, its devices lose their link, with a sentence that
says why; it is ended and made anew, and nothing that was open is sent again.

A device at work is halted where its plant is not heard, as a board halts itself.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from arboleda.model.commands import Command, Stop, StopMode
from arboleda.model.messages import MotionState, Report, Undelivered
from arboleda.model.plant_model import Robot
from arboleda.model.sentence import Phrase, Sentence

from .device import DrivenDevice
from .reports import objection

FIRST_RETRY_S, LAST_RETRY_S = 0.5, 30.0
PLANT_GONE_S = 1.0  # without heartbeat or command: as long as a board waits
STARTING = Phrase("driver.starting", "its driver {driver} was started and has said nothing yet")
SILENT = Phrase("driver.silent", "its driver {driver} has said nothing for {seconds:g} s")
SLOW = Phrase(
    "driver.slow",
    "a reading takes its driver {driver} {seconds:.1f} s, and must take less than half of"
    " stale_after_s ({stale:g} s): map fewer values, or set timing.stale_after_s higher",
)
STUCK = Phrase("driver.stuck", "its driver {driver} has not come back from send for {seconds:g} s")
FAILED = Phrase("driver.failed", "its driver {driver} broke down ({error}), and is started again")
NOT_STARTED = Phrase("driver.not_started", "its driver {driver} cannot start ({error}), and tries again")
LATE = Phrase("driver.late", "it waited for too long and must not leave any more")
OVERTAKEN = Phrase("driver.overtaken", "a stop came first")
NOT_SENT = Phrase("driver.not_sent", "its driver {driver} could not send a command ({error})")
BROKE_IN_SEND = Phrase(
    "driver.broke_in_send",
    "its driver {driver} broke down while it sent a command, which may have left ({error})",
)
UNSAID = Phrase("driver.unsaid", "its driver {driver} says that there is no link")
UNWATCHED = Phrase(
    "driver.unwatched",
    "the plant was not heard for {seconds:g} s; {robot} is halted, whose driver is {driver}",
)
NONSENSE = Phrase("driver.nonsense", "the driver {driver} reported nonsense: {why}")


@dataclass(frozen=True, kw_only=True)
class Life:
    """One object made of a driver; reports of an earlier one no longer count."""

    driver: int
    number: int


@dataclass(frozen=True, kw_only=True)
class CommandRequest:
    """Event: the plant commands a device."""

    at: float
    command: Command


@dataclass(frozen=True, kw_only=True)
class PlantBeat:
    """Event: a heartbeat of the plant."""

    at: float


@dataclass(frozen=True, kw_only=True)
class DriverOutput:
    """Event: a driver handed over an object that should be a Report."""

    at: float
    life: Life
    report: object


@dataclass(frozen=True, kw_only=True)
class DriverCrash:
    """Event: a driver raised a forbidden exception, or a thread of it died; `started`: after its start."""

    at: float
    life: Life
    error: str
    started: bool = True


@dataclass(frozen=True, kw_only=True)
class SendResult:
    """A driver came back from `send`; `error` says why the command did not leave.

    `broken`: a defect, not a refusal; the command may have left.
    """

    at: float
    life: Life
    command: Command
    error: Sentence | None = None
    broken: bool = False


@dataclass(frozen=True, kw_only=True)
class Leaving:
    """Event: the plant ends. `halts` False: another process leads its robots, so none is halted."""

    at: float
    halts: bool = True


@dataclass(frozen=True, kw_only=True)
class Begin:
    """Message: make the driver of this life, and start it."""

    life: Life


@dataclass(frozen=True, kw_only=True)
class Give:
    """Message: have a driver send a command, unless it is later than `until` by then."""

    life: Life
    command: Command
    until: float


@dataclass(frozen=True, kw_only=True)
class End:
    """Message: stop the driver of this life."""

    life: Life


@dataclass(frozen=True, kw_only=True)
class OutputRefused:
    """Message: a report was not used; `sentence` is for the log."""

    at: float
    sentence: Sentence


@dataclass(frozen=True, kw_only=True)
class DeviceHalt:
    """Message: a device was halted as the plant was silent; `sentence` is for the log."""

    at: float
    sentence: Sentence


Event = CommandRequest | PlantBeat | DriverOutput | DriverCrash | SendResult | Leaving
Message = Begin | Give | End | OutputRefused | DeviceHalt | Report | Undelivered


class SupervisedDriver:
    """Driver and its devices; `life` is the object that is made of it now."""

    def __init__(self, number: int, name: str, devices: Sequence[DrivenDevice], stuck_after_s: float) -> None:
        self.name = name
        self.devices = {device.robot.name: device for device in devices}
        self.robots = {name: device.robot for name, device in self.devices.items()}
        self.life = Life(driver=number, number=0)
        self.begin_at = -math.inf  # time of the next start; inf while there is a life
        self._stuck_after_s = stuck_after_s
        self._sends: list[tuple[float, Command]] = []  # calls of `send` that have not returned, since when
        self._stuck = False
        self._began_at = 0.0
        self._delay_s = FIRST_RETRY_S

    @property
    def next_deadline(self) -> float:
        stale_at = min(device.stale_at for device in self.devices.values())
        stuck_at = self._waits_since + self._stuck_after_s if not self._stuck else math.inf
        return min(self.begin_at, stuck_at, stale_at)

    @property
    def _waits_since(self) -> float:
        """The time (s) since when the oldest call of `send` has not returned; inf where all have."""
        return min((at for at, _ in self._sends), default=math.inf)

    def begin(self, now: float) -> list[Message]:
        first = self.life.number == 0
        self.life = replace(self.life, number=self.life.number + 1)
        self.begin_at, self._began_at = math.inf, now
        starting = STARTING(driver=self.name)
        unheard = [device.no_link(now, starting) for device in self.devices.values()] if first else []
        return [*unheard, Begin(life=self.life)]

    def command(self, at: float, command: Command) -> list[Message]:
        device = self.devices[command.robot]
        if device.repeated(command):
            return []
        word = device.refusal(command)
        if word is None:
            return [self._give(at, device, command)]
        refused: list[Message] = [device.refuse(at, command, word)]
        is_clear = isinstance(command, Stop) and command.mode is StopMode.CLEAR
        if is_clear and not device.up and self.begin_at == math.inf:
            refused.append(self._give(at, device, replace(command, id="")))  # it may wait for a person's word
        return refused

    def taken(self, event: SendResult) -> list[Message]:
        """Note that the driver came back from `send`."""
        at = next((at for at, (_, command) in enumerate(self._sends) if command == event.command), None)
        if at is not None:
            del self._sends[at]
        self._stuck = self._stuck and bool(self._sends)
        if event.error is None:
            return []
        name = event.command.robot
        if event.broken:
            return self._lose(
                event.at, self.devices[name], BROKE_IN_SEND(driver=self.name, error=event.error)
            )
        if not event.command.id:
            return []  # the plant has not asked for it
        why = NOT_SENT(driver=self.name, error=event.error)
        return [Undelivered(at=event.at, id=event.command.id, robot=name, sentence=why)]

    def broken(self, event: DriverCrash) -> list[Message]:
        """End the driver, and start it anew after a pause, which grows while it keeps breaking down early."""
        what = FAILED if event.started else NOT_STARTED
        held = event.at - self._began_at > LAST_RETRY_S
        self._delay_s = FIRST_RETRY_S if held else self._delay_s
        self.begin_at = event.at + self._delay_s
        self._delay_s = min(2 * self._delay_s, LAST_RETRY_S)
        ended, self.life = End(life=self.life), replace(self.life, number=self.life.number + 1)
        self._sends.clear()
        self._stuck = False
        why = what(driver=self.name, error=event.error)
        return [*(device.no_link(event.at, why) for device in self.devices.values()), ended]

    def output(self, event: DriverOutput) -> list[Message]:
        """Take a report of the driver's code: returned if it counts; a refusal for the log if invalid."""
        why = objection(event.report, self.robots)
        if why is not None:
            return [OutputRefused(at=event.at, sentence=NONSENSE(driver=self.name, why=why))]
        assert isinstance(event.report, Report)
        device = self.devices[event.report.robot]
        report = event.report.again(min(event.report.at, event.at))  # no report is of the future
        if self._stuck or device.is_overtaken(report):
            return []
        if report.state is not MotionState.NO_LINK and device.is_old(report, event.at):
            slow = SLOW(driver=self.name, seconds=round(event.at - report.at, 1), stale=self._stuck_after_s)
            return self._call_back(event.at, device, device.say_lost(event.at, slow))
        if report.state is MotionState.NO_LINK:
            told = device.say_lost(report.at, report.lost or UNSAID(driver=self.name))
            return self._call_back(event.at, device, told)
        taken, stop = device.hear(report)
        return [taken] if stop is None else [taken, self._give(event.at, device, stop)]

    def pass_time(self, now: float) -> list[Message]:
        """Losses that the passing of time brings: silent devices, and a `send` that does not return."""
        if self.begin_at <= now:
            return self.begin(now)
        if not self._stuck and self._waits_since + self._stuck_after_s <= now:
            self._stuck = True
            why = STUCK(driver=self.name, seconds=self._stuck_after_s)
            return [message for device in self.devices.values() for message in self._lose(now, device, why)]
        silent = [device for device in self.devices.values() if device.stale_at <= now]
        why = SILENT(driver=self.name, seconds=self._stuck_after_s)
        return [message for device in silent for message in self._lose(now, device, why)]

    @property
    def needs_plant(self) -> bool:
        """True while a device of this driver does work that must not go on without the plant."""
        return any(device.needs_plant for device in self.devices.values())

    def give_up(self, now: float) -> list[Message]:
        """Halt work that must not go on without the plant; once only, as another plant may lead by then."""
        halted = [device for device in self.devices.values() if device.needs_plant]
        return [message for device in halted for message in self._unwatched(now, device)]

    def _unwatched(self, now: float, device: DrivenDevice) -> list[Message]:
        failed, stop = device.give_up(now)
        sentence = UNWATCHED(seconds=PLANT_GONE_S, robot=device.robot.name, driver=self.name)
        return [self._give(now, device, stop), failed, DeviceHalt(at=now, sentence=sentence)]

    def leave(self, leaving: Leaving) -> list[Message]:
        """Halt everything that may still move, then end the driver."""
        halts = [(device, device.halt()) for device in self.devices.values()] if leaving.halts else []
        halting: list[Message] = [
            self._give(leaving.at, device, halt) for device, halt in halts if halt is not None
        ]
        alive, self.begin_at = self.begin_at == math.inf, math.inf
        return [*halting, *([End(life=self.life)] if alive else [])]

    def _lose(self, at: float, device: DrivenDevice, why: Sentence) -> list[Message]:
        return self._call_back(at, device, device.lose(at, why))

    def _call_back(self, at: float, device: DrivenDevice, told: Sequence[Report]) -> list[Message]:
        """Reports of a lost link, and a stop for an order that `send` still has: its task has failed, so
        it must not begin any more."""
        has_order = any(
            command.robot == device.robot.name and not isinstance(command, Stop) for _, command in self._sends
        )
        if not told or not has_order or not device.robot.has_stop:
            return [*told]
        return [*told, self._give(at, device, Stop(id="", robot=device.robot.name, mode=StopMode.HALT))]

    def _give(self, at: float, device: DrivenDevice, command: Command) -> Give:
        """The message that hands a command to the driver's `send`.

        It expires with a `send` that is stuck before it; a stop never expires.
        """
        device.leaves(command)
        self._sends.append((at, command))
        until = math.inf if isinstance(command, Stop) else self._waits_since + self._stuck_after_s
        return Give(life=self.life, command=command, until=until)


class Supervisor:
    """State machine of the drivers, by number, each with a name and robots; `epoch` names the start."""

    def __init__(
        self, drivers: Sequence[tuple[str, Sequence[Robot]]], *, epoch: int, stale_after_s: float
    ) -> None:
        self._drivers = [
            SupervisedDriver(
                number,
                name,
                [DrivenDevice(robot, epoch=epoch, stale_after_s=stale_after_s) for robot in robots],
                stale_after_s,
            )
            for number, (name, robots) in enumerate(drivers)
        ]
        self._of_device = {name: driver for driver in self._drivers for name in driver.devices}
        self._leaving = False
        self._plant_gone_at = math.inf  # until its first heartbeat

    @property
    def next_deadline(self) -> float | None:
        """The time (s) at which `step` is due even without events; None if it never is."""
        due = min((driver.next_deadline for driver in self._drivers), default=math.inf)
        if any(driver.needs_plant for driver in self._drivers):
            due = min(due, self._plant_gone_at)
        return due if due < math.inf and not self._leaving else None

    def step(self, now: float, events: Sequence[Event]) -> list[Message]:
        """Take events; return reports and undelivered commands for the plant, and orders to drivers."""
        out = [message for event in events for message in self._take(event)]
        if self._leaving:
            return out
        for driver in self._drivers:
            if driver.next_deadline <= now:
                out += driver.pass_time(now)
            if self._plant_gone_at <= now and driver.needs_plant:
                out += driver.give_up(now)
        return out

    def _take(self, event: Event) -> list[Message]:
        if self._leaving:
            return []
        if isinstance(event, Leaving):
            self._leaving = True
            return [message for driver in self._drivers for message in driver.leave(event)]
        if isinstance(event, PlantBeat | CommandRequest):
            return self._hear_plant(event)
        driver = self._drivers[event.life.driver]
        if event.life != driver.life:
            return []
        if isinstance(event, DriverOutput):
            return driver.output(event)
        return driver.taken(event) if isinstance(event, SendResult) else driver.broken(event)

    def _hear_plant(self, event: PlantBeat | CommandRequest) -> list[Message]:
        """Note a sign of the plant; its silence counts from the first heartbeat on."""
        if isinstance(event, PlantBeat) or self._plant_gone_at < math.inf:
            self._plant_gone_at = event.at + PLANT_GONE_S
        if isinstance(event, PlantBeat):
            return []
        return self._of_device[event.command.robot].command(event.at, event.command)
