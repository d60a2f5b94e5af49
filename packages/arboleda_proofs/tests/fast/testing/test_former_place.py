"""`arboleda.testing` goes on working for one minor version, with a warning that says the new name."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

import arboleda_proofs.testing


def test_a_name_is_the_same_with_a_warning() -> None:
    with pytest.warns(DeprecationWarning, match=r"use `from arboleda_proofs\.testing import Sim`"):
        from arboleda.testing import Sim
    assert Sim is arboleda_proofs.testing.Sim


def test_without_the_package_the_import_says_what_installs_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "arboleda_proofs.testing")
    monkeypatch.delitem(sys.modules, "arboleda_proofs")
    monkeypatch.setattr(
        sys, "path", [each for each in sys.path if not Path(each, "arboleda_proofs").is_dir()]
    )
    with (
        pytest.warns(DeprecationWarning, match="Rig"),
        pytest.raises(ImportError, match=r"pip install 'arboleda\[proofs\]'"),
    ):
        from arboleda.testing import Rig  # noqa: F401
