"""Registry of what a running plant is made of: factories of parts, the runner's and those of packages."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from enum import IntEnum
from traceback import walk_tb
from typing import Any

from arboleda.host.packages import registered
from arboleda.host.pieces import Piece, Pieces, piece_of, registrant
from arboleda.model.errors import ArboledaError
from arboleda.model.plant_model import PlantModel
from arboleda.web.offers import Offers

from .holdings import Holdings
from .options import Options
from .parts.part import Crash, Part
from .parts.plant_log import log_defect

GROUP = "arboleda.parts"
OF_RUNNER = frozenset({"broker", "memory", "refused", "ros"})  # in `Links`: what no package tells


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
    anything else, what it makes or that part is left out of the plant, and people are told. Without a factory
    that `is_needed` the plant does not start.
    """

    phase: Phase
    make: Callable[[Assembly], Iterable[Part]]
    is_needed: bool = False
    what: str = ""  # as people are told of it; "": the factory, by the name of `make`


Source = Callable[[], Mapping[str, Any]]


class NameTaken(ArboledaError):
    """Another piece has a name that this one wants."""


class Links:
    """State of a plant's links, as `PageApi.links` has it, from reports of its parts; for any thread.

    A source that raises is left out, and so is one that tells what another one tells.
    """

    def __init__(self, pieces: Pieces) -> None:
        self._pieces = pieces
        self._sources: list[tuple[Source, Piece | None]] = []

    def add(self, source: Source) -> None:
        """Add what a part reports, which is asked for each time; from any thread."""
        self._sources.append((source, registrant("a source of links")))

    def __call__(self) -> dict[str, Any]:
        """Broker, ROS 2, refused messages, standbys, the memory's pace, and the like."""
        state: dict[str, Any] = {"broker": None, "ros": None, "refused": {}, "standbys": []}
        state |= {"demo": False, "memory": None, "faults": []}
        told: set[str] = set()
        for source, piece in [*self._sources]:
            news = self._told(source, piece, told)
            told |= news.keys()
            state |= news
        return state

    def _told(self, source: Source, piece: Piece | None, taken: set[str]) -> Mapping[str, Any]:
        """The news of a source; none where it is left out."""
        try:
            news = {**source()}
            if doubled := news.keys() & (taken if piece is None else taken | OF_RUNNER):
                raise NameTaken(f"another source tells {', '.join(sorted(doubled))}")
        except Exception as error:  # noqa: BLE001 - record and page go on, whatever a source does
            with suppress(ValueError):  # another thread was first
                self._sources.remove((source, piece))
                if piece is None:
                    log_defect("a source of links", error)
                else:
                    self._pieces.leave_out(piece, error)
            return {}
        return news


@dataclass(kw_only=True, eq=False)
class Assembly(Offers):
    """One start of a plant while it is put together: what it is made of, and what its parts offer each other.

    `parts` says which ones this process has, `began` is the Unix time of the start, `epoch` its number.
    `crash` ends the plant because a part broke down, `end` because somebody wants it to;
    `pieces` calls what is of packages. `notes` gives the lines that a person should read about the
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
    pieces: Pieces
    links: Links = field(init=False)
    notes: list[Callable[[], Iterable[str]]] = field(default_factory=list)

    def __post_init__(self) -> None:
        super().__init__()
        self.links = Links(self.pieces)

    def leave_out_thread(self, error: BaseException) -> bool:
        """Leave out the thread that calls this, and ends with this error; False where it is of no package.

        A package begins its threads by itself, so only their code says whose they are.
        """
        what = f"the thread {threading.current_thread().name}"
        modules = (frame.f_globals.get("__name__", "") for frame, _ in walk_tb(error.__traceback__))
        pieces = (_piece_in(each, what) for each in modules if not isinstance(error, SystemExit))
        piece = next((each for each in pieces if each is not None), None)
        if piece is not None:
            self.pieces.leave_out(piece, error)
        return piece is not None


def _piece_in(module: str, what: str) -> Piece | None:
    """A piece whose code is in this module; None where no package with parts has it."""
    points = (each for each in registered(GROUP) if _top(each.module) == _top(module))
    return next((piece_of(each, what) for each in points), None)


def _top(module: str) -> str:
    return module.partition(".")[0]
