"""Commands that `arboleda_drawn.by_commit` runs, and its words."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from arboleda_drawn import by_commit
from arboleda_drawn.devices import DrawnDevices
from arboleda_drawn.plants import DrawnPlants


def row(seed: int, **others: Any) -> str:
    told = {"commit": "abc", "options": "--faults none", "cycles": 20, "faults": 3}
    return json.dumps({"seed": seed, "broken": None, "findings": [], **told, **others}) + "\n"


def test_it_counts_by_commit_and_names_what_broke(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "done.jsonl"
    file.write_text(row(1) + row(2, broken="no_starvation: a waits") + row(3, commit="def", findings=["f"]))
    assert by_commit.tell(file) == 2
    assert capsys.readouterr().out.splitlines() == [
        "abc: 2 plants, 40 cycles, 6 faults (2 --faults none)",
        "  seed 2 --faults none: no_starvation: a waits",
        "  1 wrong",
        "def: 1 plants, 20 cycles, 3 faults (1 --faults none)",
        "  seed 3 --faults none: f",
        "  1 wrong",
    ]


def test_its_seeds_draw_plants_with_cells_of_devices() -> None:
    seed = next(by_commit.seeds_of_devices(10_000))
    assert isinstance(DrawnPlants().of(seed).drawn, DrawnDevices)


def test_a_seed_that_was_run_on_this_commit_is_not_run_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file, ran = tmp_path / "done.jsonl", []
    file.write_text(row(1) + row(2, commit="another"))
    monkeypatch.setattr(by_commit, "commit_of", lambda folder: "abc")
    monkeypatch.setattr(by_commit, "seeds_of_devices", lambda first: iter([1, 2]))
    monkeypatch.setattr(by_commit, "run", lambda seed, commit: ran.append(seed) or json.loads(row(seed)))
    assert by_commit.main([str(file), "2"]) == 0
    assert ran == [2]
