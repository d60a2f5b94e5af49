"""The two SCARA arms of `arboleda new --like scara_pair`: the tests that come with them pass."""

from __future__ import annotations

from pathlib import Path
from shutil import copytree

import pytest

pytest_plugins = "pytester"

PAIR = Path(__file__).parents[5] / "examples/scara_pair"


@pytest.mark.long
def test_the_tests_of_the_example_pass(pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
    copytree(PAIR, pytester.path, dirs_exist_ok=True)
    pytester.runpytest("-p", "arboleda_proofs.testing.plugin").assert_outcomes(passed=5)
