"""Verdicts of the judge of kills on a history and on the deeds of arms."""

from __future__ import annotations

from dataclasses import replace

import pytest

from arboleda.store.task_rows import TaskRow
from arboleda_kills.deeds import ALONE, Deed, Did
from arboleda_kills.judge import AGAIN, FAILED, HELD, WENT_ON, Kill, Verdict, judge
from arboleda_kills.people import Said

ROW = TaskRow(
    number=1,
    id="a",
    text="sis_a 0B 1",
    cell="sis_a",
    recipe="storage",
    state="done",
    reason=None,
    sentence=None,
    said=None,
    accepted_s=10.0,
    started_s=11.0,
    ended_s=20.0,
)
KILL = Kill(started_at=5.0, joined_at=5.5, killed_at=13.0, running=frozenset({"a"}))
LAST = Kill(started_at=14.0, joined_at=14.2)
RESUME = Said(at=15.0, cell="sis_a", verb="resume", scope="sis_a", drops=False)


def deed(at: float, did: Did, what: str, robot: str = "ra1") -> Deed:
    return Deed(at=at, cell="sis_a", robot=robot, did=did, what=what)


PICKED = deed(12.0, Did.PICKED, "pick-up")
PLACED = deed(17.0, Did.LET_GO, "station 1")


def judged(
    *deeds: Deed, row: TaskRow | None = ROW, said: tuple[Said, ...] = (RESUME,), **books: object
) -> Verdict:
    known: dict[str, object] = {"accepted": {"a": "sis_a 0B 1"}, "ends": {}, "last": LAST, **books}
    kills = known.pop("kills", [KILL])
    return judge([row] if row else [], deeds, kills, said, **known)  # type: ignore[arg-type]


def test_a_task_that_is_done_once_is_well() -> None:
    verdict = judged(PICKED, PLACED)
    assert verdict.ok
    assert verdict.after == {WENT_ON: 1}


@pytest.mark.parametrize(
    ("row", "sentence"),
    [
        (None, "is not in the history"),
        (replace(ROW, text="sis_a 0B 2"), "kept as 'sis_a 0B 2'"),
        (replace(ROW, state="running", ended_s=None), "never ended: it is running"),
    ],
)
def test_an_accepted_task_that_is_not_as_it_was_is_lost(row: TaskRow | None, sentence: str) -> None:
    verdict = judged(PICKED, row=row)
    assert sentence in verdict.lost[0] and not verdict.ok


def test_an_end_that_was_told_and_changed_is_lost() -> None:
    verdict = judged(PICKED, PLACED, ends={"a": "failed"})
    assert verdict.lost == ["a (sis_a 0B 1) was said to be failed and was kept as done"]


def test_a_task_that_is_kept_as_done_and_was_not_is_lost() -> None:
    assert "the arm set down no part" in judged(PICKED).lost[0]


@pytest.mark.parametrize("again", [[PICKED], [PLACED]])
def test_a_deed_that_a_task_has_twice_is_doubled(again: list[Deed]) -> None:
    verdict = judged(PICKED, PLACED, *again)
    assert len(verdict.doubled) == 1 and "2 parts" in verdict.doubled[0] and not verdict.ok


def test_a_part_taken_up_for_no_task_is_doubled() -> None:
    assert "no task was at work" in judged(PICKED, PLACED, replace(PICKED, at=25.0)).doubled[0]


def test_a_part_that_was_taken_up_for_no_task_and_put_back_is_doubled_all_the_same() -> None:
    stray = [replace(PICKED, at=25.0), deed(26.0, Did.LET_GO, "pick-up")]
    verdict = judged(PICKED, PLACED, *stray)
    assert len(verdict.doubled) == 1 and verdict.put_back == 1


def test_a_part_taken_up_where_the_mobile_robot_is_not_is_doubled() -> None:
    assert judged(replace(PICKED, what=f"pick-up{ALONE}"), PLACED).doubled


@pytest.mark.parametrize("where", ["no pose", "station 2", f"pick-up{ALONE}"])
def test_a_part_let_go_elsewhere_is_dropped(where: str) -> None:
    verdict = judged(
        PICKED, deed(14.5, Did.LET_GO, where), row=replace(ROW, state="failed", reason="deadline")
    )
    assert where in verdict.dropped[0] and not verdict.ok


def test_a_part_put_back_may_be_taken_up_again() -> None:
    verdict = judged(PICKED, deed(13.5, Did.LET_GO, "pick-up"), replace(PICKED, at=16.0), PLACED)
    assert verdict.ok and verdict.put_back == 1


def test_a_part_let_go_as_an_operator_was_advised_is_counted_apart() -> None:
    release = Said(at=14.4, cell="sis_a", verb="release", scope="ra1", drops=True)
    row = replace(ROW, state="failed", reason="interrupted", ended_s=14.2)
    verdict = judged(PICKED, deed(14.5, Did.LET_GO, "no pose"), row=row, said=(release,))
    assert verdict.ok and verdict.by_hand == 1


def test_a_robot_that_is_told_something_before_anybody_said_so_is_named() -> None:
    moves = [deed(at, Did.WAS_TOLD, "PathGoal", "rm_sis_a") for at in (6.0, 14.5, 15.5)]
    verdict = judged(PICKED, PLACED, *moves)
    assert verdict.moved == ["rm_sis_a was told a PathGoal before anybody let sis_a go on"]


def test_what_boards_do_late_that_the_killed_plant_had_told_them_is_its_own() -> None:
    assert judged(PICKED, PLACED, deed(14.1, Did.WAS_TOLD, "PathGoal", "rm_sis_a")).ok


def test_a_task_that_was_asked_for_after_the_start_is_cause_enough() -> None:
    new = replace(ROW, accepted_s=14.1, started_s=14.2)
    picked, move = replace(PICKED, at=14.6), deed(14.5, Did.WAS_TOLD, "PathGoal", "rm_sis_a")
    assert judged(picked, PLACED, move, row=new, said=()).ok


RETRY = replace(RESUME, verb="retry")
INTERRUPTED = replace(ROW, state="failed", reason="interrupted", ended_s=14.2)


@pytest.mark.parametrize(
    ("row", "said", "became"),
    [
        (ROW, (RESUME,), WENT_ON),
        (ROW, (RETRY, RESUME), HELD),
        (INTERRUPTED, (), FAILED),
        (INTERRUPTED, (RETRY,), FAILED),  # it was said of the cell, when the task was over
        (replace(INTERRUPTED, ended_s=18.0), (RETRY,), HELD),
    ],
)
def test_what_became_of_a_task_that_was_at_work(row: TaskRow, said: tuple[Said, ...], became: str) -> None:
    assert judged(PICKED, PLACED, row=row, said=said).after == {became: 1}


def test_a_task_that_is_killed_again_is_counted_at_each_kill() -> None:
    kills = [KILL, Kill(started_at=14.0, joined_at=14.1, killed_at=16.0, running=frozenset({"a"}))]
    late = Said(at=18.5, cell="sis_a", verb="resume", scope="sis_a", drops=False)
    verdict = judged(
        PICKED,
        replace(PLACED, at=19.0),
        kills=kills,
        said=(RESUME, late),
        last=Kill(started_at=18.0, joined_at=18.1),
    )
    assert verdict.after == {AGAIN: 1, WENT_ON: 1}
