"""The part of `arboleda check` that is about files of trees."""

from __future__ import annotations

from pathlib import Path

from arboleda.extension import ConfigError
from arboleda.model.plant_model import PlantModel

from ..bt_xml.leaves import NotTheSame
from ..files.tree_file import report
from . import nodes


def of_trees(file: Path, model: PlantModel | None, cell: str | None) -> list[str]:
    """The lines about a file of trees; where nodes are not the same in all cells, those of the cells that can
    run it, if these are alike.
    """
    if model is None:
        return report(file)
    try:
        known = nodes.of_plant(model, cell)
    except NotTheSame:
        found = [lines for each in model.cells if (lines := _of_cell(file, model, each.name)) is not None]
        if not found or any(lines != found[0] for lines in found):
            raise
        return found[0]
    return report(file, known)


def _of_cell(file: Path, model: PlantModel, cell: str) -> list[str] | None:
    """The lines about a file of trees for this cell; None if it cannot run them."""
    try:
        return report(file, nodes.of_plant(model, cell))
    except ConfigError:
        return None
