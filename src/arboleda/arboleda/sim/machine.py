"""What a declared device drives, virtual: it does what its verbs say, in the time that they take."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from arboleda.core.commands import OnStop
from arboleda.core.facts import Facts, Value
from arboleda.kinds.declared import DeviceKind, DeviceVerb, Effect, Told, UseError
from arboleda.wire.payloads import DEVICE, OrderGoal
from arboleda.wire.topics import Channel

from . import body
from .body import End

WORK = frozenset({Effect.MOTION, Effect.PROCESS})
SUPERSEDED = "relevado"  # the word for a switch that another one of the same fact has overtaken


@dataclass(frozen=True, kw_only=True)
class Deed:
    """An order that it carries out, until `ends_us`."""

    goal: OrderGoal
    command: Told
    ends_us: int

    @property
    def verb(self) -> DeviceVerb:
        return self.command.told

    @property
    def is_work(self) -> bool:
        return self.verb.effect in WORK


class MachineBody:
    """One work at a time, one switch per fact, one query; each becomes true at its end, and not before.

    `facts` are how the machine truly is, whatever its board does. Without power it lets go of what it holds,
    as a gripper does whose spring opens it: what it holds is then lost, which is worse for the plant than a
    clamp that stays. Everything else stays as it is: a door does not move because its board boots.

    `answer` says what it answers to a query, and `fails` with what word an order will end as given up; None:
    it will be done.
    """

    axes: int | None = DEVICE
    channels = frozenset({Channel.ORDER, Channel.STOP, Channel.BEAT})
    homes = False

    def __init__(self, kind: DeviceKind) -> None:
        self.kind = kind
        self.facts: dict[str, Value] = {name: type.first for name, type in kind.facts.items()}
        self.answer: Callable[[OrderGoal], Value] = self.first_answer
        self.fails: Callable[[OrderGoal], str | None] = _never
        self.ends: list[End] = []
        self._deeds: list[Deed] = []
        self.next_change_us: int | None = None

    def reset(self) -> None:
        self._deeds, self.ends, self.next_change_us = [], [], None
        if self.kind.held_fact is not None:
            self.facts[self.kind.held_fact] = False

    def set_by_hand(self, facts: Facts) -> None:
        if not self._deeds:
            self.facts.update(facts)

    @property
    def true_place(self) -> None:
        """It stands where it is."""

    @property
    def true_facts(self) -> dict[str, Value]:
        return self.facts

    @property
    def moving(self) -> bool:
        return any(deed.is_work for deed in self._deeds)

    @property
    def finishes(self) -> bool:
        return any(deed.is_work and deed.verb.on_stop is OnStop.FINISH for deed in self._deeds)

    def first_answer(self, goal: OrderGoal) -> Value:
        """The first of the answers that its kind declares for a query."""
        return self.kind.verbs[goal.verb].answers[0]

    def objection(self, goal: OrderGoal, *, latched: bool, faulted: bool) -> str | None:
        """The word that refuses an order now; None where it can be carried out."""
        command = self._command(goal)
        if command is None:
            return "formato"
        works = command.told.effect in WORK
        if latched and not _goes_on_while_stopped(command):
            return "paro"
        if works and (self.moving or faulted):
            return "ocupado"
        return None if all(self.facts[name] == value for name, value in command.needs) else "condicion"

    def is_work(self, goal: OrderGoal) -> bool:
        return self.kind.verbs[goal.verb].effect in WORK

    def start(self, now_us: int, goal: OrderGoal) -> None:
        """Begin an order without an objection; even what takes no time takes a moment."""
        command = self._command(goal)
        assert command is not None
        self._supersede(command)
        takes_us = max(1, round(command.told.takes_s * 1e6))
        self._deeds.append(Deed(goal=goal, command=command, ends_us=now_us + takes_us))
        self._plan()

    def stop(self, now_us: int) -> None:
        """Work ends where it is; what it would have set stays as it was."""
        self._deeds = [deed for deed in self._deeds if not deed.is_work]
        self._plan()

    def advance(self, now_us: int) -> None:
        for deed in sorted(self._deeds, key=lambda each: each.ends_us):
            if deed.ends_us <= now_us:
                self._deeds.remove(deed)
                self._end(deed)
        self._plan()

    def take_ends(self) -> list[End]:
        taken, self.ends = self.ends, []
        return taken

    def tell(self) -> body.Told:
        facts: Facts = tuple(self.facts.items())
        return body.Told(facts=facts)

    def admits(self, goal: object) -> bool:
        raise NotImplementedError("a machine takes orders only")

    def home(self, now_us: int) -> None:
        raise NotImplementedError("a machine has no reference")

    def switch_effector(self, on: bool) -> None:
        raise NotImplementedError("what a machine holds is one of its facts")

    def put_at_reference(self) -> None:
        """It has none."""

    def _command(self, goal: OrderGoal) -> Told | None:
        """What an order asks for; None where its kind knows no such verb or value."""
        verb = self.kind.verbs.get(goal.verb)
        types = dict(verb.parameters) if verb else {}
        read = {name: types[name].read(value) if name in types else None for name, value in goal.values}
        values = {name: value for name, value in read.items() if value is not None}
        if len(values) < len(goal.values):
            return None
        try:
            command = self.kind.command(id="", robot="", verb=goal.verb, values=values)
        except UseError:
            return None
        assert isinstance(command, Told)
        return command

    def _supersede(self, command: Told) -> None:
        """Forget the query that was asked before, and give up the switches whose facts this one sets."""
        effect, sets = command.told.effect, {name for name, _ in command.sets}
        for deed in [deed for deed in self._deeds if deed.verb.effect is effect]:
            if effect is Effect.SWITCH and sets & {name for name, _ in deed.command.sets}:
                self._deeds.remove(deed)
                self.ends.append(End(deed.goal, failure=SUPERSEDED))
            elif effect is Effect.QUERY:
                self._deeds.remove(deed)

    def _end(self, deed: Deed) -> None:
        word = self.fails(deed.goal)
        if word is not None:
            self.ends.append(End(deed.goal, failure=word))
            return
        self.facts.update(deed.command.sets)
        if deed.verb.effect is Effect.QUERY:
            self.ends.append(End(deed.goal, answer=self.answer(deed.goal)))

    def _plan(self) -> None:
        self.next_change_us = min((deed.ends_us for deed in self._deeds), default=None)


def _goes_on_while_stopped(command: Told) -> bool:
    """A query, or what lets go of a part."""
    return command.told.effect is Effect.QUERY or getattr(command, "grips", None) is False


def _never(goal: OrderGoal) -> None:
    """Every order will be done."""
