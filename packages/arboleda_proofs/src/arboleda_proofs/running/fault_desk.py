"""FaultsApi of the plant in this process: has faults of the simulator happen to its virtual devices."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future
from concurrent.futures import TimeoutError as NotInTime
from functools import cached_property
from itertools import count
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

from arboleda.drivers import Robot
from arboleda.extension import ArboledaError, Phrase, Sentence
from arboleda.model.messages import Event, FaultByHand
from arboleda.model.plant_model import PlantModel
from arboleda_proofs.running.api import BegunFault, FaultOffer, FaultRefused, FaultsApi
from arboleda_proofs.simulator.fault_bench import (
    FaultBench,
    MishapBegins,
    MishapEnds,
    MishapNote,
    MishapOver,
)

if TYPE_CHECKING:
    from arboleda_proofs.simulator.mishaps import Mishap

LOG = logging.getLogger("arboleda.operators")
USUAL_S, SHORTEST_S, LONGEST_S = 5.0, 0.1, 3600.0
ANSWER_S = 5.0
BEGAN = Phrase("fault.began", "fault by hand: {what}, for {seconds:g} s")
INSTANT = Phrase("fault.instant", "fault by hand: {what}")
OVER = Phrase("fault.over", "fault by hand is over: {what}")
NOT_VIRTUAL = Phrase(
    "fault.not_virtual",
    "faults can be provoked only at virtual devices, and this start of the plant has none in its process",
)
NO_ROBOT = Phrase("fault.no_robot", "there is no device {robot}; virtual ones are {names}")
REAL = Phrase("fault.real", "{robot} is no virtual device in this start; virtual ones are {names}")
NO_KIND = Phrase("fault.no_kind", "{kind} cannot be provoked at {robot}; what can is {kinds}")
TOO_LONG = Phrase("fault.seconds", "a fault lasts from {least:g} s to {most:g} s, not {seconds:g} s")
AN_INSTANT = Phrase("fault.an_instant", "{kind} is over at once: leave out for how long")
NO_NUMBER = Phrase("fault.no_number", "no fault {number} goes on now")
Seen = TypeVar("Seen")
NO_ANSWER = Phrase("fault.no_answer", "the virtual devices do not answer; the log says why")


class VirtualDevices(Protocol):
    """Virtual devices of this process, which take faults and tell what went on."""

    @property
    def boards(self) -> Sequence[str]:
        """Their boards, by MQTT name."""

    def befall(self, event: Any) -> None:
        """Have something happen to them; from any thread."""

    def read(self, look: Callable[[Any], Seen]) -> tuple[float, Seen]:
        """The time on their clock, and what is seen at their bench."""


class FaultDesk(FaultsApi):
    """FaultDesk: for threads of a server; without `devices` it refuses all. `tell` gives the plant events."""

    def __init__(
        self, model: PlantModel, devices: VirtualDevices | None, tell: Callable[[Event], None]
    ) -> None:
        self._model = model
        self._devices = devices
        self._tell = tell
        self._numbers = count(1)
        self._awaited: dict[int, Future[MishapNote | MishapOver]] = {}

    @cached_property
    def _robots(self) -> dict[str, Robot]:
        """The virtual robots by the names of their boards, in the order of the plant file."""
        boards = () if self._devices is None else self._devices.boards
        return {each.mqtt: each for each in self._model.robots.values() if each.mqtt in boards}

    @cached_property
    def _possible(self) -> dict[str, list[Mishap]]:
        """The mishaps that can befall each virtual robot, by its name."""
        of_boards = [mishap for mishap in _mishaps().values() if mishap.is_of_boards]
        targets = {mishap.name: mishap.targets(self._model) for mishap in of_boards}
        return {
            robot.name: [mishap for mishap in of_boards if board in targets[mishap.name]]
            for board, robot in self._robots.items()
        }

    def offers(self) -> Sequence[FaultOffer]:
        return [
            FaultOffer(robot=robot, kind=each.name, about=each.sentence, lasts=each.lasts)
            for robot, mishaps in self._possible.items()
            for each in mishaps
        ]

    def begun(self) -> Sequence[BegunFault]:
        if self._devices is None:
            return []
        now, notes = self._devices.read(_going_on)
        return [self._fault(note, now) for note in notes]

    def begin(self, kind: str, robot: str, seconds: float | None) -> BegunFault:
        mishap = self._chosen(kind, robot)
        if seconds is not None and not mishap.lasts:
            if not mishap.longer:
                raise FaultRefused(AN_INSTANT(kind=kind))
            mishap = _mishaps()[mishap.longer]
        lasting = (USUAL_S if seconds is None else seconds) if mishap.lasts else 0.0
        if mishap.lasts and not SHORTEST_S <= lasting <= LONGEST_S:
            raise FaultRefused(TOO_LONG(least=SHORTEST_S, most=LONGEST_S, seconds=lasting))
        number, board = next(self._numbers), self._model.robots[robot].mqtt
        note = self._done(MishapBegins(number=number, name=mishap.name, board=board, seconds=lasting))
        assert isinstance(note, MishapNote)
        return self._fault(note, note.at)

    def end(self, robot: str = "", number: int | None = None) -> Sequence[BegunFault]:
        if robot:
            self._require_virtual(robot)
        elif self._devices is None:
            raise FaultRefused(NOT_VIRTUAL())
        found = [each for each in self.begun() if robot in ("", each.robot) and number in (None, each.number)]
        if number is not None and not found:
            raise FaultRefused(NO_NUMBER(number=number))
        for each in found:
            self._done(MishapEnds(number=each.number))
        return found

    def noted(self, note: MishapNote | MishapOver) -> None:
        """Take what went on at the devices, in their thread, and tell the plant."""
        if isinstance(note, MishapNote):
            self._tell_plant(note)
        awaited = self._awaited.pop(note.number, None)
        if awaited is not None:
            awaited.set_result(note)

    def _tell_plant(self, note: MishapNote) -> None:
        robot, what = self._robots[note.board].name, _mishaps()[note.name].sentence
        sentence = _sentence(note, what)
        self._tell(FaultByHand(at=note.at, robot=robot, sentence=sentence, is_over=note.is_over))
        LOG.info("%s: %s", robot, sentence)

    def _done(self, event: MishapBegins | MishapEnds) -> MishapNote | MishapOver:
        """Have the devices do this, and wait for it."""
        assert self._devices is not None
        answer = self._awaited[event.number] = Future()
        self._devices.befall(event)
        try:
            return answer.result(ANSWER_S)
        except NotInTime:
            self._awaited.pop(event.number, None)
            raise ArboledaError(NO_ANSWER()) from None

    def _chosen(self, kind: str, robot: str) -> Mishap:
        self._require_virtual(robot)
        found = next((each for each in self._possible[robot] if each.name == kind), None)
        if found is None:
            names = tuple(each.name for each in self._possible[robot])
            raise FaultRefused(NO_KIND(kind=kind, robot=robot, kinds=names))
        return found

    def _require_virtual(self, robot: str) -> None:
        names = tuple(self._possible)
        if not names:
            raise FaultRefused(NOT_VIRTUAL())
        if robot not in names:
            phrase = REAL if robot in self._model.robots else NO_ROBOT
            raise FaultRefused(phrase(robot=robot, names=names))

    def _fault(self, note: MishapNote, now: float) -> BegunFault:
        left_s = 0.0 if note.ends_at is None else max(0.0, note.ends_at - now)
        return BegunFault(
            number=note.number,
            robot=self._robots[note.board].name,
            kind=note.name,
            about=_mishaps()[note.name].sentence,
            left_s=left_s,
        )


def _mishaps() -> Mapping[str, Mishap]:
    """The mishaps by name; this loads the whole simulator, which most plants never need."""
    from arboleda_proofs.simulator.mishaps import MISHAPS

    return MISHAPS


def _going_on(bench: FaultBench) -> list[MishapNote]:
    return list(bench.begun.values())


def _sentence(note: MishapNote, what: Sentence) -> Sentence:
    if note.is_over:
        return OVER(what=what)
    if note.ends_at is None:
        return INSTANT(what=what)
    return BEGAN(what=what, seconds=round(note.ends_at - note.at, 3))
