"""Virtual machine of a declared device: it does what its verbs say, in the time that they take."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from arboleda.kinds.declared import DeviceKind, DeviceVerb, Effect, UseError, VerbCall
from arboleda.model import refusals
from arboleda.model.commands import OnStop
from arboleda.model.facts import Facts, Value
from arboleda.wire.payloads import DEVICE, VerbGoal
from arboleda.wire.topics import Channel

from . import body
from .body import End

WORK = frozenset({Effect.MOTION, Effect.PROCESS})
SUPERSEDED = "relevado"  # the word for a switch that another order for the same fact has overtaken
UNSHOWN = "virtual"  # the word for what ends in an error of the function that its kind gives virtual devices


@dataclass(frozen=True, kw_only=True)
class RunningOrder:
    """Order that is carried out until `ends_us`."""

    goal: VerbGoal
    command: VerbCall
    ends_us: int
    is_late: bool = False  # it takes longer than it should
    is_repeat: bool = False  # a question that was answered, and is answered once more

    @property
    def verb(self) -> DeviceVerb:
        return self.command.definition

    @property
    def is_work(self) -> bool:
        return self.verb.effect in WORK


class MachineBody:
    """Body of a declared device: one work at a time, one switch per fact, one query; facts change at its end.

    `facts` are the true ones, whatever the board reports. Without power the machine lets go of a part, as a
    gripper opened by a spring does: the part is then lost, which is worse for the plant than a clamp that
    stays. Everything else stays as it is: a door does not move because its board boots.

    Functions of the order decide on its behaviour:

    - `answer`: the answer to a query; `repeats`: the time in s after which it is given again, None: never.
    - `refuses`, `fails`: the word with which the order is refused, or given up; None: it is not.
    - `does`: True if the order truly has its effect; `lasts`: the further time that it takes, s.
    """

    axes: int | None = DEVICE
    channels = frozenset({Channel.ORDER, Channel.STOP, Channel.BEAT})
    homes = False

    def __init__(self, kind: DeviceKind) -> None:
        self.kind = kind
        self.facts: dict[str, Value] = {name: type.first for name, type in kind.facts.items()}
        self.answer: Callable[[VerbGoal], Value] = self.first_answer
        self.repeats: Callable[[VerbGoal], float | None] = _never
        self.refuses: Callable[[VerbGoal], str | None] = _never
        self.fails: Callable[[VerbGoal], str | None] = _never
        self.does: Callable[[VerbGoal], bool] = _always
        self.lasts: Callable[[VerbGoal], float] = _as_long_as_it_should
        self.ends: list[End] = []
        self._deeds: list[RunningOrder] = []
        self.next_change_us: int | None = None

    def reset(self) -> None:
        self._deeds, self.ends, self.next_change_us = [], [], None
        if self.kind.held_fact is not None:
            self.facts[self.kind.held_fact] = False

    def forget_settings(self) -> None:
        """Set switches back to their first values; what was moved stays as it is."""
        switches = (verb for verb in self.kind.verbs.values() if verb.effect is Effect.SWITCH)
        for name in {name for verb in switches for name, _ in verb.sets}:
            self.facts[name] = self.kind.facts[name].first

    def catch_up(self, now_us: int) -> None:
        """End orders that are late."""
        self._deeds = [replace(deed, ends_us=now_us + 1) if deed.is_late else deed for deed in self._deeds]
        self._plan()

    def set_by_hand(self, facts: Facts) -> None:
        if not self._deeds:
            self.facts.update(facts)

    def take_out(self) -> None:
        if self.kind.held_fact is not None:
            self.set_by_hand(((self.kind.held_fact, False),))

    def place(self, seen: body.SeenState, *, holds: bool) -> None:
        self.facts.update(seen.facts or ())

    @property
    def true_place(self) -> None:
        """None: a machine has no place."""

    @property
    def true_facts(self) -> dict[str, Value]:
        return self.facts

    @property
    def moving(self) -> bool:
        return any(deed.is_work for deed in self._deeds)

    @property
    def finishes(self) -> bool:
        return any(deed.is_work and deed.verb.on_stop is OnStop.FINISH for deed in self._deeds)

    def first_answer(self, goal: VerbGoal) -> Value:
        """The answer to a query that the kind gives for a virtual device."""
        command = self.command(goal)
        assert command is not None
        return self.kind.answer_of(command, tuple(self.facts.items()))

    def objection(self, goal: VerbGoal, *, latched: bool, faulted: bool) -> str | None:
        """The word that refuses an order now; None if it can be carried out."""
        command = self.command(goal)
        if command is None:
            return refusals.FORMAT
        if (word := self.refuses(goal)) is not None:
            return word
        works = command.definition.effect in WORK
        if latched and not _goes_on_while_stopped(command):
            return refusals.STOPPED
        if works and (self.moving or faulted):
            return refusals.BUSY
        met = all(self.facts[name] == value for name, value in command.needs)
        return None if met and not self._breaks_its_work(command) else refusals.CONDITION

    def _breaks_its_work(self, command: VerbCall) -> bool:
        """True if a command would change a fact that the present work needs."""
        needs = (need for deed in self._deeds if deed.is_work for need in deed.command.needs)
        sets = dict(command.sets)
        return any(sets.get(name, value) != value for name, value in needs)

    def command(self, goal: VerbGoal) -> VerbCall | None:
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
        assert isinstance(command, VerbCall)
        return command

    def is_work(self, goal: VerbGoal) -> bool:
        return self.kind.verbs[goal.verb].effect in WORK

    def start(self, now_us: int, goal: VerbGoal) -> None:
        """Begin an order that has no objection; one that takes no time takes a moment, too."""
        command = self.command(goal)
        assert command is not None
        self._supersede(command)
        late_s = self.lasts(goal)
        ends_us = now_us + max(1, round((command.takes_s + late_s) * 1e6))
        self._deeds.append(RunningOrder(goal=goal, command=command, ends_us=ends_us, is_late=late_s > 0))
        self._plan()

    def stop(self, now_us: int) -> None:
        """Halt the work; facts that it would have set stay as they were."""
        self._deeds = [deed for deed in self._deeds if not deed.is_work]
        self._plan()

    def advance(self, now_us: int) -> None:
        for deed in sorted(self._deeds, key=lambda each: each.ends_us):
            if deed.ends_us <= now_us:
                self._deeds.remove(deed)
                self._end(deed, now_us)
        self._plan()

    def take_ends(self) -> list[End]:
        taken, self.ends = self.ends, []
        return taken

    def tell(self) -> body.BodyReport:
        facts: Facts = tuple(self.facts.items())
        return body.BodyReport(facts=facts)

    def admits(self, goal: object) -> bool:
        raise NotImplementedError("a machine takes orders only")

    def home(self, now_us: int) -> None:
        raise NotImplementedError("a machine has no reference")

    def switch_effector(self, on: bool) -> None:
        raise NotImplementedError("what a machine holds is one of its facts")

    def put_at_reference(self) -> None:
        """Does nothing: it has no reference."""

    def _supersede(self, command: VerbCall) -> None:
        """Forget the query asked before, and give up the switches of facts that this one sets, too."""
        effect, sets = command.definition.effect, {name for name, _ in command.sets}
        for deed in [deed for deed in self._deeds if not deed.is_repeat]:
            is_switch = deed.verb.effect is Effect.SWITCH
            if is_switch and sets & {name for name, _ in deed.command.sets}:
                self._deeds.remove(deed)
                self.ends.append(End(deed.goal, failure=SUPERSEDED))
            elif effect is Effect.QUERY and deed.verb.effect is Effect.QUERY:
                self._deeds.remove(deed)

    def _end(self, deed: RunningOrder, now_us: int) -> None:
        word = None if deed.is_repeat else self.fails(deed.goal)
        if word is not None:
            self.ends.append(End(deed.goal, failure=word))
            return
        try:
            self._become(deed, now_us)
        except UseError:
            self.ends.append(End(deed.goal, failure=UNSHOWN))

    def _become(self, deed: RunningOrder, now_us: int) -> None:
        """Apply the end of an order to the facts; raises UseError if a function gives no valid value."""
        if deed.verb.effect is Effect.QUERY:
            self.ends.append(End(deed.goal, answer=self.answer(deed.goal)))
            self._say_again(deed, now_us)
        elif self.does(deed.goal):
            sets = dict(deed.command.sets)
            besides = self.kind.shown_by(deed.command, tuple((self.facts | sets).items()))
            self.facts.update(dict(besides) | sets)

    def _say_again(self, deed: RunningOrder, now_us: int) -> None:
        after_s = None if deed.is_repeat else self.repeats(deed.goal)
        if after_s is not None:
            self._deeds.append(replace(deed, ends_us=now_us + max(1, round(after_s * 1e6)), is_repeat=True))

    def _plan(self) -> None:
        self.next_change_us = min((deed.ends_us for deed in self._deeds), default=None)


def _goes_on_while_stopped(command: VerbCall) -> bool:
    """True for a query, and for an order that lets go of a part."""
    return command.definition.effect is Effect.QUERY or getattr(command, "grips", None) is False


def _never(goal: VerbGoal) -> None:
    """The default for refusals and the like: None for every order."""


def _always(goal: VerbGoal) -> bool:
    return True


def _as_long_as_it_should(goal: VerbGoal) -> float:
    return 0.0
