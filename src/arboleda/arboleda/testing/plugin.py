"""The pytest plugin of the runner, with the fixture `plant_with`; the contract of drivers is beside it.

Every run of pytest loads it, so it imports late.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

import pytest

if TYPE_CHECKING:
    from arboleda.model.plant_model import PlantModel
    from arboleda.runtime.extensions.part import Part

    from .with_parts import PlantWith

pytest.register_assert_rewrite("arboleda.testing.drivers")  # what its cases assert is shown as of any test


class MakePlantWith(Protocol):
    """The fixture `plant_with`: makes a plant with these parts.

    `settings` are the dataclasses of those parts that have some. `plant` is a model, or a plant file that is
    looked for beside the test first; the shipped plant without it.
    """

    def __call__(
        self,
        *parts: type[Part],
        settings: Iterable[object] = (),
        plant: PlantModel | Path | str | None = None,
    ) -> PlantWith: ...


@pytest.fixture
def plant_with(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[MakePlantWith]:
    """Makes a plant with parts of packages, whose time is moved by hand."""
    from arboleda.plant_file import loader

    from .with_parts import PlantWith

    made: list[PlantWith] = []

    def make(
        *parts: type[Part], settings: Iterable[object] = (), plant: PlantModel | Path | str | None = None
    ) -> PlantWith:
        if isinstance(plant, Path | str):
            plant = loader.load(request.path.parent / plant)
        model = loader.load() if plant is None else plant
        made.append(PlantWith(parts, settings=settings, model=model, folder=tmp_path / "extensions"))
        return made[-1]

    yield make
    for each in made:
        each.stop()
