"""A decision is short; one that no longer holds, or holds in part only, says so before anything else."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[2] / "docs/decisions"
MOST_WORDS = 200
MARK = re.compile(r"^\W*(?:No longer holds|Holds in part|Replaced by)\b", re.IGNORECASE)
FORM = re.compile(r"\*\*(?:No longer holds|Holds in part):\*\* \S.*")
LINK = re.compile(r"\]\(([^)#]+)[^)]*\)")


def faults(page: str, folder: Path) -> list[str]:
    """What is wrong with the marks of a page in that folder."""
    lines = page.splitlines()
    marks = [number for number, line in enumerate(lines) if MARK.match(line)]
    wrong = [lines[number] for number in marks if number != 2 or not FORM.fullmatch(lines[number])]
    targets = [LINK.findall(lines[number]) for number in marks]
    lost = [target for found in targets for target in found if not (folder / target).is_file()]
    return [*wrong, *lost, *(["no link"] if [] in targets else [])]


@pytest.mark.parametrize("page", sorted(FOLDER.glob("*.md")), ids=lambda page: page.stem)
def test_a_mark_stands_below_the_title_and_leads_to_what_holds_now(page: Path) -> None:
    assert faults(page.read_text("utf-8"), FOLDER) == []


@pytest.mark.parametrize("page", sorted(FOLDER.glob("*.md")), ids=lambda page: page.stem)
def test_a_decision_is_short(page: Path) -> None:
    assert len(page.read_text("utf-8").split()) <= MOST_WORDS


@pytest.mark.parametrize(
    ("below", "wrong"),
    [
        ("**No longer holds:** [next](next.md).\n", []),
        ("Old.\n\n**Holds in part:** [next](next.md).\n", ["**Holds in part:** [next](next.md)."]),
        ("*Replaced by [next](next.md).*\n", ["*Replaced by [next](next.md).*"]),
        ("**No longer holds:** [gone](gone.md).\n", ["gone.md"]),
        ("**Holds in part:** nobody knows why.\n", ["no link"]),
    ],
    ids=["right", "late", "another form", "lost link", "no link"],
)
def test_it_finds_marks_that_are_wrong(tmp_path: Path, below: str, wrong: list[str]) -> None:
    (tmp_path / "next.md").touch()
    assert faults(f"# 1. Old\n\n{below}", tmp_path) == wrong
