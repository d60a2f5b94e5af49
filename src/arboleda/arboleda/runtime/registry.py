"""Registry of what a running plant is made of: factories of parts, the runner's and those of packages."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Any

from arboleda.host.packages import package_of, registered
from arboleda.model.plant_model import PlantModel
from arboleda.web.offers import Offers

from .holdings import Holdings
from .options import Options
from .parts.part import Crash, Part

GROUP = "arboleda.parts"


class Phase(IntEnum):
    """Place of a part in the order of starts; parts end in the opposite order. In one phase come the parts of
    the runner first, then those of packages, by the package's name."""

    LINKS = 1  # brokers and ROS 2, and what keeps the lead among hosts
    DEVICES = 2  # what reaches devices, and what plays them
    REPORTS = 3  # what tells of the record, and ends after it
    RECORD = 4  # what keeps what the plant does, and ends after the plant
    ALARMS = 5  # what tells people, also of how the plant ends
    PLANT = 6
    PAGE = 7  # the server, and what people do on pages
    VIEWS = 8  # other programs that look at the plant or give it tasks
    AFTER = 9  # what acts on a plant that runs
    READY = 10  # who is told that all of it runs


@dataclass(frozen=True, kw_only=True)
class Factory:
    """Factory of the parts that start in one phase.

    `make` is called once, in the order of phases, before anything starts. What it needs of the parts before
    it, it asks of the assembly; what is made later, it asks for when it uses it. It makes nothing where that
    is not wanted. A StartError says that the plant must not start. Where `make` or one of its parts raises
    anything else, the factory's package is left out of the plant, and people are told. Without a factory that
    `is_needed` the plant does not start.
    """

    phase: Phase
    make: Callable[[Assembly], Iterable[Part]]
    is_needed: bool = False


class Links:
    """State of a plant's links, as `PageApi.links` has it, from reports of its parts; for any thread."""

    def __init__(self) -> None:
        self._sources: list[Callable[[], Mapping[str, Any]]] = []

    def add(self, source: Callable[[], Mapping[str, Any]]) -> None:
        """Add what a part reports, which is asked for each time; from any thread."""
        self._sources.append(source)

    def __call__(self) -> dict[str, Any]:
        """Broker, ROS 2, refused messages, standbys, the memory's pace, and the like."""
        state: dict[str, Any] = {"broker": None, "ros": None, "refused": {}, "standbys": []}
        state |= {"demo": False, "memory": None, "faults": []}
        for each in self._sources:
            state |= each()
        return state


@dataclass(kw_only=True, eq=False)
class Assembly(Offers):
    """One start of a plant while it is put together: what it is made of, and what its parts offer each other.

    `parts` says which ones this process has, `began` is the Unix time of the start, `epoch` its number.
    `crash` ends the plant because a part broke down, `end` because somebody wants it to;
    `leave_out` is told of a package that breaks. `notes` gives the lines that a person should read about the
    start, once everything runs.
    """

    model: PlantModel
    parts: frozenset[str]
    options: Options
    holdings: Holdings
    began: int
    epoch: int
    crash: Crash
    end: Callable[[], None]
    leave_out: Callable[[str, BaseException], None]
    links: Links = field(default_factory=Links)
    notes: list[Callable[[], Iterable[str]]] = field(default_factory=list)

    def __post_init__(self) -> None:
        super().__init__()

    def leave_out_raiser(self, error: Exception) -> bool:
        """Leave out the package of the listener that raised this; False where it is of none."""
        called = error.__traceback__ and error.__traceback__.tb_next  # the first is who called the listener
        module = called.tb_frame.f_globals.get("__name__", "") if called else ""
        for point in registered(GROUP):
            if _top(point.module) == _top(module):
                self.leave_out(package_of(point), error)
                return True
        return False


def packaged(leave_out: Callable[[str, BaseException], None]) -> Iterator[tuple[str, Factory]]:
    """The factories of packages, each with its package; one that cannot be loaded is left out."""
    for point in registered(GROUP):
        try:
            factories = tuple(point.load())
            if not all(isinstance(each, Factory) for each in factories):
                raise TypeError(f"{point.value} is no sequence of factories of parts")
        except (Exception, SystemExit) as error:  # noqa: BLE001 - whatever a package does, the plant runs
            leave_out(package_of(point), error)
            continue
        yield from ((package_of(point), each) for each in factories)


def _top(module: str) -> str:
    return module.partition(".")[0]
