"""Forms of recipes beside Python: what reads a file of `uses`, by the suffix of its name.

A package registers an object that keeps to `RecipeForm` under the entry point group `arboleda.recipes`, with
the suffix as its name, without the dot. It is loaded when a plant file uses a file of that suffix.
"""

from __future__ import annotations

from pathlib import Path, PurePath
from typing import Protocol

from arboleda.host.packages import entry_points, why_left_out
from arboleda.model.errors import ConfigError
from arboleda.model.outside import quoted
from arboleda.model.packages import MISSING, TREES
from arboleda.model.sentence import OWN

from .document import Document, Place
from .python_uses import PythonUses, error_text

GROUP = "arboleda.recipes"
XML = ".xml"  # behavior trees in the XML of BehaviorTree.CPP
PROJECT = ".btproj"  # of Groot2: a file of trees that mostly includes others
PACKAGES = {XML: TREES}  # which one brings a suffix, where it is not installed
BROKEN = "what reads files that end in {suffix} cannot be loaded: {why}"


class RecipeForm(Protocol):
    """Form of recipes, as files of one suffix have it."""

    def add(self, document: Document, place: Place, word: str, used: PythonUses) -> None:
        """Add the recipe of a file to what is used; nothing in it is executed, and its problems are kept."""

    def objection(self, node: str) -> str | None:
        """The reason why a node in Python cannot have this name in such a file; None where it can."""


def is_tree_file(path: Path) -> bool:
    """True if the name of a file is that of a file of trees."""
    return path.suffix.lower() in (XML, PROJECT)


def has_form(word: str) -> bool:
    """True for the name of a file of such a form, be it installed or not."""
    suffix = PurePath(word).suffix
    return suffix in PACKAGES or any(f".{each.name}" == suffix for each in entry_points(GROUP))


def form_of(word: str) -> RecipeForm:
    """The form of a file; ConfigError where what reads it is not installed, or broken."""
    suffix = PurePath(word).suffix
    for each in entry_points(GROUP):
        if f".{each.name}" == suffix:
            try:
                form: RecipeForm = each.load()
            except (Exception, SystemExit) as error:
                why = BROKEN.format(suffix=suffix, why=error_text(error))
                raise ConfigError((why,)) from error
            return form
    why = why_left_out(GROUP, suffix.removeprefix("."))
    raise ConfigError((why or str(MISSING(what=OWN(text=quoted(word)), package=PACKAGES[suffix])),))
