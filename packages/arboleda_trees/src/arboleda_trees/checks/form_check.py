"""The check of trees as XML, as `arboleda check` asks for it."""

from __future__ import annotations

from arboleda.model.plant_model import PlantModel

from . import node_rules, passed_over


class TreeCheck:
    """Check of recipes that are trees as XML."""

    rules = node_rules.RULES

    def warnings(self, plant: PlantModel) -> tuple[str, ...]:
        return passed_over.warnings(plant)


CHECK = TreeCheck()
