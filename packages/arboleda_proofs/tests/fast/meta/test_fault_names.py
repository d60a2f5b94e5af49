"""The table of faults says each kind by the name that terminal and page say."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from arboleda.dashboard.findings import findings
from arboleda_proofs.simulator.faults import KINDS
from arboleda_proofs.simulator.faults.titles import title

PAGES = Path(__file__).parents[5] / "docs/how-to"
ROW = re.compile(r"\| ((?:`\w+`(?:, )?)+) \| ([^|]+) \| ", re.MULTILINE)
FEW = 3  # kinds of a row whose names all stand there


@pytest.mark.parametrize(
    ("language", "page"), [("en", "test-your-plant.md"), ("es", "test-your-plant.es.md")]
)
def test_each_kind_of_fault_stands_beside_its_name(language: str, page: str) -> None:
    say = findings(language)
    listed = set()
    for kinds, names in ROW.findall((PAGES / page).read_text()):
        row = [each for each in re.findall(r"\w+", kinds) if each in KINDS]
        listed |= {*row}
        assert len(row) > FEW or ", ".join(say(title(each)) for each in row) in ("", names)
    assert listed == {*KINDS}
