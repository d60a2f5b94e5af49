"""`arboleda.testing` goes on working for one minor version, with a warning that says the new name."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

import arboleda.testing
import arboleda_proofs.testing


def test_a_name_is_the_same_with_a_warning() -> None:
    with pytest.warns(DeprecationWarning, match=r"use `from arboleda_proofs\.testing import Sim`"):
        from arboleda.testing import Sim
    assert Sim is arboleda_proofs.testing.Sim


@pytest.mark.parametrize("name", ["Rig", "faults", "shipped", "slowed"])
def test_what_is_of_the_runner_is_found_here_with_a_warning(name: str) -> None:
    with pytest.warns(DeprecationWarning, match=rf"use `from arboleda\.testing import {name}`"):
        found = getattr(arboleda_proofs.testing, name)
    assert found is getattr(arboleda.testing, name)


def test_without_the_package_the_import_says_what_installs_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "arboleda_proofs.testing")
    monkeypatch.delitem(sys.modules, "arboleda_proofs")
    monkeypatch.setattr(
        sys, "path", [each for each in sys.path if not Path(each, "arboleda_proofs").is_dir()]
    )
    with (
        pytest.warns(DeprecationWarning, match="Sim"),
        pytest.raises(ImportError, match=r"pip install 'arboleda\[proofs\]'"),
    ):
        from arboleda.testing import Sim  # noqa: F401
