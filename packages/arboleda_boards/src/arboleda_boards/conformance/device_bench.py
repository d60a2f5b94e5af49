"""Bench of the board of a declared kind: keeps its reports, and makes the orders that a check may ask for."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import islice, product

from arboleda.drivers import Device, DeviceKind, DeviceVerb, Effect, Facts, MotionState, Value, VerbCommand
from arboleda.wire import payloads
from arboleda.wire.topics import Channel
from arboleda.wire.transport import Delivery

from .bench import Bench, BoardTelemetry, Send

WORK = frozenset({Effect.MOTION, Effect.PROCESS})
MOST_VALUES = 12  # so many combinations of values of one verb are tried
MOST_STATES = 2000  # so many ways for the facts to be are looked at on the search for a way


@dataclass(frozen=True, kw_only=True)
class DeviceTelemetry(BoardTelemetry):
    """One telemetry message; `place` has the facts that are no measured numbers."""

    facts: Facts | None
    firm: tuple[tuple[str, Value], ...]
    answer: Value | None
    answered: int | None
    failures: tuple[tuple[int, str], ...]

    @property
    def place(self) -> tuple[tuple[str, Value], ...]:
        return self.firm


class DeviceBench(Bench[DeviceTelemetry]):
    """A declared device's board on trial; `facts` has the last value of each."""

    def __init__(self, device: Device, epoch: int) -> None:
        super().__init__(device.mqtt, epoch)
        self.kind = device.kind
        self.facts: dict[str, Value] = {}
        self.patience_s = 2.0 + max((verb.at_most_s for verb in self.kind.verbs.values()), default=0.0)

    @property
    def says_where(self) -> bool:
        return self.last.facts is not None

    @property
    def place(self) -> tuple[tuple[str, Value], ...]:
        return self.last.firm if self.reports else ()

    def order(
        self, command: VerbCommand, *, seq: int | None = None, epoch: int | None = None, **body: int | str
    ) -> Send:
        """The order of a verb with its values."""
        values = {"valores": dict(command.values)} if command.values else {}
        return self.send(Channel.ORDER, seq=seq, epoch=epoch, verbo=command.verb, **values, **body)

    def holds(self, facts: Facts) -> bool:
        """True if its last report has all of these facts."""
        return all(self.facts.get(name) == value for name, value in facts)

    def way(self, wanted: Callable[[VerbCommand], bool]) -> list[VerbCommand] | None:
        """The shortest row of orders that ends in one that is wanted, as the kind declares what each sets
        and needs; one that changes a fact rather than one that changes none. None: there is no way."""
        changing = self._search(lambda command, facts: wanted(command) and not _so(facts, command.sets))
        return changing or self._search(lambda command, facts: wanted(command))

    def _search(self, wanted: Callable[[VerbCommand, dict[str, Value]], bool]) -> list[VerbCommand] | None:
        first = self.facts or {name: type.first for name, type in self.kind.facts.items()}
        visited, ahead = {_frozen(first)}, deque([(first, list[VerbCommand]())])
        while ahead and len(visited) < MOST_STATES:
            facts, row = ahead.popleft()
            for command in self._possible(facts):
                if wanted(command, facts):
                    return [*row, command]
                after = facts | dict(command.sets)
                if _frozen(after) not in visited:
                    visited.add(_frozen(after))
                    ahead.append((after, [*row, command]))
        return None

    def _possible(self, facts: dict[str, Value]) -> Iterator[VerbCommand]:
        return (
            command
            for verb in self.kind.verbs.values()
            for command in commands(self.kind, verb)
            if _so(facts, command.needs)
        )

    def _read(self, delivery: Delivery) -> DeviceTelemetry:
        telemetry = payloads.decode(Channel.TELEMETRY, delivery.payload, axes=payloads.DEVICE)
        assert isinstance(telemetry, payloads.Telemetry)
        self.facts |= dict(telemetry.facts or ())
        return DeviceTelemetry(
            at=delivery.at,
            state=MotionState(telemetry.state).value,
            number=telemetry.seq,
            epoch=telemetry.ack_epoch,
            least_epoch=telemetry.least_epoch,
            ack=telemetry.ack,
            done=telemetry.done,
            refusal=telemetry.refusal,
            refused=telemetry.refused_seq,
            boot_id=telemetry.boot_id,
            ack_token=telemetry.ack_token,
            done_token=telemetry.done_token,
            facts=telemetry.facts,
            firm=tuple((name, value) for name, value in self.facts.items() if self._is_firm(name)),
            answer=telemetry.answer,
            answered=telemetry.answered_seq,
            failures=telemetry.failures or (),
        )

    def _is_firm(self, name: str) -> bool:
        type = self.kind.facts.get(name)
        return type is None or type.type is not float or bool(type.words)


def commands(kind: DeviceKind, verb: DeviceVerb) -> Iterator[VerbCommand]:
    """A verb with samples of its values."""
    names = [name for name, _ in verb.parameters]
    for values in islice(product(*(type.samples for _, type in verb.parameters)), MOST_VALUES):
        command = kind.command(id="", robot="", verb=verb.name, values=dict(zip(names, values, strict=True)))
        assert isinstance(command, VerbCommand)
        yield command


def is_work(command: VerbCommand) -> bool:
    """True if an order is a motion or a process."""
    return command.definition.effect in WORK


def _so(facts: dict[str, Value], wanted: Facts) -> bool:
    return all(facts.get(name) == value for name, value in wanted)


def _frozen(facts: dict[str, Value]) -> frozenset[tuple[str, Value]]:
    return frozenset(facts.items())
