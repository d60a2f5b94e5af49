"""Types of a recipe's parameters: one of some values, a number, a target or a path of the cell.

    def load(cell, dose: Choice[5, 10], force: Number[1, 40], blank=Target("pallet")): ...

A type is an annotation in brackets, a default in parentheses, or `Annotated[str, Target("pallet")]` for type
checkers, which read words in brackets as names.
"""

from __future__ import annotations

from collections.abc import Sequence

from arboleda.model.facts import Value, shown
from arboleda.model.plant_model import Cell
from arboleda.model.recipe import Limits, Parameter
from arboleda.model.sentence import Phrase

from .errors import RecipeError


class Choice:
    """One of some values: `Choice[1001, 1002]`."""

    def __init__(self, *values: Value) -> None:
        self.values = values

    def __class_getitem__(cls, values: Value | tuple[Value, ...]) -> Choice:
        return cls(*values) if isinstance(values, tuple) else cls(values)

    def parameter(self, name: str) -> Parameter:
        by_word = {shown(value): value for value in self.values}
        return Parameter(name=name, words=lambda cell: list(by_word), value=lambda cell, word: by_word[word])


class Number:
    """A number within two limits; a whole one where both are: `Number[1, 40]`, `Number[0.5, 2.0]`."""

    def __init__(self, lower: float, upper: float) -> None:
        whole = isinstance(lower, int) and isinstance(upper, int)
        self.limits = Limits(lower=lower, upper=upper, whole=whole)

    def __class_getitem__(cls, limits: tuple[float, float]) -> Number:
        if not isinstance(limits, tuple) or len(limits) != 2 or limits[0] >= limits[1]:
            raise RecipeError("a Number has two limits, the lower one first: Number[1, 40]")
        return cls(*limits)

    def parameter(self, name: str) -> Parameter:
        ends = [shown(self.limits.lower), shown(self.limits.upper)]
        read = int if self.limits.whole else float
        return Parameter(
            name=name,
            words=lambda cell: ends,
            value=lambda cell, word: read(word),
            limits=lambda cell: self.limits,
        )


class Path:
    """One of the paths of the cell, by its code; `called` is its name in sentences."""

    def __init__(self, *, called: Phrase | None = None) -> None:
        self.called = called

    def parameter(self, name: str) -> Parameter:
        return Parameter(name=name, words=lambda cell: list(cell.paths), called=self.called)


class Slot:
    """One of a group of targets, by its number in the group, from 0: `Slot("stations")`.

    `called` is its name in sentences.
    """

    def __init__(self, group: str, *, called: Phrase | None = None) -> None:
        self.group = group
        self.called = called

    def parameter(self, name: str) -> Parameter:
        return Parameter(
            name=name, words=self._numbers, value=self._target, called=self.called, group=self.group
        )

    def _numbers(self, cell: Cell) -> Sequence[str]:
        return [str(number) for number in range(len(cell.groups.get(self.group, ())))]

    def _target(self, cell: Cell, number: str) -> str:
        return cell.groups[self.group][int(number)]


class Target:
    """One of a group of targets, or the target of this name: `Target("pallet")`; `Target()` is any target."""

    def __init__(self, group: str | None = None) -> None:
        self.group = group

    def __class_getitem__(cls, group: object) -> Target:
        if group is not ... and not isinstance(group, str):
            raise RecipeError('a Target has the name of a group: Target["pallet"], or Target[...] for any')
        return cls(group if isinstance(group, str) else None)

    def parameter(self, name: str) -> Parameter:
        return Parameter(name=name, words=self._names, group=self.group)

    def _names(self, cell: Cell) -> Sequence[str]:
        if self.group is None:
            return cell.targets
        return cell.groups.get(self.group) or [each for each in cell.targets if each == self.group]


def parameter(name: str, note: object) -> Parameter | None:
    """The parameter of an annotation; None for an annotation that is no type of parameters."""
    for each in getattr(note, "__metadata__", (note,)):  # Annotated[str, Target("pallet")]
        declared = Target() if each is Target else each
        if isinstance(declared, (Choice, Number, Path, Slot, Target)):
            return declared.parameter(name)
    return None
