"""What a recipe is: its name, its typed parameters, and what makes its tree."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from py_trees.behaviour import Behaviour

from .sentence import Phrase

if TYPE_CHECKING:
    from .context import Context
    from .model import Cell
    from .task import Order

Build = Callable[["Order", "Context"], Behaviour]
"""Makes the tree of an order in the context of its cell."""
Builders = Mapping[str, Build]
"""By the name of the recipe that they make the tree of."""


def same_word(cell: Cell, word: str) -> object:
    """What a word means that means itself."""
    return word


@dataclass(frozen=True, kw_only=True)
class Parameter:
    """One word of a task: what it is called, what it can be in a cell, and what it means there.

    `called`: its name in sentences, where they exist in several languages.
    """

    name: str
    words: Callable[[Cell], Sequence[str]]
    value: Callable[[Cell, str], object] = same_word
    called: Phrase | None = None


@dataclass(frozen=True, kw_only=True)
class Recipe:
    """Work that cells offer; a task has a word for each parameter, in their order.

    `is_default`: a task that names no recipe means this one. `alone`: the role of the one robot that works in
    it, whose name may stand for that of the cell; None where the whole cell works.
    """

    name: str
    build: Build
    parameters: tuple[Parameter, ...] = ()
    is_default: bool = False
    alone: str | None = None

    def form(self) -> str:
        """How a task of it is written."""
        cell = "<cell>" if self.alone is None else f"<{self.alone} or cell>"
        words = [*([] if self.is_default else [self.name]), *(f"<{each.name}>" for each in self.parameters)]
        return " ".join([cell, *words])
