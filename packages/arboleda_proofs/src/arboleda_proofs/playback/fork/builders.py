"""Recipes that are replaced from a time on, for tasks that begin after it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from arboleda.model.plant_model import PlantModel
from arboleda.model.recipe import Build, Builders


class LateLookup(Mapping[str, Build]):
    """Builders of recipes that a plant looks up: none before `switch`, then those given to it."""

    def __init__(self) -> None:
        self._builders: Builders = {}

    def switch(self, builders: Builders | None) -> None:
        self._builders = builders or {}

    def __bool__(self) -> bool:
        """Always true, as a plant that gets no builders at all would never look again."""
        return True

    def __getitem__(self, name: str) -> Build:
        return self._builders[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._builders)

    def __len__(self) -> int:
        return len(self._builders)


def builders_of(model: PlantModel) -> Builders:
    """The builders of a plant's own recipes, each as its cell has it."""
    names = {each.name for cell in model.cells for each in cell.recipes}
    return {name: _builder(model, name) for name in names}


def _builder(model: PlantModel, name: str) -> Build:
    return lambda order, context: model.cell(order.cell).recipe(name).build(order, context)
