"""Handshake with the program of a PLC by named places: what was read becomes a report.

All is read in this order, the echo first and the facts last: a program sets its facts before it says that it
is done, so what is read with a number is never older than it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Protocol, TypeVar

from arboleda.drivers import (
    Command,
    Device,
    DriverError,
    Effect,
    FactType,
    NotSent,
    Report,
    Robot,
    StopMode,
    VerbCommand,
    quoted,
)

from .numbers import LAST, Numbers
from .plc_snapshot import STATES, UNNAMED, PlcSnapshot, ProgramWatch, Question, UnreadableValue, report
from .variables import PlcVariable, count, yes

ECHOES = ("done", "rejected", "failed", "accepted")
Read = Mapping[str, object]
"""The values read, by place."""
O_co = TypeVar("O_co", covariant=True)


class SequencePlaces(Protocol):
    """Places of the number of a command, which is written last, and of those that echo it.

    `busy` is for a program that echoes no accepted number, `error` for one that has a code for how the last
    command ended in place of other numbers.
    """

    @property
    def done(self) -> str: ...
    @property
    def accepted(self) -> str | None: ...
    @property
    def write(self) -> str | None: ...
    @property
    def busy(self) -> str | None: ...
    @property
    def error(self) -> PlcVariable | None: ...
    @property
    def rejected(self) -> str | None: ...
    @property
    def reason(self) -> PlcVariable | None: ...
    @property
    def failed(self) -> str | None: ...
    @property
    def failure(self) -> PlcVariable | None: ...
    @property
    def greatest(self) -> int:
        """The greatest number that fits."""

    @property
    def floats(self) -> bool:
        """True if numbers are shown as floats."""


class VerbPlaces(Protocol):
    """Place of the answer to a query."""

    @property
    def answer(self) -> PlcVariable | None: ...


class Mapped(Protocol[O_co]):
    """Mapping of one device in a plant file; `O_co` is the way to give an order."""

    @property
    def state(self) -> PlcVariable | None: ...
    @property
    def boot(self) -> str | None: ...
    @property
    def alive(self) -> str | None: ...
    @property
    def alive_s(self) -> float: ...
    @property
    def facts(self) -> Mapping[str, PlcVariable]: ...
    @property
    def verbs(self) -> Mapping[str, VerbPlaces]: ...
    @property
    def sequence(self) -> SequencePlaces | None: ...
    @property
    def halt(self) -> O_co: ...
    @property
    def latch(self) -> O_co: ...
    @property
    def clear(self) -> O_co: ...


class Handshake:
    """Numbers of the commands of one device, and its reports of values read.

    Call `begin` at each new connection, with the values of `places`.
    """

    def __init__(self, device: Robot, settings: Mapped[object]) -> None:
        if not isinstance(device, Device):
            raise DriverError(f"{device.name} is of no declared kind, so nothing can be mapped")
        self._device, self._settings = device, settings
        sequence = settings.sequence
        self._numbers = Numbers(LAST if sequence is None else min(LAST, sequence.greatest))
        self._busy = False  # as last read
        self._was_busy = False  # since before the last number was given: it is not busy with that
        self._ended: tuple[int, str | None] | None = None  # the last number that ended, and its error
        self._done = 0  # the last one that ended without
        self._alive = ProgramWatch(settings.alive_s)
        self._query: tuple[int, PlcVariable, FactType] | None = None
        self.places = tuple(dict.fromkeys(_readings(settings)))

    def begin(self, read: Read) -> None:
        """Note the command numbers that the PLC still shows; they are of no command of this connection."""
        self._was_busy, self._ended, self._done = False, None, 0
        echo = self._echo(read)
        self._numbers.begin(echo.get("accepted"))
        self._numbers.see(self._shown(echo, read))
        self._alive.begin()
        self._query = None

    def verb(self, command: Command) -> VerbCommand:
        """The command as a mapped verb; raises NotSent for anything else."""
        if not isinstance(command, VerbCommand) or command.verb not in self._settings.verbs:
            raise NotSent(f"the mapping of {self._device.name} has no word for {type(command).__name__}")
        return command

    def number(self, command: VerbCommand) -> int:
        """The number for a verb, which its echo is told by from now on."""
        given = self._numbers.give(command.id)
        self._was_busy = self._busy
        answer = self._settings.verbs[command.verb].answer
        if command.definition.effect is Effect.QUERY and answer is not None:
            self._query = (given, answer, command.definition.answer_type)
        return given

    def report(self, at: float, read: Read) -> Report:
        """The report of the values read; raises UnreadableValue if the mapping has no meaning for one."""
        settings, kinds = self._settings, self._device.kind.facts
        if settings.alive is not None:
            self._alive.see(at, settings.alive, count(settings.alive, read[settings.alive]))
        echo = self._echo(read)
        self._numbers.see(self._shown(echo, read))
        shown = PlcSnapshot(
            state=self._state(read),
            facts=tuple(
                (name, one.read(read[one.place], kinds[name])) for name, one in settings.facts.items()
            ),
            boot=None if settings.boot is None else count(settings.boot, read[settings.boot]),
            reason=self._why("reason", read),
            failure=self._why("failure", read) if self._ended is None else self._ended[1],
            **echo,
        )
        return report(self._device.name, at, shown, self._numbers, self._answer(read, shown.done))

    def _state(self, read: Read) -> str:
        state = self._settings.state
        if state is None:
            return "moving" if self._busy else "stopped"
        word = state.word(read[state.place])
        if not isinstance(word, str) or word not in STATES:
            raise UnreadableValue(f"{state.place} is {quoted(word)}; allowed: {', '.join(STATES)}")
        return word

    def _echo(self, read: Read) -> dict[str, int]:
        """The numbers of commands that the PLC shows, by what they say of them."""
        sequence = self._settings.sequence
        if sequence is None:
            return {}
        places = {name: getattr(sequence, name) for name in ECHOES}
        floats = sequence.floats
        echo = {
            name: count(place, read[place], floats=floats)
            for name, place in places.items()
            if place is not None
        }
        ended = echo["done"]
        if sequence.error is not None:
            error = self._why("error", read)
            if self._ended is None or self._ended[0] != ended:  # a later error belongs to the next command
                self._ended = (ended, error)
            if self._ended[1] is not None:
                echo |= {"failed": ended, "done": self._done}
            self._done = echo["done"]
        if sequence.busy is not None and sequence.write is not None:
            self._busy = yes(sequence.busy, read[sequence.busy])
            self._was_busy = self._was_busy and self._busy
            written = count(sequence.write, read[sequence.write], floats=floats)
            is_taken = (self._busy and not self._was_busy) or written == echo.get("failed")
            echo["accepted"] = written if is_taken else ended
        return echo

    def _shown(self, echo: Mapping[str, int], read: Read) -> set[int]:
        """All numbers that a new command must not get: a program notices only a change of its request."""
        sequence = self._settings.sequence
        if sequence is None or sequence.write is None:
            return set(echo.values())
        return {*echo.values(), count(sequence.write, read[sequence.write], floats=sequence.floats)}

    def _why(self, name: str, read: Read) -> str | None:
        """The reason of a rejection or failure: its word, or its number if there is none."""
        variable: PlcVariable | None = getattr(self._settings.sequence, name, None)
        if variable is None:
            return None
        shown = read[variable.place]
        if name == "error" and isinstance(shown, bool):
            return UNNAMED if shown else None
        known = {held: word for word, held in variable.words.items()}
        if isinstance(shown, int) and not isinstance(shown, bool):
            if name == "error" and shown == 0:
                return None
            return str(known.get(shown, f"code {shown}"))
        if isinstance(shown, str):
            return shown or None
        raise UnreadableValue(f"{variable.place} is {quoted(shown)}; allowed: a whole number, or text")

    def _answer(self, read: Read, done: int | None) -> Question | None:
        if self._query is None or done != self._query[0]:
            return None
        query, variable, of = self._query
        return Question(number=query, answer=variable.read(read[variable.place], of))


def stop_order(settings: Mapped[O_co], mode: StopMode) -> O_co:
    """The way to give a stop of that mode; without `latch` it is that of `halt`."""
    if mode is StopMode.CLEAR:
        return settings.clear
    return (settings.latch or settings.halt) if mode is StopMode.LATCH else settings.halt


def _readings(settings: Mapped[object]) -> Iterator[str]:
    """The places to read; those that a program sets last are read first.

    A program often shows all of it in one block, which one request reads as it is at one moment. The number
    that was written lies in another block, so it is read last, and in between only where `busy` needs it.
    """
    sequence = settings.sequence
    written: str | None = getattr(sequence, "write", None)
    busy: str | None = getattr(sequence, "busy", None)
    for name in ECHOES:
        place: str | None = getattr(sequence, name, None)
        if place is not None:
            yield place
    for name in ("reason", "failure", "error"):
        variable: PlcVariable | None = getattr(sequence, name, None)
        if variable is not None:
            yield variable.place
    if written is not None and busy is not None:
        yield from (busy, written)
    yield from (node for node in (settings.boot, settings.alive) if node is not None)
    if settings.state is not None:
        yield settings.state.place
    yield from (variable.place for variable in settings.facts.values())
    yield from (verb.answer.place for verb in settings.verbs.values() if verb.answer is not None)
    if written is not None and busy is None:
        yield written
