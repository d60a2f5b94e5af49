"""Interface of a driver: the way from the plant to devices whose protocol it speaks."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, is_dataclass
from typing import Any, Protocol, TypeVar, runtime_checkable

from arboleda.model.commands import Command
from arboleda.model.errors import ArboledaError
from arboleda.model.messages import MotionState, Report
from arboleda.model.outside import plain
from arboleda.model.plant_model import Evidence, Robot
from arboleda.model.sentence import OWN


class Hear(Protocol):
    """Callback that takes a report of a device; callable from any thread, never blocks, never raises."""

    def __call__(self, report: Report) -> None: ...


class Clock(Protocol):
    """Clock of the plant: returns the present time, s, for the field `at` of a report."""

    def __call__(self) -> float: ...


GROUP = "arboleda.drivers"  # of entry points: the drivers that a package brings
MARK = "__arboleda_driver__"
METHODS = ("start", "send", "stop")


class DriverError(ArboledaError):
    """Error in the class or the settings of a driver; the sentence tells the reason."""


class NotSent(ArboledaError):
    """Error of `send`: the command could not leave, and will not be sent later; the sentence says why."""


class Driver(Protocol):
    """Connection to one or several devices.

    All three methods are called in one thread of the driver's own, so a slow one holds up no other driver.
    A stop goes before every order that waits for that thread, and these are not sent any more.
    """

    def start(self, devices: Sequence[Robot], hear: Hear, clock: Clock) -> None:
        """Begin to connect to the devices; returns soon.

        `devices`: all devices that the plant file gives to this driver. `hear`: takes their reports, until
        `stop`. `clock`: returns the time, s, for the reports. May raise any exception: it is logged, and a
        new driver is started after 0.5 s, later ones after up to 30 s.
        """

    def send(self, command: Command) -> None:
        """Send a command now, and return soon; its end comes as a report.

        Raises NotSent if the command could not leave. After any other exception the command may have left:
        the link is lost until the device is heard again.
        """

    def stop(self) -> None:
        """Close all that was opened, and join all threads; called once, also after a failed `start`."""


@runtime_checkable
class Listens(Protocol):
    """Driver that writes something by itself once it is started, and can begin without that."""

    def listen(self, devices: Sequence[Robot], hear: Hear, clock: Clock) -> None:
        """The same as `start`, but nothing is written to the devices, and nobody's control is taken."""


@runtime_checkable
class UsesBroker(Protocol):
    """Driver over MQTT, at the plant's own broker where its settings name no other."""

    def use_broker(self, broker: Any) -> None:
        """Take the plant's broker: its `address`, and its `credentials` or None; called before `start`."""


@runtime_checkable
class Interruptible(Protocol):
    """Driver whose `send` waits for the device, as where an order is several telegrams."""

    def interrupt(self, robot: str) -> None:
        """Have nothing more leave of what `send` was given for this device: a stop for it comes next.

        Called in another thread, also while `send` is under way, and never waits. The order under way ends
        with NotSent if nothing of it has begun. All may go on once `send` has the stop.
        """


@runtime_checkable
class FitsDevice(Protocol):
    """Settings of a driver that can check themselves against a device."""

    def problems(self, device: Robot) -> Iterable[tuple[tuple[str | int, ...], str]]:
        """Settings that do not fit the device, each as its keys and a sentence."""


@runtime_checkable
class GivesEvidence(Protocol):
    """Settings of a driver from which follows how much may be believed of what a device says."""

    def evidence_of(self, device: Robot) -> Evidence:
        """The evidence of a device of which the plant file says none."""


@runtime_checkable
class ShowsMessages(Protocol):
    """Settings of a driver that can show a person what passes between the plant and a device."""

    def shown(self, device: Robot) -> Iterable[str]:
        """Lines with examples of its messages, and what is believed of them."""


@dataclass(frozen=True, kw_only=True)
class DriverSpec:
    """Driver as `@driver` makes it: its name in plant files, its class, and the dataclass of its settings."""

    name: str
    made_by: Callable[..., Driver]
    settings: type | None = None

    def make(self, settings: object) -> Driver:
        """A new driver with these settings (None for a driver without settings)."""
        return self.made_by() if self.settings is None else self.made_by(settings)


C = TypeVar("C", bound=type)


def driver(name: str, *, settings: type | None = None) -> Callable[[C], C]:
    """Decorator that makes a class with the methods of Driver a driver, called `name` in plant files.

    `settings` is a frozen dataclass whose fields are the keys of the plant file; the class is called with an
    instance of it. None: it is called without arguments. Returns the class itself. Raises DriverError if a
    method is missing, or `settings` is no frozen dataclass.
    """

    def marked(made: C) -> C:
        missing = [method for method in METHODS if not callable(getattr(made, method, None))]
        if missing:
            raise DriverError(f"the driver {name} has no method {', '.join(missing)}")
        if settings is not None and not _is_frozen(settings):
            raise DriverError(f"the settings of the driver {name} must be a frozen dataclass")
        setattr(made, MARK, DriverSpec(name=name, made_by=made, settings=settings))
        return made

    return marked


def spec_of(value: Any) -> DriverSpec | None:
    """The DriverSpec of a class made by `driver`; None for anything else, its subclasses included."""
    found = vars(value).get(MARK) if isinstance(value, type) else None
    return found if isinstance(found, DriverSpec) else None


def lost(robot: str, *, at: float, why: str) -> Report:
    """Returns the report that the link to a device is lost.

    `robot`: the name of the device. `at`: the time, s, by the plant's clock. `why`: the reason, in words.
    """
    return Report(at=at, robot=robot, state=MotionState.NO_LINK, lost=OWN(text=plain(why)))


def _is_frozen(settings: type) -> bool:
    return is_dataclass(settings) and settings.__dataclass_params__.frozen  # type: ignore[attr-defined]
