"""Errors of trees that cannot be recipes, each with its place in the file."""

from __future__ import annotations

from collections.abc import Sequence

from arboleda.bt_xml.findings import Place
from arboleda.recipes.errors import RecipeError, RoleError


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
