"""What a driver is: the way from the plant to devices that it knows how to speak to."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, is_dataclass
from typing import Any, Protocol, TypeVar, runtime_checkable

from arboleda.model.commands import Command
from arboleda.model.errors import ArboledaError
from arboleda.model.messages import Report
from arboleda.model.outside import plain
from arboleda.model.plant_model import MotionState, Robot
from arboleda.model.sentence import OWN


class Hear(Protocol):
    """Takes what a device says, from any thread; never blocks, never raises."""

    def __call__(self, report: Report) -> None: ...


class Clock(Protocol):
    """The plant's clock, s: what a report was said at."""

    def __call__(self) -> float: ...


MARK = "__arboleda_driver__"
METHODS = ("start", "send", "stop")


class DriverError(ArboledaError):
    """A class that cannot be a driver."""


class NotSent(ArboledaError):
    """A command could not leave, and will not be sent later; the sentence says why."""


class Driver(Protocol):
    """One connection to one or several devices. All three are called in one thread of the driver's own."""

    def start(self, devices: Sequence[Robot], hear: Hear, clock: Clock) -> None:
        """Begin to reach these devices; raises where that cannot work, and is then tried again later."""

    def send(self, command: Command) -> None:
        """Send a command now, and return soon; raises (`NotSent`) where it could not leave."""

    def stop(self) -> None:
        """End: what it opened is closed, its threads have ended. Called once, also after a failed start."""


@runtime_checkable
class FitsDevice(Protocol):
    """Settings of a driver that know what of them does not fit a device."""

    def problems(self, device: Robot) -> Iterable[tuple[tuple[str | int, ...], str]]:
        """Each by the keys that lead to it, and a sentence."""


@dataclass(frozen=True, kw_only=True)
class DriverSpec:
    """A class that was made a driver: its name in plant files, and the dataclass of its settings."""

    name: str
    made_by: Callable[..., Driver]
    settings: type | None = None

    def make(self, settings: object) -> Driver:
        """A driver with these settings; None where it has none."""
        return self.made_by() if self.settings is None else self.made_by(settings)


C = TypeVar("C", bound=type)


def driver(name: str, *, settings: type | None = None) -> Callable[[C], C]:
    """Makes a class a driver that plant files call `name`; it is called with its settings, if it has any.

    `settings` is a frozen dataclass: its fields are the keys of the plant file.
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
    """What `driver` made of a class; None for anything else, a subclass of a driver among it."""
    found = vars(value).get(MARK) if isinstance(value, type) else None
    return found if isinstance(found, DriverSpec) else None


def lost(robot: str, *, at: float, why: str) -> Report:
    """The report that there is no link to a device, with the reason in words."""
    return Report(at=at, robot=robot, state=MotionState.NO_LINK, lost=OWN(text=plain(why)))


def _is_frozen(settings: type) -> bool:
    return is_dataclass(settings) and settings.__dataclass_params__.frozen  # type: ignore[attr-defined]
