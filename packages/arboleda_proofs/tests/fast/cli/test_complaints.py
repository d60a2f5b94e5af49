"""Plant files that simulate and prove are given."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.unit.cli.test_complaints import EVIL, complained, is_told_the_option


@pytest.mark.parametrize("command", ["simulate", "prove"])
def test_a_plant_file_without_its_option_is_taken_and_told_the_option(
    command: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    said = complained([command, f"my{EVIL}.yaml"], monkeypatch, capsys)
    assert is_told_the_option(said), said


def test_the_option_names_the_plant_file(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    said = complained(["prove", "--plant", "mine.yaml"], monkeypatch, capsys)
    assert said == "arboleda: mine.yaml: there is no such file\n"
