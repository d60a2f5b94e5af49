"""A short run of tools/fuzz-reports, and that it finds what it is for."""

from __future__ import annotations

from typing import Any

import pytest
from tests.scripts import load

from arboleda.kinds.arm import Arm
from arboleda.kinds.mobile import Mobile
from arboleda.model.plant_model import Robot

RUNS = 4000


@pytest.fixture
def fuzz() -> Any:
    return load("fuzz-reports")


def test_no_mixture_of_fields_raises_anything(fuzz: Any) -> None:
    seen = fuzz.run(RUNS, 1)
    assert sum(seen.values()) == RUNS
    ways = ("mqtt taken", "mqtt refused", "status taken", "status refused", "unchecked taken")
    assert all(seen[way] > RUNS / 50 for way in (*ways, "unchecked ignored")), seen


def test_a_field_that_a_kind_of_robot_cannot_say_would_be_found(
    fuzz: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    def nothing_is_wrong(robot: Robot, report: object) -> None:
        return None

    for kind in (Arm, Mobile):
        monkeypatch.setattr(kind, "objection", nothing_is_wrong)
    with pytest.raises((KeyError, ValueError)):
        fuzz.run(RUNS, 1)
