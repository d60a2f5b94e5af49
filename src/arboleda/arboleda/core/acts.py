"""The last acts of operators with their outcomes, and the last faults that people provoked."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import reduce

from arboleda.dispatch.booking import was_broken_off
from arboleda.dispatch.ledger import Entry, State
from arboleda.model.messages import Outcome, Verb
from arboleda.model.sentence import BOTH, Phrase, Sentence
from arboleda.model.verbs import Arguments

HALTED = Phrase("act.halted", "{robot} was halted while {doing}")
UNCHECKED = Phrase("act.unchecked", "{robot} was told, and does not report whether it did it")
ENDED = {
    Outcome.DONE: Phrase("act.done", "{did}: done"),
    Outcome.UNCHECKED: Phrase("act.not_checked", "{did}: not checked ({why})"),
    Outcome.FAILED: Phrase("act.failed", "{did}: failed ({why})"),
}
SHOWN = 20  # as many as a screen shows; the journal has all


@dataclass(frozen=True, kw_only=True)
class OperatorAct:
    """Act of an operator, at `at` s of the plant's clock, with its outcome so far.

    `ended_at` is when its commands ended, or when it failed at once; None where it was done at once.
    """

    number: int
    at: float
    verb: Verb
    scope: str
    arguments: Arguments = ()
    cell: str | None  # None for the whole plant and for a zone, which several cells may share
    sentence: Sentence
    outcome: Outcome
    why: Sentence | None = None
    ended_at: float | None = None

    @property
    def ended(self) -> Sentence:
        """Its end in words."""
        why = {} if self.why is None else {"why": self.why}
        return ENDED[self.outcome](did=self.sentence, **why)


class FailedVerbs(set[tuple[Verb, str]]):
    """Verbs and their scopes that have failed since the cell worked; these are advised last."""

    def learn(self, verb: Verb, entry: Entry) -> None:
        """Note whether a device could do what the verb told it."""
        if entry.state is State.DONE:
            self.discard((verb, entry.command.robot))
        elif not was_broken_off(entry):
            self.add((verb, entry.command.robot))


class Acts:
    """The last acts, oldest first; acts that devices carry out are looked at until they have ended."""

    def __init__(self) -> None:
        self.last: deque[OperatorAct] = deque(maxlen=SHOWN)
        self._count = 0
        self.under_way: dict[int, tuple[OperatorAct, Sequence[Entry]]] = {}

    @property
    def next_number(self) -> int:
        return self._count + 1

    def add(self, act: OperatorAct, entries: Sequence[Entry]) -> None:
        """Take in an act, for which these commands have left."""
        self._count = act.number
        self.last.append(act)
        if act.outcome is Outcome.UNDER_WAY:
            self.under_way[act.number] = (act, entries)

    def ended(self, now: float) -> Iterator[tuple[OperatorAct, Sequence[Entry]]]:
        """Each act that has come to its end since the last look, with its commands."""
        for number, (act, entries) in list(self.under_way.items()):
            outcome, why = outcome_of(entries)
            if outcome is Outcome.UNDER_WAY:
                continue
            del self.under_way[number]
            over = replace(act, outcome=outcome, why=why, ended_at=now)
            for place, each in enumerate(self.last):
                if each.number == number:
                    self.last[place] = over
            yield over, entries


@dataclass(frozen=True, kw_only=True)
class NumberedFault:
    """Fault of a virtual device that began or ended `at` s of the plant's clock; `number` grows with each.

    `robot` is "" where the clock of the plant's machine was set.
    """

    number: int
    at: float
    robot: str
    sentence: Sentence


class ProvokedFaults:
    """The last faults that people provoked, oldest first."""

    def __init__(self) -> None:
        self.last: deque[NumberedFault] = deque(maxlen=SHOWN)
        self._count = 0

    def note(self, at: float, robot: str, sentence: Sentence) -> None:
        """Take in a fault."""
        self._count += 1
        self.last.append(NumberedFault(number=self._count, at=at, robot=robot, sentence=sentence))


def outcome_of(entries: Sequence[Entry]) -> tuple[Outcome, Sentence | None]:
    """The outcome of the commands of an act."""
    if any(entry.open for entry in entries):
        return Outcome.UNDER_WAY, None
    if failures := [_failure(entry) for entry in entries if entry.state is not State.DONE]:
        return Outcome.FAILED, _joined(failures)
    if unproven := [UNCHECKED(robot=entry.command.robot) for entry in entries if entry.settled]:
        return Outcome.UNCHECKED, _joined(unproven)
    return Outcome.DONE, None


def _failure(entry: Entry) -> Sentence:
    if entry.failure is not None:
        return entry.failure.sentence
    return HALTED(robot=entry.command.robot, doing=entry.doing)


def _joined(sentences: Sequence[Sentence]) -> Sentence:
    return reduce(lambda first, second: BOTH(first=first, second=second), sentences)
