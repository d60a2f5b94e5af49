"""A short run of tools/fuzz-gcode, and that it finds what it is for."""

from __future__ import annotations

from types import ModuleType
from typing import Any

import pytest
from tests.scripts import load

from arboleda_drivers.gcode import grbl, grbl_lines, lines, marlin, marlin_lines, moonraker, moonraker_lines

RUNS = 2000


@pytest.fixture
def fuzz() -> Any:
    return load("fuzz-gcode")


@pytest.mark.long
def test_nothing_is_raised_and_nothing_refused_counts(fuzz: Any) -> None:
    seen = fuzz.run(RUNS, 1)
    assert sum(seen.values()) == RUNS
    assert all(
        seen[what] > RUNS / 100 for what in ("line refused", "line read", "answer read", "no answer")
    ), seen


OKS = [
    (grbl, [grbl_lines.Answer()]),
    (marlin, [marlin_lines.Ok()]),
    (moonraker, [moonraker_lines.Answer(number=number) for number in range(3, 12)]),
]


@pytest.mark.sampled(3)
@pytest.mark.parametrize(("dialect", "oks"), OKS)
def test_a_driver_that_takes_ok_from_anything_would_be_found(
    fuzz: Any, monkeypatch: pytest.MonkeyPatch, dialect: ModuleType, oks: list[object]
) -> None:
    class Lenient(lines.LineReader[object]):
        def feed(self, data: bytes) -> list[object]:
            return [*super().feed(data), *(oks if b"o" in data else [])]

    monkeypatch.setattr(dialect, "LineReader", Lenient)
    with pytest.raises(AssertionError, match="of seed 1"):
        fuzz.run(RUNS, 1)
