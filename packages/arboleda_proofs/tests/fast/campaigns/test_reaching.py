"""Devices of a draft that nothing reaches for."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from arboleda.model.errors import ArboledaError
from arboleda.plant_file.loader import load
from arboleda_make.trying.address import address
from arboleda_make.trying.processes import reaching

EXAMPLE = Path(__file__).parents[5] / "examples/plc_conveyor/plant.yaml"


def test_what_is_at_work_at_the_address_is_left_alone() -> None:
    (belt,) = load(EXAMPLE).robots.values()
    assert belt.driver is not None
    mill = {"device": "mill", "driver": "modbus", "address": address(belt.driver.settings)}
    with pytest.raises(ArboledaError, match="belt: mill is at work at this address"):
        reaching.reached(belt, [mill], 1.0)
    with pytest.raises(ArboledaError, match="belt has no driver that can be opened"):
        reaching.reached(replace(belt, driver=None), [mill], 1.0)
