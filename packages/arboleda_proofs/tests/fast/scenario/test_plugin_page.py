"""docs/how-to/test-your-plant.md: its files run as they stand there, and it names every kind of fault."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from arboleda_proofs.simulator.faults import KINDS
from arboleda_proofs.simulator.levels import LEVELS
from arboleda_proofs.testing import Sim

pytest_plugins = "pytester"

PAGE = (Path(__file__).parents[5] / "docs" / "how-to" / "test-your-plant.md").read_text("utf-8")
FILES = dict(re.findall(r"^```\w+\n# (\S+)\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL))
TESTS = [name for name in FILES if name.startswith("test_")]


@pytest.mark.long
@pytest.mark.parametrize("test", TESTS)
def test_a_test_of_the_page_passes(
    test: str, pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
    for name, text in FILES.items():
        pytester.path.joinpath(name).write_text(text, "utf-8")
    result = pytester.runpytest("-p", "arboleda_proofs.testing.plugin", test)
    result.assert_outcomes(passed=FILES[test].count("\ndef test_") + FILES[test].startswith("def test_"))


def test_the_page_has_plants_a_recipe_and_tests() -> None:
    assert set(FILES) - set(TESTS) == {"my_plant.yaml", "there_and_back.py", "bench.yaml", "tidy.py"}
    assert len(TESTS) == 4


def test_every_kind_and_level_of_faults_is_on_the_page() -> None:
    assert [name for name in (*KINDS, *LEVELS) if f"`{name}`" not in PAGE] == []


def test_whatever_a_test_can_call_is_on_the_page() -> None:
    public = [name for name in vars(Sim) if not name.startswith("_") and name != "last_words"]
    assert [name for name in public if f"`sim.{name}" not in PAGE] == []
