"""An option that another package serves names that package, before anything is done."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from tests.packages import leave_out
from typer.testing import CliRunner

from arboleda.cli.main import cli
from arboleda.model.packages import PackageMissing

BENCH = Path(__file__).parents[3] / "examples/lab_bench"
NEEDED = r"^--mend needs the package make.*arboleda\[make\]"


def mended(command: str, monkeypatch: pytest.MonkeyPatch, folder: Path) -> None:
    """Ask a command for a mend, where nobody has installed what finds it."""
    plant = shutil.copytree(BENCH, folder / "plant") / "plant.yaml"
    leave_out(monkeypatch, folder / "nothing", "arboleda_make")
    CliRunner().invoke(cli, [command, str(plant), "--mend"], catch_exceptions=False)


def test_a_mend_names_the_package_that_finds_it(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    with pytest.raises(PackageMissing, match=NEEDED):
        mended("check", monkeypatch, tmp_path)


def test_the_check_itself_needs_no_other_package(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    plant = shutil.copytree(BENCH, tmp_path / "plant") / "plant.yaml"
    leave_out(monkeypatch, tmp_path / "nothing", "arboleda_make", "arboleda_proofs")
    ran = CliRunner().invoke(cli, ["check", str(plant), "--json", "-"], catch_exceptions=False)
    assert '"findings"' in ran.output
