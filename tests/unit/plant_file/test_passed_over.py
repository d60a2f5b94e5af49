"""`check` warns of trees that are done although their work failed, or broke off with a part in a hand."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.plant_file import passed_over

from .test_advance_check_of_trees import CLOSE, HOME, NONE, OPEN, READ, put, row, take, written

LENIENT = f"<ForceSuccess>{CLOSE}</ForceSuccess>"
ONE = '<Parallel success_count="1">{}</Parallel>'


def warned(folder: Path, body: str, more: str = "") -> list[str]:
    found = passed_over.warnings(written(folder, body, more))
    return [each.removeprefix(f"{folder / 'attempt.xml'}:") for each in found]


def test_a_failure_that_a_force_success_passes_over_is_told_at_its_place(tmp_path: Path) -> None:
    assert warned(tmp_path, f"{OPEN}\n{LENIENT}") == [
        "3:1: lab: attempt has ForceSuccess pass over a failure of reader close, and is done all the same; "
        "ask reader afterwards, or say in a Fallback what is done instead"
    ]


@pytest.mark.parametrize(
    "body",
    [
        f"{LENIENT}{READ}",
        f'{LENIENT}<reader_says lid="closed"/>',
        f'{LENIENT}<reader_tells lid="{{seen}}"/>',
        f"<Fallback>{CLOSE}{NONE}</Fallback>",
        f"<ForceSuccess>{READ}</ForceSuccess>",
        f"<Fallback>{OPEN}<Sequence>{LENIENT}<AlwaysFailure/></Sequence></Fallback>",
        f"<TryCatch>{OPEN}{LENIENT}</TryCatch>",
        f'<Repeat num_cycles="2"><Sequence>{READ}{LENIENT}</Sequence></Repeat>',
    ],
    ids=[
        "asked",
        "checked",
        "told",
        "an answer to it",
        "no work",
        "fails after it",
        "a rescue",
        "asked in a loop",
    ],
)
def test_nothing_is_told_where_somebody_asks_or_the_task_is_not_done(tmp_path: Path, body: str) -> None:
    assert warned(tmp_path, body) == []


def test_a_part_that_a_parallel_may_leave_in_a_hand_is_told(tmp_path: Path) -> None:
    body = ONE.format(row(take("rack"), put("bin")) + READ) + HOME
    assert warned(tmp_path, body) == [
        "2:1: lab: attempt has Parallel end before all of its 2 children are done, "
        "and may be done with a part that jaw holds; let all of them succeed, or let go of the part after it"
    ]


@pytest.mark.parametrize(
    "body",
    [
        ONE.format(take("rack") + READ) + put("bin"),
        ONE.format(OPEN + READ),
        f"<Parallel>{row(take('rack'), put('bin'))}{READ}</Parallel>",
    ],
    ids=["let go afterwards", "no part", "all of them"],
)
def test_a_parallel_that_leaves_nothing_is_not_told(tmp_path: Path, body: str) -> None:
    assert warned(tmp_path, body) == []
