"""The page of each driver says the grade that the table of drivers has."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from tests.packages import ROOT

PACKAGE = ROOT / "packages/arboleda_drivers"
ROW = re.compile(r"^\| `(\w+)` .*\| (\w+) \|$", re.MULTILINE)
ON_PAGE = re.compile(r"\[grade\]\(virtual-controllers\.md#grades\) is (\w+)\.")
GRADES = dict(ROW.findall((PACKAGE / "README.md").read_text()))
PAGES = sorted((PACKAGE / "src/arboleda_drivers").glob("*/README.md"))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.parent.name)
def test_a_page_says_the_grade_of_the_table(page: Path) -> None:
    assert ON_PAGE.findall(page.read_text()) == [GRADES[page.parent.name]]
