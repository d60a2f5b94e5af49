"""A proof that is to find a mend names the package that finds it."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.unit.cli.test_missing_packages import NEEDED, mended

from arboleda.model.packages import PackageMissing


def test_a_mend_names_the_package_that_finds_it(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    with pytest.raises(PackageMissing, match=NEEDED):
        mended("prove", monkeypatch, tmp_path)
