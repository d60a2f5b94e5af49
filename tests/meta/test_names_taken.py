"""What packages take from the runner beside its public doors, by number: it may only fall."""

from __future__ import annotations

from pathlib import Path

import pytest

from ..scripts import load

TAKEN = load("names-taken")
Count = TAKEN.Count


def test_each_package_takes_what_the_table_says() -> None:
    counts = TAKEN.counts()
    assert counts[TAKEN.TOGETHER].names > 0 and len(counts) == len(TAKEN.FOLDERS) + 1
    assert TAKEN.wrong(counts, TAKEN.allowed()) == []


def test_each_way_of_importing_counts_and_doors_do_not(tmp_path: Path) -> None:
    (tmp_path / "part.py").write_text(
        """
import arboleda.host.pieces
from arboleda.engine import Plant
from arboleda.model import sentence
from arboleda_proofs import testing

def late():
    from arboleda.model.errors import ArboledaError, StartError
"""
    )
    assert TAKEN.taken(tmp_path) == {
        "arboleda.host.pieces": {"*"},
        "arboleda.model.errors": {"ArboledaError", "StartError"},
        "arboleda.model.sentence": {"*"},
    }


@pytest.mark.parametrize(
    ("now", "said"),
    [
        (Count(3, 9), "take them from a door"),
        (Count(2, 10), "take them from"),
        (Count(1, 9), "make names-taken"),
    ],
)
def test_more_is_refused_and_less_is_to_be_written(now: object, said: str) -> None:
    (sentence,) = TAKEN.wrong({"a": now}, {"a": Count(2, 9)})
    assert said in sentence


def test_only_lower_numbers_are_written(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(TAKEN, "TABLE", tmp_path / "table.tsv")
    TAKEN.TABLE.write_text(f"{TAKEN.HEAD}\na\t2\t9\nb\t2\t9\n")
    monkeypatch.setattr(TAKEN, "counts", lambda: {"a": Count(2, 8), "b": Count(2, 10)})
    (refused,) = TAKEN.lower()
    assert refused.startswith("b takes 10 names of 2 modules")
    assert TAKEN.allowed() == {"a": Count(2, 8), "b": Count(2, 9)}
