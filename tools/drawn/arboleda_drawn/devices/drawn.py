"""Drawn plant with cells of devices: its file as plain data, and its recipes in one of two forms."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

from arboleda_proofs.simulator.chance import Dice

from .kinds import Kind
from .kinds_text import kinds_of
from .layout import Section
from .python_text import python_of
from .steps import Fail, Follow, OfGroup, Recipe, Recover, Retry, Tell, Tour, Using, walk
from .xml_spellings import SpellingWriter
from .xml_text import Writer, xml_of


class Form(str, Enum):
    """Form of the recipes of a drawn plant."""

    PYTHON = "python"
    XML = "xml"


@dataclass(frozen=True, kw_only=True)
class DrawnDevices:
    """A drawn plant: `section` is its file but for `uses`, `kinds` are those in Python; None: it has none.

    `spelling`: the seed of the ways in which its recipes are written as XML; None: in the plainest ways.
    """

    section: Section
    recipes: tuple[Recipe, ...]
    form: Form
    kinds: tuple[Kind, ...] | None = None
    spelling: int | None = None

    @property
    def refused(self) -> frozenset[tuple[str, str]]:
        """The verbs, by role and name, that the plant has to refuse somewhere."""
        calls = (each for recipe in self.recipes for each in walk(recipe.step) if isinstance(each, Tell))
        return frozenset((each.role, each.verb) for each in calls if each.refused)

    @property
    def failing_rescues(self) -> tuple[str, ...]:
        """The words of the rescues that fail on purpose."""
        steps = (each for recipe in self.recipes for each in walk(recipe.step))
        inner = (step for each in steps if isinstance(each, Recover) for step in walk(each.rescue))
        return tuple({each.sentence: None for each in inner if isinstance(each, Fail)})

    @property
    def file(self) -> Section:
        """The plant file."""
        name = {"name": self.section["name"]}
        return {**name, "uses": list(self.beside), **{k: v for k, v in self.section.items() if k != "name"}}

    @property
    def beside(self) -> Mapping[str, str]:
        """The files beside it by name, as text."""
        kinds = {} if self.kinds is None else {"kinds.py": kinds_of(self.kinds)}
        if self.form is Form.PYTHON:
            return {**kinds, "recipes.py": python_of(self.recipes)}
        others = {each.name: each for each in self.recipes}
        return {
            **kinds,
            **{f"{each.name}.xml": xml_of(each, others, self._writer(each)) for each in self.recipes},
        }

    def _writer(self, recipe: Recipe) -> Writer:
        if self.spelling is None:
            return Writer()
        return SpellingWriter(Dice(self.spelling, "spelling", recipe.name), recipe)


def can_be_xml(recipe: Recipe) -> bool:
    """True if a tree as XML can say the recipe."""
    fixed = not any(isinstance(each, OfGroup) for each in recipe.parameters)
    steps = list(walk(recipe.step))
    by_cause = any(isinstance(each, Retry) and each.causes for each in steps)
    return fixed and not by_cause and not any(isinstance(each, Using | Tour | Follow) for each in steps)
