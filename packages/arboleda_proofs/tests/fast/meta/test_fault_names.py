"""The table of faults says each kind by the name that terminal and page say."""

from __future__ import annotations

import re
from pathlib import Path

from arboleda_proofs.simulator.faults import KINDS
from arboleda_proofs.simulator.faults.titles import title

PAGE = Path(__file__).parents[5] / "docs/how-to/test-your-plant.md"
ROW = re.compile(r"\| ((?:`\w+`(?:, )?)+) \| ([^|]+) \| ", re.MULTILINE)
FEW = 3  # kinds of a row whose names all stand there


def test_each_kind_of_fault_stands_beside_its_name() -> None:
    listed = set()
    for kinds, names in ROW.findall(PAGE.read_text()):
        row = [each for each in re.findall(r"\w+", kinds) if each in KINDS]
        listed |= {*row}
        assert len(row) > FEW or ", ".join(str(title(each)) for each in row) in ("", names)
    assert listed == {*KINDS}
