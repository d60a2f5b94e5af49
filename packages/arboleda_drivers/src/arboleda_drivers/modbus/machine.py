"""Device behind Modbus: the writes for a command, the reads, and the report made of them.

Each poll reads the echo first and the facts last: a PLC sets its facts before it says that it is done, so
what is read with a number is never older than it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from arboleda.drivers import (
    Command,
    Device,
    DriverError,
    Effect,
    NotSent,
    Report,
    Robot,
    Stop,
    StopMode,
    Value,
    VerbCommand,
)
from arboleda_drivers.plc.numbers import Numbers
from arboleda_drivers.plc.plc_snapshot import PlcSnapshot, ProgramWatch, Question, report

from .keys import ModbusKeys
from .registers import Register, Write

MOST = {"coil": 2000, "discrete": 2000, "holding": 125, "input": 125}  # of one request, by the standard
ECHOES = ("accepted", "done", "rejected", "failed")
Raw = Mapping[tuple[str, int], int]
"""The values read, by table and address."""


@dataclass(frozen=True, kw_only=True)
class Block:
    """Neighbouring registers that are read with one request."""

    table: str
    address: int
    length: int


@dataclass(frozen=True, kw_only=True)
class WriteRequest:
    """Values for neighbouring coils or registers, written with one request."""

    table: str
    address: int
    values: tuple[int, ...]


class ModbusDevice:
    """Device behind Modbus: makes writes of commands and reports of values read.

    Call `begin` at each new connection, with the values of `first_blocks`.
    """

    def __init__(self, device: Robot, settings: ModbusKeys) -> None:
        if not isinstance(device, Device):
            raise DriverError(f"{device.name} is of no declared kind, so nothing can be mapped")
        self._device, self._settings = device, settings
        self._numbers = Numbers()
        self._written = 0  # the number in its register: a PLC notices only a change
        self._query: tuple[int, Register, type[Value]] | None = None
        self._alive = ProgramWatch(settings.alive_s)
        read = [register for _, register in readings(settings)]
        written = [settings.sequence.write] if settings.sequence is not None else []
        self.blocks = blocks(read)
        self.first_blocks = blocks([*read, *written])

    def begin(self, raw: Raw) -> None:
        """Note the command numbers that the PLC still shows; they are of no command of this connection."""
        sequence = self._settings.sequence
        echo = self._echo(raw)
        self._numbers.begin(echo.get("accepted"))
        if sequence is not None:
            self._written = int(sequence.write.number(taken(sequence.write, raw)))
            self._numbers.see({*echo.values(), self._written})
        self._query = None
        self._alive.begin()

    def order(self, command: Command) -> tuple[WriteRequest, ...]:
        """The writes for a command, in order; raises NotSent if the mapping does not know it."""
        if isinstance(command, Stop):
            return self._stop(command.mode)
        if not isinstance(command, VerbCommand) or command.verb not in self._settings.verbs:
            raise NotSent(f"the mapping of {self._device.name} has no word for {type(command).__name__}")
        verb = self._settings.verbs[command.verb]
        puts = [put(write, dict(command.values)) for write in verb.write]
        sequence = self._settings.sequence
        if sequence is not None:
            self._written = number = self._numbers.give(command.id)
            there = sequence.write
            puts.append(WriteRequest(table="holding", address=there.address, values=there.raw(number)))
            if command.definition.effect is Effect.QUERY and verb.answer is not None:
                self._query = (number, verb.answer, command.definition.answer_type.type)
        return joined(puts)

    def report(self, at: float, raw: Raw) -> Report:
        """The report that the values read make; raises Unreadable if the mapping has no meaning for one."""
        if self._settings.alive is not None:
            alive = self._settings.alive
            self._alive.see(at, str(alive), alive.number(taken(alive, raw)))
        kinds, settings = self._device.kind.facts, self._settings
        state = settings.state
        echo, words = self._echo(raw), self._words(raw)
        self._numbers.see({*echo.values(), self._written})
        shown = PlcSnapshot(
            state="stopped" if state is None else str(state.read(taken(state, raw), str)),
            facts=tuple(
                (name, register.read(taken(register, raw), kinds[name].type))
                for name, register in settings.facts.items()
            ),
            boot=None if settings.boot is None else int(settings.boot.number(taken(settings.boot, raw))),
            accepted=echo.get("accepted"),
            done=echo.get("done"),
            rejected=echo.get("rejected"),
            reason=words.get("reason"),
            failed=echo.get("failed"),
            failure=words.get("failure"),
        )
        return report(self._device.name, at, shown, self._numbers, self._answer(raw, shown.done))

    def _stop(self, mode: StopMode) -> tuple[WriteRequest, ...]:
        settings = self._settings
        writes = settings.halt
        if mode is StopMode.LATCH:
            writes = settings.latch or settings.halt
        if mode is StopMode.CLEAR:
            writes = settings.clear
        return joined([put(write, {}) for write in writes])

    def _echo(self, raw: Raw) -> dict[str, int]:
        places = {name: getattr(self._settings.sequence, name, None) for name in ECHOES}
        return {name: int(each.number(taken(each, raw))) for name, each in places.items() if each is not None}

    def _words(self, raw: Raw) -> dict[str, str]:
        """The reason of a rejection or failure: its word, or its number if there is none."""
        registers = {name: getattr(self._settings.sequence, name, None) for name in ("reason", "failure")}
        found = {}
        for name, each in registers.items():
            if each is None:
                continue
            number = each.number(taken(each, raw))
            known = {held: word for word, held in each.words.items()}
            found[name] = known.get(int(number), f"code {number:g}")
        return found

    def _answer(self, raw: Raw, done: int | None) -> Question | None:
        if self._query is None or done != self._query[0]:
            return None
        number, register, of = self._query
        return Question(number=number, answer=register.read(taken(register, raw), of))


def readings(settings: ModbusKeys) -> Iterator[tuple[tuple[str, ...], Register]]:
    """All registers to read, by their keys; those that a PLC sets last are read first."""
    sequence = settings.sequence
    if sequence is not None:
        for name in ("done", "rejected", "failed", "accepted", "reason", "failure"):
            register = getattr(sequence, name)
            if register is not None:
                yield ("sequence", name), register
    for name in ("boot", "alive", "state"):
        register = getattr(settings, name)
        if register is not None:
            yield (name,), register
    for name, register in settings.facts.items():
        yield ("facts", name), register
    for name, verb in settings.verbs.items():
        if verb.answer is not None:
            yield ("verbs", name, "answer"), verb.answer


def blocks(registers: list[Register]) -> tuple[Block, ...]:
    """The requests that read these registers, each joined with its neighbours, in order of the first."""
    out: list[Block] = []
    for register in registers:
        block = Block(table=register.table, address=register.address, length=register.length)
        near = [other for other in out if _one(other, block) is not None]
        at = out.index(near[0]) if near else len(out)
        for other in near:
            out.remove(other)
            block = _one(other, block) or block
        out.insert(at, block)
    return tuple(out)


def _one(one: Block, other: Block) -> Block | None:
    """Two blocks as one request; None if there is a gap between them, or too much for one request."""
    low = min(one.address, other.address)
    high = max(one.address + one.length, other.address + other.length)
    if one.table != other.table or high - low > min(one.length + other.length, MOST[one.table]):
        return None
    return Block(table=one.table, address=low, length=high - low)


def taken(register: Register, raw: Raw) -> list[int]:
    """The values read for one register."""
    return [raw[register.table, register.address + at] for at in range(register.length)]


def put(write: Write, values: Mapping[str, Value]) -> WriteRequest:
    """A write, with the values of its verb put in."""
    value = write.value if write.parameter is None else values[write.parameter]
    return WriteRequest(table=write.table, address=write.address, values=write.raw(value))


def joined(puts: list[WriteRequest]) -> tuple[WriteRequest, ...]:
    """The same writes, successive neighbours joined into one request; their order stays."""
    out: list[WriteRequest] = []
    for each in puts:
        last = out[-1] if out else None
        if last is not None and last.table == each.table and last.address + len(last.values) == each.address:
            out[-1] = WriteRequest(table=last.table, address=last.address, values=last.values + each.values)
        else:
            out.append(each)
    return tuple(out)
