"""Drawn plant with cells of devices: its file as plain data, and its recipes in one of two forms."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

from .kinds import Kind
from .kinds_text import kinds_of
from .layout import Section
from .python_text import python_of
from .steps import Follow, OfGroup, Recipe, Tell, Tour, Using, walk
from .xml_text import xml_of


class Form(str, Enum):
    """Form of the recipes of a drawn plant."""

    PYTHON = "python"
    XML = "xml"


@dataclass(frozen=True, kw_only=True)
class DrawnDevices:
    """A drawn plant: `section` is its file but for `uses`, `kinds` are those in Python; None: it has none."""

    section: Section
    recipes: tuple[Recipe, ...]
    form: Form
    kinds: tuple[Kind, ...] | None = None

    @property
    def refused(self) -> frozenset[tuple[str, str]]:
        """The verbs, by role and name, that the plant has to refuse somewhere."""
        calls = (each for recipe in self.recipes for each in walk(recipe.step) if isinstance(each, Tell))
        return frozenset((each.role, each.verb) for each in calls if each.refused)

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
        return {**kinds, **{f"{each.name}.xml": xml_of(each, others) for each in self.recipes}}


def can_be_xml(recipe: Recipe) -> bool:
    """True if a tree as XML can say the recipe."""
    fixed = not any(isinstance(each, OfGroup) for each in recipe.parameters)
    return fixed and not any(isinstance(each, Using | Tour | Follow) for each in walk(recipe.step))
