"""Files of trees in `uses` of a plant file: each is a recipe, and no node in Python has a name of theirs."""

from __future__ import annotations

from pathlib import Path

from arboleda.drivers import plain, quoted
from arboleda.extension import ConfigError
from arboleda.plant_file import user_file
from arboleda.plant_file.document import Document
from arboleda.plant_file.document import Place as PlantPlace
from arboleda.plant_file.own_recipes import LARGEST, objection_to_recipe
from arboleda.plant_file.python_uses import LONGEST, PythonUses
from arboleda.recipes.of_files import Mark, Place

from ..bt_xml import checking, reading, runnable
from ..bt_xml.findings import Findings
from ..bt_xml.nodes import OTHER_SPELLINGS, Category, built_in
from ..bt_xml.recipe import tree_recipe
from . import tree_includes

CATEGORIES = tuple(each.value for each in Category)


class TreesAsXml:
    """Trees in the XML of BehaviorTree.CPP, as a form of recipes."""

    def add(self, document: Document, place: PlantPlace, word: str, used: PythonUses) -> None:
        """Add the recipe of a file of trees; nothing in the file is executed."""
        if document.folder is None:
            document.problem(place, "this plant file lies in no folder, so no trees can lie beside it")
            return
        shown_path = str(document.folder / word)

        def fetch(file: str, path: str, package: str) -> tuple[str, bytes]:
            included, content = tree_includes.read(file, path, package)
            document.files[Path(included).absolute()] = content
            return included, content

        findings = Findings()
        try:
            content = user_file.read_bytes(Path(shown_path), LARGEST)
        except ConfigError as error:
            document.problem(place, plain(str(error), LONGEST))
            used.is_whole = False
            return
        document.files[Path(shown_path).absolute()] = content
        forest = reading.read(shown_path, content, findings, fetch)
        checked = checking.check(forest, findings, {}, others_are_checked_elsewhere=True)
        is_open = forest.main is None and len(forest.trees) > 1
        if forest.main not in forest.trees and (is_open or not findings.mistakes):
            findings.mistake(Place(shown_path, Mark(1, 1)), 'which tree? <root main_tree_to_execute="...">')
        if forest.main not in forest.trees or forest.main is None or checked.has_ring:
            document.keep_those_of(ConfigError(_lines(findings)))
            return
        forest = runnable.part_of(forest, forest.main)
        can_be_searched = runnable.check(forest, findings)
        mistakes = _lines(findings)
        document.keep_those_of(ConfigError(mistakes))
        if not can_be_searched:
            return
        used.in_trees.update(mistakes)
        recipe = tree_recipe(Path(word).stem, shown_path, content, forest, used.nodes, mistakes)
        if problem := objection_to_recipe(recipe, used):
            document.keep_those_of(ConfigError((used.spot(recipe).problem(problem),)))
        used.recipes.setdefault(recipe.name, recipe)

    def objection(self, node: str) -> str | None:
        """The reason why trees as XML cannot have a node of this name; None where they can."""
        if built_in(node) is None and node not in (*OTHER_SPELLINGS, *CATEGORIES):
            return None
        return f"the node {quoted(node)} comes with BehaviorTree.CPP; give this one another name"


def _lines(findings: Findings) -> tuple[str, ...]:
    return tuple(plain(each, LONGEST) for each in findings.mistakes)


FORM = TreesAsXml()
