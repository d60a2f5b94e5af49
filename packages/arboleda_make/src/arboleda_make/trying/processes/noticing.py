"""Checks that would notice what nobody notices: each is put into the drawn tree, and tried with that fault.

A check is proposed where the task is still done without the fault, and no longer called done with it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import islice
from typing import Any

from arboleda.drivers import Value, shown
from arboleda.extension import ArboledaError
from arboleda.model import text
from arboleda.model.plant_model import PlantModel
from arboleda.recipes.of_files import FileRecipe
from arboleda_make.editing import desk
from arboleda_make.editing.operations import Insert, NewNode, Operation, Wrap
from arboleda_proofs.campaigns.proof.calm import calm_run
from arboleda_proofs.campaigns.proof.changed_recipe import WITHIN_S, noticed_with, outcome_with
from arboleda_proofs.campaigns.proof.outcome import plain
from arboleda_proofs.campaigns.proof.scenario import Scenario
from arboleda_proofs.simulator.faults import Fault
from arboleda_trees.bt_xml import reading
from arboleda_trees.bt_xml.findings import Findings
from arboleda_trees.bt_xml.recipe import tree_recipe

from .process import errand, say, write
from .tryout import RESULT

MOST_TRIED = 120  # checks
NOT_DRAWN = "{recipe} is written in Python; only drawn trees are changed here"
NOT_UNNOTICED = "this fault is noticed by now: the task ends {end}"

Row = dict[str, Any]


@dataclass(frozen=True, kw_only=True)
class Check:
    """Check: the device in a role says so of a fact, right after the node `path` of a tree."""

    role: str
    fact: str
    value: Value
    tree: str
    path: str


def main() -> None:
    """Run the errand of this process."""
    with errand() as given:
        model, _ = given.plant()
        write(given.folder / RESULT, noticed(model, given.wanted))


def noticed(model: PlantModel, wanted: Mapping[str, Any]) -> Row:
    """The check that notices `wanted["faults"]` in a task, as a new text of its file; none where none does.

    ArboledaError where the recipe is not drawn, or the fault is noticed already.
    """
    order = text.parse(wanted["task"], model)
    recipe = model.cell(order.cell).recipe(order.recipe)
    if not isinstance(recipe, FileRecipe):
        raise ArboledaError(NOT_DRAWN.format(recipe=order.recipe))
    answers = tuple(sorted(dict(wanted.get("answers", {})).items()))
    scenario = Scenario(cell=order.cell, recipe=order.recipe, task=wanted["task"], answers=answers)
    faults = [Fault(**each) for each in wanted["faults"]]
    calm = calm_run(model, scenario)
    before = outcome_with(model, scenario, calm, faults)
    if not before.goes_unnoticed:
        raise ArboledaError(NOT_UNNOTICED.format(end=before.words))
    tried = 0
    for check in islice(checks(model, recipe, order.cell), MOST_TRIED):
        say(doing="checks", sentence=f"{check.role}.{check.fact}", done=tried, total=MOST_TRIED)
        tried += 1
        if (found := _tried(model, scenario, recipe, check, faults)) is not None:
            return {"tried": tried, "file": recipe.file.rpartition("/")[2], **found}
    return {"tried": tried, "file": "", "text": None}


def checks(model: PlantModel, recipe: FileRecipe, cell: str) -> Iterator[Check]:
    """All checks of facts that have a few values, after each step of the main tree; the last steps first."""
    where = model.cell(cell)
    drawn = desk.drawn(model, cell, recipe.content.decode())
    tree = next(each for each in drawn["trees"] if each["main"])
    leaves = [each["path"] for each in tree["nodes"] if each["most"] == 0 and each["path"] != "root"]
    for path in reversed(leaves):
        for role, device in where.roles.items():
            types = getattr(getattr(device, "kind", None), "facts", {})
            for fact in device.fact_names:
                known = types.get(fact)
                values = (True, False) if known is None or known.type is bool else known.words
                yield from (
                    Check(role=role, fact=fact, value=value, tree=tree["name"], path=path) for value in values
                )


def _tried(
    model: PlantModel, scenario: Scenario, recipe: FileRecipe, check: Check, faults: list[Fault]
) -> Row | None:
    """The text with a check that notices these faults, and disturbs nothing without them; None for others."""
    try:
        content = _text(model, scenario.cell, recipe, check)
        found = noticed_with(model, scenario, _recipe(recipe, content), faults)
    except ArboledaError:  # no such check in this cell
        return None
    if found is None:
        return None
    value = shown(check.value)
    return {
        "text": content,
        "check": {"role": check.role, "fact": check.fact, "value": value, "path": check.path},
        "outcome": plain(found),
    }


def _text(model: PlantModel, cell: str, recipe: FileRecipe, check: Check) -> str:
    found = recipe.content.decode()
    for operation in _operations(model, cell, found, check):
        found = str(desk.drawn(model, cell, found, operation)["text"])
    return found


def _operations(model: PlantModel, cell: str, content: str, check: Check) -> Iterator[Operation]:
    """The edits that put a check after a node; where there is room for one node alone, both in a sequence."""
    tree = next(each for each in desk.drawn(model, cell, content)["trees"] if each["name"] == check.tree)
    above, _, last = check.path.rpartition(".")
    parent = above or "root"
    around = next(each for each in tree["nodes"] if each["path"] == parent)
    node = NewNode(
        kind=f"{check.role}_becomes", attributes={check.fact: shown(check.value), "at_most_s": str(WITHIN_S)}
    )
    if "Sequence" in around["kind"]:
        yield Insert(tree=check.tree, parent=parent, index=int(last) + 1, node=node)
        return
    yield Wrap(tree=check.tree, path=check.path, node=NewNode(kind="Sequence"))
    yield Insert(tree=check.tree, parent=check.path, index=1, node=node)


def _recipe(before: FileRecipe, content: str) -> FileRecipe:
    findings = Findings()
    forest = reading.read(before.file, content.encode(), findings)
    fresh = tree_recipe(before.name, before.file, content.encode(), forest, before.own)
    return replace(before, build=fresh.build, content=fresh.content)  # a cell knows more of the one before
