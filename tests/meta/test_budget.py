"""The budget of the repository: what is too large, what is raised without a word, what files are a pair."""

from __future__ import annotations

from pathlib import Path

import pytest

from ..scripts import load

BUDGET = load("budget")
Row = BUDGET.Row
CODE = "".join(f"total{n} = add(total{n}, price, {n}, 'euro') + rest\n" for n in range(7))


def row(most: int, why: str = "") -> object:
    return Row(most=most, aim="", why=why)


def test_a_figure_above_its_row_or_without_one_is_wrong() -> None:
    assert BUDGET.wrong({"files": 2, "words": 9, "new": 1}, {"files": row(2), "words": row(8)}) == [
        "words: 9, 8 allowed",
        "new: 1, nothing allowed",
    ]


@pytest.mark.parametrize(
    ("before", "now", "fine"),
    [
        (row(5), row(4), True),
        (row(5), row(6, "a new driver"), True),
        (row(5), row(6), False),
        (row(5, "a new driver"), row(6, "a new driver"), False),
    ],
    ids=["lower", "with a sentence", "without one", "with that of another time"],
)
def test_a_number_is_raised_with_a_sentence_of_its_own(before: object, now: object, fine: bool) -> None:
    assert (BUDGET.raised({"files": now}, {"files": before}) == []) is fine


def test_the_table_is_read_as_it_is_written() -> None:
    rows = {"files": row(5, "a new driver"), "words": Row(most=7, aim="3", why="")}
    assert BUDGET.table(BUDGET.written(rows)) == rows


def test_files_that_differ_in_names_and_numbers_alone_are_a_pair(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(BUDGET, "ROOT", tmp_path)
    texts = {
        "a.py": CODE,
        "b.py": "import os\n\n# other words\n" + CODE.replace("price", "cost").replace("euro", "peso"),
        "c.py": "".join(f"{line}\nx = [1]\n" for line in CODE.splitlines()),
    }
    for name, text in texts.items():
        (tmp_path / name).write_text(text)
    assert list(BUDGET.pairs([Path(name) for name in texts])) == [("a.py", "b.py")]
