"""Verbs of operators: a row each, their arguments as a person writes them, and outcomes of acts."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from enum import Enum

Arguments = tuple[tuple[str, int | str], ...]
"""Arguments of a verb, which it has beside its scope, by name."""
NUMBER = re.compile("0|[1-9][0-9]*")


@dataclass(frozen=True, kw_only=True)
class Argument:
    """Argument of a verb.

    A person writes it behind the scope, after its `mark`, in the form `pattern`; without a pattern it is all
    remaining words. `beside` is another argument without which it means nothing. `passing`: it is an id of
    this start of the plant, and no part of the sentence about the act. `needed`: no act does without it.
    """

    name: str
    type: type[int] | type[str]
    mark: str = ""
    pattern: str = ""
    beside: str = ""
    passing: bool = False
    needed: bool = False


class Scope(str, Enum):
    """Kind of scope that a verb can have."""

    PLANT = "plant"
    CELL = "cell"
    ROBOT = "robot"
    TASK = "task"
    ZONE = "zone"
    PERSON = "asked"


class Devices(str, Enum):
    """Robots that a verb is about: all, those that may hold a part, or those that go somewhere."""

    ALL = "all"
    HOLDERS = "holders"
    MOVERS = "movers"


class Role(str, Enum):
    """Role of the person or program that asks.

    A viewer looks and stops, an operator may do everything, an assistant looks, stops, proposes, and gives
    tasks within limits.
    """

    VIEWER = "viewer"
    OPERATOR = "operator"
    ASSISTANT = "assistant"


QUESTION = Argument(
    name="question", type=str, mark="#", pattern="[0-9]+-[0-9]+", beside="answer", passing=True
)
ANSWER = Argument(name="answer", type=str, needed=True)
STATION = Argument(name="station", type=int)
PLACE = Argument(name="place", type=str, pattern="[A-Za-z][A-Za-z0-9_]*")
PARTS = Argument(name="parts", type=int)
TEACHER = Argument(name="teacher", type=str, needed=True)
WORK = Argument(name="work", type=str, needed=True)


@dataclass(frozen=True, kw_only=True)
class VerbRow:
    """Declaration of a verb: its scopes, devices and arguments, the role that it needs, and its effects.

    `stops`: it is the stop, which leaves before all else, may be asked for twice, and is refused only for an
    unknown name. `of_all_who_share`: for a shared device it is done in all of its cells. `by_hand`: a person
    may have done it, and declares that. `moves`: robots may move; `drops`: parts may fall. `mode`: it begins
    or ends the manual mode of a cell, and views do not tell whether it would be refused.
    """

    scopes: tuple[Scope, ...]
    devices: Devices = Devices.ALL
    arguments: tuple[Argument, ...] = ()
    role: Role = Role.OPERATOR
    stops: bool = False
    of_all_who_share: bool = False
    by_hand: bool = False
    moves: bool = False
    drops: bool = False
    mode: bool = False


_NO_ROW = VerbRow(scopes=())
_EVERYWHERE = (Scope.PLANT, Scope.CELL, Scope.ROBOT)
_CELLS = (Scope.PLANT, Scope.CELL)
_ONE_CELL = (Scope.CELL,)
_DEVICES = (Scope.CELL, Scope.ROBOT)


class Verb(str, Enum):
    """Verb of operators, the same word on every screen, with its row."""

    STOP = "stop", VerbRow(scopes=_EVERYWHERE, role=Role.VIEWER, stops=True, of_all_who_share=True)
    CLEAR = "clear", VerbRow(scopes=_EVERYWHERE, of_all_who_share=True)
    RESET = "reset", VerbRow(scopes=_CELLS, of_all_who_share=True)
    HOLD = "hold", VerbRow(scopes=_CELLS)
    RESUME = "resume", VerbRow(scopes=_CELLS, moves=True)
    CANCEL = "cancel", VerbRow(scopes=(Scope.CELL, Scope.TASK), moves=True)
    RETRY = "retry", VerbRow(scopes=_ONE_CELL, moves=True)
    ABANDON = "abandon", VerbRow(scopes=_ONE_CELL, moves=True)
    RELEASE = "release", VerbRow(scopes=_DEVICES, devices=Devices.HOLDERS, by_hand=True, drops=True)
    HOME = "home", VerbRow(scopes=_DEVICES, devices=Devices.MOVERS, by_hand=True, moves=True)
    DO = "do", VerbRow(scopes=(Scope.ROBOT,), arguments=(WORK,), moves=True)
    OVERRIDE = "override", VerbRow(scopes=(Scope.ZONE,))
    UNLOAD = "unload", VerbRow(scopes=_CELLS, arguments=(PLACE, STATION))
    LOAD = "load", VerbRow(scopes=_ONE_CELL, arguments=(replace(PLACE, needed=True), PARTS))
    ANSWER = "answer", VerbRow(scopes=(Scope.PERSON,), arguments=(QUESTION, ANSWER))
    TEACH = "teach", VerbRow(scopes=_ONE_CELL, arguments=(TEACHER,), mode=True)
    AUTOMATIC = "automatic", VerbRow(scopes=_ONE_CELL, mode=True)

    _value_: str
    row: VerbRow

    def __new__(cls, word: str, row: VerbRow = _NO_ROW) -> Verb:
        """Make the verb of a word, with its row; `Verb("stop")` finds it."""
        verb = str.__new__(cls, word)
        verb._value_ = word
        verb.row = row
        return verb

    @property
    def arguments(self) -> tuple[Argument, ...]:
        """Its arguments, in the order of a person's words."""
        return self.row.arguments

    @property
    def needs_arguments(self) -> bool:
        """True where it needs more than a scope."""
        return any(argument.needed for argument in self.row.arguments)


class Outcome(str, Enum):
    """Outcome of an operator's act."""

    SENT = "sent"  # a stop: reports show whether robots stand
    UNDER_WAY = "under_way"  # devices carry it out
    DONE = "done"
    UNCHECKED = "unchecked"  # devices were told to do it, and report nothing of it
    FAILED = "failed"


def refusable(scope: Scope) -> tuple[Verb, ...]:
    """The verbs that can be refused for a scope of this kind, whatever their arguments."""
    alone = (verb for verb in Verb if not verb.needs_arguments and not verb.row.mode)
    return tuple(verb for verb in alone if scope in verb.row.scopes and not verb.row.stops)


def as_text(verb: Verb, scope: str, arguments: Arguments) -> str:
    """The scope and the arguments as a person writes them behind the verb.

    >>> as_text(Verb.ANSWER, "ana", (("question", "7-1"), ("answer", "yes")))
    'ana #7-1 yes'
    """
    values = dict(arguments)
    words = [f"{each.mark}{values[each.name]}" for each in verb.arguments if each.name in values]
    return " ".join([scope, *words]) if words else scope


def from_text(verb: Verb, text: str) -> tuple[str, Arguments]:
    """The scope and the arguments in what a person writes behind the verb.

    >>> from_text(Verb.UNLOAD, "sis_a 7")
    ('sis_a', (('station', 7),))
    """
    if not verb.arguments:
        return text, ()
    scope, _, remaining = text.strip().partition(" ")
    arguments = []
    for argument in verb.arguments:
        word, after = _first(argument, remaining.strip())
        if word:
            arguments.append((argument.name, _value(argument, word)))
        remaining = after
    return scope, tuple(arguments)


def _first(argument: Argument, words: str) -> tuple[str, str]:
    """The words of this argument, and the remaining ones: one word in its form, or all words."""
    if not argument.pattern:
        return words, ""
    first, _, remaining = words.partition(" ")
    is_it = re.fullmatch(re.escape(argument.mark) + argument.pattern, first)
    return (first.removeprefix(argument.mark), remaining) if is_it else ("", words)


def _value(argument: Argument, word: str) -> int | str:
    """The word in the argument's type; a word that is no number stays a word, which the plant refuses."""
    return int(word) if argument.type is int and NUMBER.fullmatch(word) else word


def lasting(verb: Verb, arguments: Arguments) -> Arguments:
    """The arguments that mean the same in every start of the plant."""
    passing = {each.name for each in verb.arguments if each.passing}
    return tuple((name, value) for name, value in arguments if name not in passing)
