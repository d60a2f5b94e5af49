"""Why a tree of a file is no recipe, with the place in the file."""

from __future__ import annotations

from collections.abc import Sequence

from arboleda.bt_xml.findings import Place
from arboleda.recipes.errors import RecipeError, RoleError


class TreeError(RecipeError):
    """A node that cannot be run as it is written."""

    def __init__(self, sentence: str, place: Place) -> None:
        super().__init__(sentence)
        self.place = place


class NoDeviceError(RoleError):
    """A node that no device of a cell makes."""

    def __init__(self, sentence: str, place: Place) -> None:
        super().__init__(sentence)
        self.place = place


class TreeMistakes(RecipeError):
    """All that is wrong with a tree in a cell: lines, each with its place."""

    def __init__(self, lines: Sequence[str]) -> None:
        super().__init__("; ".join(lines))
        self.lines = tuple(lines)
