"""A short run of tools/fuzz-trees, and that it finds what it is for."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from tests.lengths import length
from tests.scripts import load

from arboleda_trees.bt_xml import script

RUNS = length(150, whole=1500)
ENOUGH, SEED = 100, 13  # to find what is planted


@pytest.fixture
def fuzz(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Any:
    monkeypatch.chdir(tmp_path)
    return load("fuzz-trees")


def test_no_mixture_of_mistakes_raises_anything(fuzz: Any) -> None:
    seen = fuzz.run(RUNS, 1)
    assert sum(seen.values()) == RUNS
    assert all(seen[what] > RUNS / 100 for what in ("warned of", "refused")), seen


def test_its_samples_have_no_mistake(fuzz: Any) -> None:
    assert {fuzz.look_at(sample) for sample in fuzz.SAMPLES} <= {"good", "warned of"}


def test_a_limit_that_is_missing_would_be_found(
    fuzz: Any, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(script, "LONGEST_NUMBER", 10_000)  # Python reads no number of so many digits
    monkeypatch.setattr(fuzz, "ODD", [b"9" * 5000])
    with pytest.raises(AssertionError, match=r"kept as fuzz-trees\.xml"):
        fuzz.run(ENOUGH, SEED)
    assert (tmp_path / "fuzz-trees.xml").exists()
