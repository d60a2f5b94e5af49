"""docs/reference/states.md is what `scripts/state-diagrams` makes of the tables, and shows all of them."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from arboleda.dispatch import ledger
from arboleda.model import cell_states, task

from ..scripts import printed

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs/reference/states.md"
Arrow = tuple[str, str, str]  # from, what happens ("" where the diagram has no word), to

TABLES: dict[str, set[Arrow]] = {
    "Command": {(a.value, feed.value, b.value) for (a, feed), b in ledger.TABLE.items()},
    "Task": {(a.value, "", b.value) for a, nexts in task.LEGAL.items() for b in nexts},
    "Cell": {(a.value, cause.value, b.value) for (a, cause), b in cell_states.TABLE.items()},
}


def drawn(section: str) -> set[Arrow]:
    """The arrows of a section's diagram, `any` taken apart; those from and to [*] left out."""
    text = PAGE.read_text(encoding="utf-8").partition(f"## {section}\n")[2].partition("\n## ")[0]
    lines = re.findall(r"^ +(\w+) --> (\w+)(?:: (.+))?$", text, re.MULTILINE)
    states = {end for a, b, _ in lines for end in (a, b)} - {"any"}
    return {
        (each, word, b)
        for a, b, words in lines
        for each in (states if a == "any" else {a})
        for word in words.split(", ")
    }


def test_the_page_is_what_the_script_prints() -> None:
    assert PAGE.read_text(encoding="utf-8") == printed("state-diagrams"), "run `make diagrams`"


@pytest.mark.parametrize("section", TABLES)
def test_a_diagram_shows_every_row_of_its_table_and_no_other(section: str) -> None:
    assert drawn(section) == TABLES[section]
