"""`check` warns of trees that are done although their work failed, or broke off with a part in a hand."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.plants import plant_text, read

from arboleda_trees.checks import passed_over

from .test_advance_check_of_trees import (
    CLOSE,
    HOME,
    NONE,
    OPEN,
    READ,
    TREE,
    if_clear,
    put,
    row,
    take,
    written,
)

LENIENT = f"<ForceSuccess>{CLOSE}</ForceSuccess>"
SAYS = '<reader_says lid="closed"/>'
ONE = '<Parallel success_count="1">{}</Parallel>'


def warned(folder: Path, body: str, more: str = "") -> list[str]:
    found = passed_over.warnings(written(folder, body, more))
    return [each.removeprefix(f"{folder / 'attempt.xml'}:") for each in found]


def test_a_failure_that_a_force_success_passes_over_is_told_at_its_place(tmp_path: Path) -> None:
    assert warned(tmp_path, f"{OPEN}\n{LENIENT}") == [
        "3:1: lab: attempt has ForceSuccess pass over a failure of reader close, and is done all the same; "
        'write <reader_says lid="closed"/> afterwards, or say in a Fallback what is done instead'
    ]


ANSWER = '<reader_read answer="{seen}"/>'
SWITCH = '<Switch2 variable="{seen}" case_1="clear" case_2="unclear">{}</Switch2>'
CLAMP = '<reader_clamp on="true"/>'
FAILS = "<AlwaysFailure/>"


@pytest.mark.parametrize(
    "body",
    [
        ANSWER + SWITCH.replace("{}", LENIENT + NONE + FAILS),
        ANSWER + if_clear(LENIENT, FAILS),
        f"<Fallback>{row(OPEN, LENIENT)}{FAILS}</Fallback>",
        f"<Fallback>{row(LENIENT, FAILS)}{OPEN}</Fallback>",
        f"<ForceSuccess>{row(LENIENT, FAILS)}</ForceSuccess>",
        f"{row(LENIENT, FAILS)}".replace("Sequence", "Fallback"),
        f"<Inverter>{row(LENIENT, FAILS)}</Inverter>",
        ANSWER + SWITCH.replace("{}", LENIENT + SAYS + NONE),
    ],
    ids=[
        "another case fails",
        "the other branch fails",
        "the alternative fails, and never begins",
        "an alternative follows the failure",
        "the failure is passed over as well",
        "an alternative that never begins",
        "the failure is turned round",
        "another case asks",
    ],
)
def test_what_stands_behind_and_does_not_follow_excuses_nothing(tmp_path: Path, body: str) -> None:
    assert [each for each in warned(tmp_path, body) if "reader close" in each]


@pytest.mark.parametrize("asks", ['<reader_says clamped="true"/>', '<reader_tells clamped="{held}"/>', CLAMP])
def test_a_question_about_something_else_is_none_about_the_work(tmp_path: Path, asks: str) -> None:
    (found,) = warned(tmp_path, LENIENT + asks)
    assert "a failure of reader close" in found


PUMP = plant_text(__file__, "passed_over")


@pytest.mark.parametrize(
    ("asks", "is_told"),
    [
        ('<pump_says lid="shut"/>', True),
        ("<pump_shut/>", True),
        ('<pump_says ml="5"/>', False),
        ("<pump_look/>", False),
    ],
)
def test_of_work_that_sets_no_fact_answers_may_tell_and_facts_that_no_verb_sets(
    tmp_path: Path, asks: str, is_told: bool
) -> None:
    tree = TREE.format(body=f"<ForceSuccess><pump_pour/></ForceSuccess>{asks}", more="")
    assert bool(passed_over.warnings(read(tmp_path, PUMP, beside={"pour.xml": tree}))) is is_told


@pytest.mark.parametrize(
    "body",
    [
        f"{LENIENT}{READ}",
        LENIENT + SAYS,
        f'{LENIENT}<reader_tells lid="{{seen}}"/>',
        LENIENT + put("drawer"),
        f"<Fallback>{row(LENIENT, SAYS)}{NONE}</Fallback>",
        f"<IfThenElse>{LENIENT}{row(READ)}{NONE}</IfThenElse>",
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
        "a robot waits for it",
        "asked, with an alternative",
        "asked by the branch after a condition",
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
