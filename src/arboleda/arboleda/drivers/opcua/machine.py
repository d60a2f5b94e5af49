"""Device behind OPC UA: the call for a command, the reads, and the report made of them.

All is read with one request, the echo first and the facts last: a server sets its facts before it says that
it is done, so what is read with a number is never older than it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from arboleda.kinds.declared import Device, Effect, FactType, VerbCall
from arboleda.model.commands import Command, Stop, StopMode
from arboleda.model.facts import Value
from arboleda.model.messages import Report
from arboleda.model.outside import quoted
from arboleda.model.plant_model import Robot

from ..plc.checks import answers
from ..plc.numbers import Numbers
from ..plc.plc_snapshot import STATES, PlcSnapshot, Question, UnreadableValue, report
from ..plc.program_watch import ProgramWatch
from ..port import DriverError, NotSent
from .nodes import Method, Variable, number
from .settings import Settings

ECHOES = ("done", "rejected", "failed", "accepted")
Read = Mapping[str, object]
"""The values read, by node."""


@dataclass(frozen=True, kw_only=True)
class Call:
    """Method to call, with its arguments, each with its type in OPC UA."""

    method: str
    on: str
    given: tuple[tuple[str, Value], ...] = ()


class OpcUaDevice:
    """Device behind OPC UA: makes calls of commands and reports of values read.

    Call `begin` at each new session, with the values of `nodes`.
    """

    def __init__(self, device: Robot, settings: Settings) -> None:
        if not isinstance(device, Device):
            raise DriverError(f"{device.name} is of no declared kind, so nothing can be mapped")
        self._device, self._settings = device, settings
        self._numbers = Numbers()
        self._alive = ProgramWatch(settings.alive_s)
        self._asked: tuple[int, Variable, FactType] | None = None
        self.nodes = tuple(dict.fromkeys(_readings(settings)))

    def begin(self, read: Read) -> None:
        """Note the command numbers that the server still shows; they are of no command of this session."""
        self._numbers.begin()
        self._numbers.see(self._echo(read).values())
        self._alive.begin()
        self._asked = None

    def order(self, command: Command) -> Call | None:
        """The method call for a command; None for a stop without a method, NotSent for an unmapped verb."""
        if isinstance(command, Stop):
            method = self._stop(command.mode)
            return None if method is None else call(method, {})
        if not isinstance(command, VerbCall) or command.verb not in self._settings.verbs:
            raise NotSent(f"the mapping of {self._device.name} has no word for {type(command).__name__}")
        verb, sequence = self._settings.verbs[command.verb], self._settings.sequence
        made = call(verb, dict(command.values))
        if sequence is None:
            return made
        given = self._numbers.give(command.id)
        if command.told.effect is Effect.QUERY and verb.answer is not None:
            self._asked = (given, verb.answer, answers(command.told))
        return Call(method=made.method, on=made.on, given=(*made.given, (sequence.type, given)))

    def report(self, at: float, read: Read) -> Report:
        """The report of the values read; raises UnreadableValue if the mapping has no meaning for one."""
        settings, kinds = self._settings, self._device.kind.facts
        if settings.alive is not None:
            self._alive.see(at, settings.alive, number(settings.alive, read[settings.alive]))
        echo = self._echo(read)
        self._numbers.see(echo.values())
        shown = PlcSnapshot(
            state="stopped" if settings.state is None else _state(settings.state, read),
            facts=tuple(
                (name, one.read(read[one.node], kinds[name])) for name, one in settings.facts.items()
            ),
            boot=None if settings.boot is None else number(settings.boot, read[settings.boot]),
            reason=self._why("reason", read),
            failure=self._why("failure", read),
            **echo,
        )
        return report(self._device.name, at, shown, self._numbers, self._answer(read, shown.done))

    def _stop(self, mode: StopMode) -> Method | None:
        settings = self._settings
        if mode is StopMode.CLEAR:
            return settings.clear
        return (settings.latch or settings.halt) if mode is StopMode.LATCH else settings.halt

    def _echo(self, read: Read) -> dict[str, int]:
        places = {name: getattr(self._settings.sequence, name, None) for name in ECHOES}
        return {name: number(node, read[node]) for name, node in places.items() if node is not None}

    def _why(self, name: str, read: Read) -> str | None:
        """The reason of a rejection or failure: its word, or its number if there is none."""
        variable = getattr(self._settings.sequence, name, None)
        if variable is None:
            return None
        shown = read[variable.node]
        known = {held: word for word, held in variable.words.items()}
        if isinstance(shown, int) and not isinstance(shown, bool):
            return str(known.get(shown, f"code {shown}"))
        if isinstance(shown, str):
            return shown or None
        raise UnreadableValue(f"{variable.node} is {quoted(shown)}; allowed: a whole number, or text")

    def _answer(self, read: Read, done: int | None) -> Question | None:
        if self._asked is None or done != self._asked[0]:
            return None
        asked, variable, of = self._asked
        return Question(number=asked, answer=variable.read(read[variable.node], of))


def call(method: Method, values: Mapping[str, Value]) -> Call:
    """The call of a method, with the values of its verb put in."""
    given = tuple(
        (each.type, each.given(each.value if each.parameter is None else values[each.parameter]))
        for each in method.given
    )
    return Call(method=method.call, on=method.on, given=given)


def _state(state: Variable, read: Read) -> str:
    word = state.word(read[state.node])
    if not isinstance(word, str) or word not in STATES:
        raise UnreadableValue(f"{state.node} is {quoted(word)}; allowed: {', '.join(STATES)}")
    return word


def _readings(settings: Settings) -> Iterator[str]:
    """The nodes to read; those that a server sets last are read first."""
    sequence = settings.sequence
    for name in ECHOES:
        node = getattr(sequence, name, None)
        if node is not None:
            yield node
    for variable in (getattr(sequence, "reason", None), getattr(sequence, "failure", None)):
        if variable is not None:
            yield variable.node
    yield from (node for node in (settings.boot, settings.alive) if node is not None)
    if settings.state is not None:
        yield settings.state.node
    yield from (variable.node for variable in settings.facts.values())
    yield from (verb.answer.node for verb in settings.verbs.values() if verb.answer is not None)
