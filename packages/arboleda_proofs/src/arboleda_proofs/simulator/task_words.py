"""Words of a task's parameters by what its cell has, as people know them who look at the cell."""

from __future__ import annotations

from collections.abc import Sequence

from arboleda.model.plant_model import Cell
from arboleda.recipes import Parameter


def task_words(cell: Cell, parameter: Parameter) -> Sequence[str]:
    """All words for a parameter: the targets of a group or their numbers, the paths, or its choices."""
    told, group = parameter.words(cell), cell.groups.get(parameter.group or "")
    if group is not None:
        return group if {*told} <= {*group} else [str(number) for number in range(len(group))]
    return [*cell.paths] if {*told} <= cell.paths.keys() else told
