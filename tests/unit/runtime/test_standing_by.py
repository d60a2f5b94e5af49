"""Who is to stand by is told which package that needs."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.packages import leave_out

from arboleda.model.errors import StartError
from arboleda.runtime.options import Options
from arboleda.runtime.standing_by import take_over
from arboleda.testing import shipped


def test_standing_by_without_its_package_is_refused_with_the_line_that_installs_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    leave_out(monkeypatch, tmp_path, "arboleda_fleet")
    model = shipped("sis_a")
    with pytest.raises(StartError, match=r"needs the package fleet.*: type pip install 'arboleda\[fleet\]'"):
        take_over(model, {"orchestrator"}, Options(), print, lambda: (model, None))
