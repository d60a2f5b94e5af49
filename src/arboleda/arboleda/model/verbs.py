"""Operators' verbs: a row each, how a person writes what each is told beside its scope, what comes of it."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from enum import Enum

Arguments = tuple[tuple[str, int | str], ...]
"""What a verb is told beside its scope, by name."""
NUMBER = re.compile("0|[1-9][0-9]*")


@dataclass(frozen=True, kw_only=True)
class Argument:
    """One thing that a verb is told beside its scope.

    Among the words of a person it stands behind the scope, after its `mark`, in the form `pattern`; without
    one it is all the words that are left. `beside`:
    it means nothing without that other one. `passing`: it is the id of something that only this start of the
    plant knows, and no part of what is told of the act. `needed`: there is no act without it.
    """

    name: str
    type: type[int] | type[str]
    mark: str = ""
    pattern: str = ""
    beside: str = ""
    passing: bool = False
    needed: bool = False


class Scope(str, Enum):
    """Kinds of what a verb is for."""

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
    """Role of whoever asks: a viewer looks and stops, an operator may do everything, an assistant proposes
    besides, and gives tasks within limits."""

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


@dataclass(frozen=True, kw_only=True)
class Row:
    """Declaration of a verb: for what it is, what it is told, who may ask for it, what it can do.

    `stops`: it is the stop, which leaves before all else, may be asked for twice and is refused for no known
    name. `of_all_who_share`: for a device that cells share it is a matter of all of them. `by_hand`: a person
    may have done it, and only declares that. `moves`: it may set robots in motion; `drops`: parts may fall.
    `mode`: it begins or ends the manual mode of a cell; whether it would be refused is no part of every view.
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


_NO_ROW = Row(scopes=())
_EVERYWHERE = (Scope.PLANT, Scope.CELL, Scope.ROBOT)
_CELLS = (Scope.PLANT, Scope.CELL)
_ONE_CELL = (Scope.CELL,)
_DEVICES = (Scope.CELL, Scope.ROBOT)


class Verb(str, Enum):
    """Verb of operators: the same words on every screen, each with its row."""

    STOP = "stop", Row(scopes=_EVERYWHERE, role=Role.VIEWER, stops=True, of_all_who_share=True)
    CLEAR = "clear", Row(scopes=_EVERYWHERE, of_all_who_share=True)
    RESET = "reset", Row(scopes=_CELLS, of_all_who_share=True)
    HOLD = "hold", Row(scopes=_CELLS)
    RESUME = "resume", Row(scopes=_CELLS, moves=True)
    CANCEL = "cancel", Row(scopes=(Scope.CELL, Scope.TASK), moves=True)
    RETRY = "retry", Row(scopes=_ONE_CELL, moves=True)
    ABANDON = "abandon", Row(scopes=_ONE_CELL, moves=True)
    RELEASE = "release", Row(scopes=_DEVICES, devices=Devices.HOLDERS, by_hand=True, drops=True)
    HOME = "home", Row(scopes=_DEVICES, devices=Devices.MOVERS, by_hand=True, moves=True)
    OVERRIDE = "override", Row(scopes=(Scope.ZONE,))
    UNLOAD = "unload", Row(scopes=_CELLS, arguments=(PLACE, STATION))
    LOAD = "load", Row(scopes=_ONE_CELL, arguments=(replace(PLACE, needed=True), PARTS))
    ANSWER = "answer", Row(scopes=(Scope.PERSON,), arguments=(QUESTION, ANSWER))
    TEACH = "teach", Row(scopes=_ONE_CELL, arguments=(TEACHER,), mode=True)
    AUTOMATIC = "automatic", Row(scopes=_ONE_CELL, mode=True)

    _value_: str
    row: Row

    def __new__(cls, word: str, row: Row = _NO_ROW) -> Verb:
        """The verb of a word, with its row; `Verb("stop")` finds the one that there is."""
        verb = str.__new__(cls, word)
        verb._value_ = word
        verb.row = row
        return verb

    @property
    def arguments(self) -> tuple[Argument, ...]:
        """Its arguments beside the scope, in the order of a person's words."""
        return self.row.arguments

    @property
    def needs_arguments(self) -> bool:
        """True where it means nothing with a scope alone."""
        return any(argument.needed for argument in self.row.arguments)


class Outcome(str, Enum):
    """Outcome of an operator's act."""

    SENT = "sent"  # a stop: whether robots stand shows in what they report
    UNDER_WAY = "under_way"  # devices were told to do it, and have not ended
    DONE = "done"
    UNCHECKED = "unchecked"  # devices were told, and report nothing of it
    FAILED = "failed"


def refusable(scope: Scope) -> tuple[Verb, ...]:
    """The verbs for which a scope of this kind can be a wrong moment, whatever they are told beside it."""
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
    scope, _, rest = text.strip().partition(" ")
    found = []
    for argument in verb.arguments:
        word, after = _first(argument, rest.strip())
        if word:
            found.append((argument.name, _value(argument, word)))
        rest = after
    return scope, tuple(found)


def _first(argument: Argument, words: str) -> tuple[str, str]:
    """The words of this argument, and the rest: one word in its form, or all of them."""
    if not argument.pattern:
        return words, ""
    first, _, rest = words.partition(" ")
    is_it = re.fullmatch(re.escape(argument.mark) + argument.pattern, first)
    return (first.removeprefix(argument.mark), rest) if is_it else ("", words)


def _value(argument: Argument, word: str) -> int | str:
    """The word as its type; one that is no number stays a word, which the plant refuses by name."""
    return int(word) if argument.type is int and NUMBER.fullmatch(word) else word


def lasting(verb: Verb, arguments: Arguments) -> Arguments:
    """Those arguments that mean the same in every start of the plant."""
    passing = {each.name for each in verb.arguments if each.passing}
    return tuple((name, value) for name, value in arguments if name not in passing)
