from __future__ import annotations

from dataclasses import replace

import pytest

from arboleda.app.config import load
from arboleda.core.model import Evidence, PlantModel


@pytest.fixture(scope="session")
def shipped() -> PlantModel:
    return load(None)


def at_level(model: PlantModel, evidence: Evidence) -> PlantModel:
    """The same plant with every robot proving only what `evidence` says."""
    cells = tuple(
        replace(
            cell, arm=replace(cell.arm, evidence=evidence), mobile=replace(cell.mobile, evidence=evidence)
        )
        for cell in model.cells
    )
    return replace(model, cells=cells)
