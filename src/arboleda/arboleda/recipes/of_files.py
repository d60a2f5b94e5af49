"""Recipes that are files of another form than Python: what they and their nodes say of themselves.

A package brings each form, by the suffix of its files; who tries, checks or judges a plant knows none.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from types import MappingProxyType
from typing import ClassVar, Protocol

from py_trees.behaviour import Behaviour

from arboleda.kinds.ranges import Range
from arboleda.model.plant_model import Cell
from arboleda.model.recipe import FOR_PEOPLE, Recipe
from arboleda.model.sentence import Phrase

from .errors import RecipeError, RoleError
from .nodes import WrittenNode

ROUNDS, FAILURE = "rounds", "FAILURE"  # a count of nodes, and the name of a result
FAILS = Phrase("step.always_failure", "{leaf}")  # a step that does nothing but fail
FAILED = Phrase("xml.failed", "the tree {tree} has failed")
FAILED_AT = Phrase("xml.failed_at", "the tree {tree} has failed: {leaf}")


@dataclass(frozen=True, order=True)
class Mark:
    """Place in a file; lines and columns count from 1, columns in characters."""

    line: int
    column: int


@dataclass(frozen=True, order=True)
class Place:
    """Place in one of several files; `file` is its name for people."""

    file: str = field(metadata={FOR_PEOPLE: True})
    mark: Mark

    def __str__(self) -> str:
        return f"{self.file}:{self.mark.line}:{self.mark.column}"


@dataclass(frozen=True, kw_only=True)
class FileRecipe(Recipe):
    """Recipe of a file; `file` is its name for people, `place` that of its main tree.

    `own` are the nodes in Python that the recipe may use. `groups` has by parameter the group of targets that
    its values come from, `handed_on` are the parameters that a node in the tree is given. `check` raises
    NoDeviceError or TreeMistakes with all that is wrong in a cell, whichever values its parameters have.
    `compared` has the numbers with which its tree compares answers, as far as they are known in advance.
    """

    file: str
    place: Place
    content: bytes = field(compare=False)
    groups: Mapping[str, str] = field(compare=False)
    handed_on: frozenset[str] = field(compare=False)
    own: Mapping[str, WrittenNode] = field(compare=False)
    check: Callable[[Cell], None] = field(compare=False)
    compared: Callable[[Behaviour], Iterable[Range]] = field(compare=False)


class Variables(Protocol):
    """Variables of a part of a tree."""

    values: dict[str, float | int | str]


class Ports(Protocol):
    """Ports of a node: their texts in the file, by name."""

    @property
    def texts(self) -> Mapping[str, str]: ...


class FileNode(Behaviour):
    """Base of the nodes of such recipes, with what each class of them says of itself.

    `counts` are the attributes with the node's progress. With `rounds` among them, the text of `port` says
    how many there are, and `goes_on` after which result of the step inside. `facts` are those that it asks
    for, each with its device. `writes` are the variables that it may set or remove. `is_limit`: it ends the
    steps inside after some time, or by a condition.
    """

    counts: ClassVar[tuple[str, ...]] = ()
    is_limit: ClassVar[bool] = False
    facts: Mapping[str, tuple[str, str]] = MappingProxyType({})
    rounds: int
    ports: Ports
    port: str
    goes_on: Enum
    place: Place | None
    scope: Variables
    writes: tuple[tuple[Variables, str], ...]


class TreeError(RecipeError):
    """Error: a node cannot be run as it is written."""

    def __init__(self, sentence: str, place: Place) -> None:
        super().__init__(sentence)
        self.place = place


class NoDeviceError(RoleError):
    """Error: no device of the cell makes a node; `others` are the errors of other such nodes of the tree.

    `mistakes` are all other faults of the tree: lines, each with its place.
    """

    def __init__(
        self,
        sentence: str,
        place: Place,
        others: Sequence[NoDeviceError] = (),
        mistakes: Sequence[str] = (),
    ) -> None:
        super().__init__(sentence)
        self.place = place
        self.others = tuple(others)
        self.mistakes = tuple(mistakes)


class TreeMistakes(RecipeError):
    """Error with all faults of a tree in a cell: lines, each with its place."""

    def __init__(self, lines: Sequence[str]) -> None:
        super().__init__("; ".join(lines))
        self.lines = tuple(lines)
