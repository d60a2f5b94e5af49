"""The floor of a cell: its devices where the plant believes them to be."""

from __future__ import annotations

from pathlib import Path
from typing import Any
from xml.etree import ElementTree as Xml

import pytest

from arboleda.client.answers.plant import Robot
from arboleda.plant_file import loader
from arboleda_make.assistant.floor import drawn
from arboleda_make.assistant.looks import NothingThere

ASSEMBLY = Path(__file__).parents[5] / "examples" / "assembly" / "plant.yaml"
UNKNOWN: dict[str, Any] = {"online": True, "obstacle": None, "state": 0, "age_s": 0.0, "answer": None}
UNKNOWN |= {"homed": True, "latched": False, "refused": {}, "node": None}


def robot(name: str, q: list[float] | None, **facts: Any) -> Robot:
    return Robot(name=name, kind="arm", q=q, facts=facts, **UNKNOWN)


def test_what_has_a_place_is_drawn_and_what_has_facts_is_said() -> None:
    model = loader.load(ASSEMBLY, recipes=False)
    fixture = robot("fixture", None, ram="up", clamped=False, heat=None)
    found = drawn(model, "station", [robot("left", [0.0, 0.0, 0.0]), robot("right", None), fixture])
    picture = Xml.fromstring(found["svg"])
    assert [each.text for each in picture.iter("{http://www.w3.org/2000/svg}text")] == ["left"]
    assert found["facts"]["fixture"] == "ram: up, clamped: false"


def test_no_place_and_no_cell_are_said() -> None:
    model = loader.load(ASSEMBLY, recipes=False)
    with pytest.raises(NothingThere, match="Nothing of this cell can be drawn"):
        drawn(model, "station", [robot("left", None)])
    with pytest.raises(NothingThere, match="nowhere"):
        drawn(model, "nowhere", [])
