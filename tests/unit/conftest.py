"""The shipped plant's robots, read from their URDF as the page reads them."""

from __future__ import annotations

import pytest

from arboleda.geometry import bodies
from arboleda.geometry.bodies import Body
from arboleda.plant_file.urdf import robot_urdf
from arboleda.testing import shipped


@pytest.fixture(scope="session")
def drawings() -> dict[str, Body]:
    return {name: bodies.read(robot_urdf(shipped(), name)) for name in shipped().robots}
