"""Recipe: a name, typed parameters, and the function that makes its tree."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any
from unicodedata import normalize

from py_trees.behaviour import Behaviour

from .facts import Value, shown
from .sentence import Phrase, Sentence
from .task import Order

Build = Callable[[Order, Any], Behaviour]
"""Makes the tree of an order, in the `Context` of its cell (`trees/context.py`)."""
Builders = Mapping[str, Build]
"""Builders by the names of their recipes."""
End = tuple[tuple[str, Value], ...]
"""Facts after a done task: a place, a fact or a question to a device, each with its value."""
CELL = Phrase("text.cell", "cell")
VALUE_FORM = Phrase("text.value_form", "<{name}>")
ALONE_FORM = Phrase("text.alone_form", "<{robot} or cell>")
NEXT_WORD = Phrase("text.next_word", "{before} {then}")
FOR_PEOPLE = "for_people"
"""Key in the metadata of a field that only says where something was read, as a path."""
Cell = Any
"""The `Cell` of `plant_model`, which imports this module, as a cell has recipes."""


def matching(word: str, names: Iterable[str]) -> str | None:
    """The name that `word` spells, in any language; None where it spells none.

    Letters outside ASCII spell no ASCII name: some have an ASCII letter as their other case.
    """
    wanted = spelling(word)
    alike = (name for name in names if spelling(name) == wanted)
    return next((name for name in alike if word.isascii() or not name.isascii()), None)


def spelling(word: str) -> str:
    """The letters of a word, for which neither case nor the way in which Unicode writes an accent counts."""
    return normalize("NFC", normalize("NFC", word).casefold())


def in_common(ends: Sequence[Mapping[str, Value]]) -> dict[str, Value]:
    """The values that all these ends have, of which there is at least one."""
    first, *others = ends
    return {what: value for what, value in first.items() if all(each.get(what) == value for each in others)}


def nearest(
    ends: Sequence[Mapping[str, Value]], differs: Callable[[str, Value], bool]
) -> Mapping[str, Value]:
    """The end of these that is meant; what stands first in one decides, as the answer to a question."""
    return min(ends, key=lambda end: [differs(*each) for each in end.items()])


def same_word(cell: Cell, word: str) -> object:
    """The meaning of a word that stands for itself."""
    return word


def no_limits(cell: Cell) -> None:
    """The limits of a parameter that is no number: none."""


@dataclass(frozen=True, kw_only=True)
class Limits:
    """Limits of a number, both ends included."""

    lower: float
    upper: float
    whole: bool = False

    def reads(self, word: str) -> str | None:
        """The number that a word spells, as `shown` writes it; None for no number, and for one outside."""
        try:
            number = int(word) if self.whole else float(word)
        except ValueError:
            return None
        return shown(number) if self.lower <= number <= self.upper else None


@dataclass(frozen=True, kw_only=True)
class Parameter:
    """One word of a task: what it is called, what it can be in a cell, and what it means there.

    `words`: all that it can be; of a number, whose `limits` in a cell say that, only examples. `called`: its
    name in sentences, where they exist in several languages. `group`: the group of targets that it names one
    of, or the one target.
    """

    name: str
    words: Callable[[Cell], Sequence[str]]
    value: Callable[[Cell, str], object] = same_word
    called: Phrase | None = None
    limits: Callable[[Cell], Limits | None] = no_limits
    group: str | None = None

    def reads(self, cell: Cell, word: str) -> str | None:
        """The word as the cell has it, whatever its case; None where it is none of this parameter's."""
        limits = self.limits(cell)
        return limits.reads(word) if limits else matching(word, self.words(cell))


@dataclass(frozen=True, kw_only=True)
class Recipe:
    """Work that cells can do; a task has a word for each parameter, in their order.

    `about`: what it does, in a line. `is_default`: a task that names no recipe means this one. `alone`: the
    role of the one robot that works in it, whose name may stand for that of the cell; None where the whole
    cell works. `alone_called`: that role in sentences, where they exist in several languages. `part_from`:
    the group of targets at whose first one the part of a task waits; None where a robot brings it.
    `ends_with`: what is so once a task is done: the number of parts at a place, which a parameter may name,
    or the value of a fact, as ("reader.lid", "open"). It may also be what a device answered last in this
    task, as ("camera.look", "bad"). Of several such ends one is so. `source`: the hash of all files that it
    was written in, by which a task that is kept finds the recipe changed; "" where nobody knows them.
    """

    name: str
    build: Build
    parameters: tuple[Parameter, ...] = ()
    about: str = ""
    is_default: bool = False
    alone: str | None = None
    alone_called: Phrase | None = None
    part_from: str | None = None
    ends_with: tuple[End, ...] = ()
    source: str = field(default="", compare=False)

    @property
    def is_shipped(self) -> bool:
        """True for a recipe that comes with Arboleda."""
        return False

    def end_of(self, values: Mapping[str, object]) -> dict[str, Value]:
        """The state once a task with these values is done, whichever way it goes, by place or "role.fact"."""
        return in_common(self.ends_of(values))

    def ends_of(self, values: Mapping[str, object]) -> tuple[dict[str, Value], ...]:
        """The states of which one is so once a task with these values is done; at least one."""
        ends = self.ends_with or ((),)
        return tuple({str(values.get(what, what)): value for what, value in end} for end in ends)

    @property
    def goes_unnamed(self) -> bool:
        """True where tasks are written without its name; without values the name alone says what is done."""
        return self.is_default and bool(self.parameters)

    def form(self) -> Sentence:
        """The form in which a task of it is written."""
        form = VALUE_FORM(name=CELL())
        if self.alone is not None:
            form = ALONE_FORM(robot=self.alone_called() if self.alone_called else self.alone)
        if not self.goes_unnamed:
            form = NEXT_WORD(before=form, then=self.name)
        for each in self.parameters:
            name = each.called() if each.called else each.name
            form = NEXT_WORD(before=form, then=VALUE_FORM(name=name))
        return form
