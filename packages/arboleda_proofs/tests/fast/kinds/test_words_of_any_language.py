"""A plant with words of any language is simulated."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from tests.unit.kinds.test_words_of_any_language import folder as folder

from arboleda.cli.main import main


@pytest.mark.long
def test_a_plant_with_them_holds_in_a_simulation(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    words = [
        "simulate",
        "--plant",
        str(folder / "plant.yaml"),
        "--seed",
        "1",
        "--seeds",
        "1",
        "--cycles",
        "2",
        "--jobs",
        "1",
    ]
    monkeypatch.setattr(sys, "argv", ["arboleda", *words])
    with pytest.raises(SystemExit) as end:
        main()
    assert end.value.code == 0
    assert "HELD" in capsys.readouterr().out
