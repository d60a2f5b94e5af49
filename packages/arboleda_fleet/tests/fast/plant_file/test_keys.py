"""Keys of the plant file that need this package."""

from __future__ import annotations

import pytest
from tests.unit.plant_file.test_config import EXAMPLES

from arboleda.plant_file import loader


@pytest.mark.parametrize("key", ["store: postgresql://me@db.example/plants", "opcua_view: {port: 4840}"])
def test_a_key_is_taken_where_the_package_is_installed(key: str) -> None:
    content = (EXAMPLES / "by_hand.yaml").read_bytes()
    plant = loader.parse("plant.yaml", content.replace(b"\ncells:", f"\n{key}\ncells:".encode(), 1))
    assert (plant.store != "", plant.opcua_view is not None) == (key[0] == "s", key[0] == "o")
