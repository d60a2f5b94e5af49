"""OEE: availability x performance x quality, each from what a plant's memory has of a time."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from arboleda.oee.figures import (
    FEW_TIMES,
    LATE_S,
    NEVER_RAN,
    NO_PLAN,
    NOTHING_ENDED,
    Downtime,
    Oee,
    PastTask,
    PastTimes,
    PlantRun,
    Shortest,
    common,
    joined,
    length,
    oee,
    without,
)

NOW = 1000.0
ALL_DAY = PlantRun(since_s=0.0, seen_s=NOW, ended=False)


def work(accepted: float, started: float | None, ended: float | None, state: str = "done") -> PastTask:
    return PastTask(cell="a", order="a 1", state=state, accepted_s=accepted, started_s=started, ended_s=ended)


def figures(
    *works: PastTask,
    runs: tuple[PlantRun, ...] = (ALL_DAY,),
    downs: tuple[tuple[float, float | None], ...] = (),
    best: float | None = 50.0,
    since: float = 0.0,
) -> Oee:
    stood = [Downtime(cell="a", since_s=begin, until_s=end) for begin, end in downs]
    shortest = {} if best is None else {("a", "a 1"): Shortest(times=3, seconds=best)}
    return oee("a", PastTimes(works=works, runs=runs, downs=stood, shortest=shortest), since, NOW)


def test_a_cell_that_does_its_best_all_the_time_has_all_of_it() -> None:
    found = figures(work(0, 0, 50), work(50, 50, 100))
    assert (found.availability, found.performance, found.quality, found.oee) == (1.0, 1.0, 1.0, 1.0)
    assert found.missing is None and found.planned_s == 100.0


def test_the_three_are_multiplied() -> None:
    """Of 200 s that were planned it was held for 40 and idle for 60; two tasks took 50 s each, one failed."""
    found = figures(work(0, 0, 90), work(90, 150, 200, "failed"), downs=((50.0, 90.0),), best=40.0)
    assert found.planned_s == 200.0 and found.worked_s == 100.0
    assert (found.availability, found.performance, found.quality) == (0.5, 0.8, 0.5)
    assert found.oee == pytest.approx(0.2)


def test_it_is_what_good_tasks_need_at_best_of_the_planned_time() -> None:
    found = figures(work(0, 0, 90), work(90, 150, 200, "failed"), downs=((50.0, 90.0),), best=40.0)
    assert found.oee == pytest.approx(40.0 * found.done / found.planned_s)


def test_time_in_which_nobody_wants_anything_is_not_planned() -> None:
    found = figures(work(0, 0, 50), work(900, 900, 950))
    assert found.planned_s == 100.0 and found.availability == 1.0


def test_a_task_that_waits_plans_time_though_none_is_at_work() -> None:
    found = figures(work(0, 0, 50), work(100, None, None, "queued"))
    assert found.planned_s == 950.0 and found.worked_s == 50.0


def test_a_cell_that_is_held_still_is_down_until_now() -> None:
    found = figures(work(0, 0, None, "running"), downs=((100.0, None),))
    assert (found.planned_s, found.worked_s, found.missing) == (1000.0, 100.0, NOTHING_ENDED())


def test_a_plant_that_was_ended_in_peace_is_not_down_though_tasks_wait() -> None:
    ran = (PlantRun(since_s=0.0, seen_s=200.0, ended=True), PlantRun(since_s=900.0, seen_s=NOW, ended=False))
    found = figures(work(0, 0, 200), work(100, 900, 950), runs=ran)
    assert found.planned_s == 250.0 and found.worked_s == 250.0


def test_a_plant_that_was_killed_is_down_while_a_task_waits_or_was_at_work() -> None:
    ran = (PlantRun(since_s=0.0, seen_s=200.0, ended=False), PlantRun(since_s=900.0, seen_s=NOW, ended=False))
    found = figures(work(100, 100, 950), runs=ran)
    assert found.planned_s == 850.0 and found.worked_s == 150.0


@pytest.mark.parametrize(("late_s", "worked_s"), [(LATE_S, NOW), (LATE_S + 1, NOW - LATE_S - 1)])
def test_a_plant_that_has_not_been_seen_for_long_does_not_run(late_s: float, worked_s: float) -> None:
    ran = (PlantRun(since_s=0.0, seen_s=NOW - late_s, ended=False),)
    assert figures(work(0, 0, None, "running"), runs=ran).worked_s == worked_s


def test_of_a_time_before_anything_was_kept_nothing_is_said() -> None:
    ran = (PlantRun(since_s=600.0, seen_s=NOW, ended=False),)
    found = figures(work(500, 500, 560), work(590, 590, 700), runs=ran)
    assert (found.since_s, found.planned_s, found.done) == (600.0, 100.0, 1)


def test_a_task_counts_when_it_ended_and_its_time_whole() -> None:
    """It began before the time that is asked for: of that time, half of its work; of its pace, all of it."""
    found = figures(work(0, 0, 100), since=50.0)
    assert (found.planned_s, found.performance, found.done) == (50.0, 0.5, 1)


def test_a_task_that_was_cancelled_is_neither_good_nor_bad() -> None:
    found = figures(work(0, 0, 50), work(50, 50, 70, "cancelled"), work(70, None, 80, "cancelled"))
    assert (found.done, found.failed, found.quality, found.performance) == (1, 0, 1.0, 1.0)


def test_a_task_that_failed_before_it_began_was_not_made() -> None:
    found = figures(work(0, None, 50, "failed"))
    assert (found.failed, found.quality) == (0, None)


def test_more_than_all_of_it_is_not_cut_off() -> None:
    found = figures(work(0, 0, 10, "failed"), best=50.0)
    assert found.performance == 5.0 and found.quality == 0.0 and found.oee == 0.0


@pytest.mark.parametrize(
    ("found", "missing"),
    [
        (figures(runs=()), NEVER_RAN()),
        (figures(), NO_PLAN()),
        (figures(work(0, 0, None, "running")), NOTHING_ENDED()),
        (figures(work(0, 0, 50), best=None), FEW_TIMES(known=0, all=1, times=3)),
    ],
)
def test_what_nobody_can_say_says_why(found: Oee, missing: object) -> None:
    assert (found.oee, found.missing) == (None, missing)


def test_an_order_that_was_seldom_done_has_no_shortest_time() -> None:
    twice = {("a", "a 1"): Shortest(times=2, seconds=50.0)}
    found = oee("a", PastTimes(works=[work(0, 0, 50)], runs=[ALL_DAY], downs=[], shortest=twice), 0.0, NOW)
    assert (found.performance, found.timed, found.quality) == (None, 0, 1.0)


def test_performance_is_of_those_that_can_be_compared_if_they_are_half_of_all() -> None:
    other = PastTask(cell="a", order="a 2", state="done", accepted_s=0, started_s=100, ended_s=300)
    assert figures(work(0, 0, 100), other).performance == 0.5
    assert figures(work(0, 0, 100), other, other).performance is None


def test_another_cell_has_no_part_in_it() -> None:
    other = PastTask(cell="b", order="a 1", state="failed", accepted_s=0, started_s=0, ended_s=300)
    assert figures(work(0, 0, 50), other) == figures(work(0, 0, 50))


spans = st.lists(
    st.tuples(st.integers(0, 20), st.integers(0, 20)).map(lambda span: (float(span[0]), float(span[1])))
)


def seconds(some: list[tuple[float, float]]) -> set[int]:
    return {second for since, until in some for second in range(int(since), int(until))}


@given(spans, spans)
def test_times_are_joined_shared_and_taken_away_as_sets_of_seconds(
    one: list[tuple[float, float]], other: list[tuple[float, float]]
) -> None:
    ours, theirs = joined(one), joined(other)
    assert seconds(ours) == seconds(one) and length(ours) == len(seconds(one))
    assert seconds(common(ours, theirs)) == seconds(one) & seconds(other)
    assert seconds(without(ours, theirs)) == seconds(one) - seconds(other)
