"""A question that a device answers with a number, and recipes that compare it."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest

from arboleda.kinds import KindError, Number, motion, query
from arboleda.kinds.authoring import Kind
from arboleda.kinds.declared import DeviceKind, DeviceVerb, Effect, FactType
from arboleda.kinds.ranges import apart, comparison
from arboleda.kinds.rules import INT, NUMBER
from arboleda.model.messages import Reason, TaskState
from arboleda.model.plant_model import Cell, PlantModel
from arboleda.recipes import Kit, recipe, work

from ...plants import device_of, kind_of, made
from .lab import Bench

GRAMS = FactType(type=float, first=0.0, lower=0.0, upper=500.0)
WAYS = ("left", "middle", "right")
GATE = kind_of(
    "gate",
    {"tilt": float, "at": ["away", *WAYS]},
    **{each: motion(sets={"at": each}, takes_s=1.0, at_most_s=3.0) for each in WAYS},
)


def line(recipe: Any, number: FactType = GRAMS) -> PlantModel:
    weigh = DeviceVerb(name="weigh", effect=Effect.QUERY, number=number, takes_s=0.5, at_most_s=2.0)
    scale = DeviceKind(name="scale", facts={}, verbs={"weigh": weigh})
    members = tuple((kind.name, device_of(kind)) for kind in (scale, GATE))
    return PlantModel(
        name="sorter", cells=(Cell(name="line", queue_limit=5, members=members, recipes=(recipe,)),)
    )


def sorting(*ways: str) -> Any:
    @recipe("sort")
    def sort(cell: Kit):  # type: ignore[no-untyped-def]
        weighed, gate = cell.device("scale").weigh(), cell.device("gate")
        goals = (gate.left(), gate.middle(), gate.right())
        return work(weighed, cell.choose(weighed, dict(zip(ways, goals, strict=False))))

    return sort


BY_WEIGHT = sorting("< 100", ">= 100 and <= 120", "> 120")


@pytest.mark.parametrize(
    ("grams", "goal"),
    [(0.0, "left"), (99.9, "left"), (100.0, "middle"), (120, "middle"), (120.1, "right"), (500.0, "right")],
)
def test_a_number_is_answered_by_the_way_of_its_range(grams: float, goal: str) -> None:
    here = Bench(line(BY_WEIGHT))
    here.machines["scale"].answer = lambda goal: grams
    here.submit("line sort")
    assert here.outcome().state is TaskState.DONE
    assert here.told == ["scale weigh", f"gate {goal}"]


def test_otherwise_is_the_way_of_all_numbers_without_another() -> None:
    here = Bench(line(sorting("> 120", "otherwise")))
    here.machines["scale"].answer = lambda goal: 120.0
    here.submit("line sort")
    assert here.outcome().state is TaskState.DONE
    assert here.told == ["scale weigh", "gate middle"]


LIMITED = FactType(type=int, first=0, upper=500, lower=0)
FROM_TO = "; it may answer {} from 0 to 500"


@pytest.mark.parametrize(
    ("said", "number", "why"),
    [
        ("heavy", GRAMS, FROM_TO.format("numbers")),
        (500.5, GRAMS, FROM_TO.format("numbers")),
        (True, GRAMS, FROM_TO.format("numbers")),
        (2.5, LIMITED, FROM_TO.format("whole numbers")),
        ("heavy", NUMBER, "; the recipe knows > 120, otherwise"),
    ],
)
def test_an_answer_that_the_kind_does_not_have_fails_the_task(said: Any, number: FactType, why: str) -> None:
    here = Bench(line(sorting("> 120", "otherwise"), number))
    here.machines["scale"].answer = lambda goal: said
    here.submit("line sort")
    ended = here.outcome()
    assert (ended.state, ended.reason, here.told) == (TaskState.FAILED, Reason.REJECTED, ["scale weigh"])
    assert str(ended.sentence) == f"scale weigh answered {str(said).lower()}{why}"


@pytest.mark.parametrize(
    ("ways", "number", "sentence"),
    [
        (("< 100", "> 100"), GRAMS, "choose has no way for 100, which scale weigh may answer; write a range"),
        (("> 100",), GRAMS, "choose has no way for 0, which"),
        (
            ("<= 100", ">= 100"),
            GRAMS,
            "choose has two ways for 100, '<= 100' and '>= 100'; write ranges that do",
        ),
        (
            ("<= 500", "> 500"),
            GRAMS,
            "choose has a way '> 500' that no number takes, as scale weigh answers a number from 0 to 500",
        ),
        (("< 100", ">= 100", "otherwise"), GRAMS, "choose has a way 'otherwise' that no number takes, as"),
        (("> 150 and < 120", "otherwise"), GRAMS, "choose has a way '> 150 and < 120' that no number takes"),
        (("> 3 and < 4", "<= 3", ">= 4"), INT, "choose has a way '> 3 and < 4' that no number takes"),
        (
            ("heavy", "otherwise"),
            GRAMS,
            "has a way for 'heavy', and scale weigh answers a number from 0 to 500; write",
        ),
        (("> 3 and > 4", "otherwise"), GRAMS, "choose has a way for '> 3 and > 4', and scale weigh answers"),
    ],
)
def test_ways_that_do_not_part_all_numbers_are_refused(
    ways: tuple[str, ...], number: FactType, sentence: str
) -> None:
    here = Bench(line(sorting(*ways), number))
    here.submit("line sort")
    assert sentence in str(here.outcome().sentence)
    assert here.told == []


def test_a_comparison_says_its_numbers() -> None:
    between = comparison(" >= 100  and < 1.5e2 ")
    assert between is not None and str(between) == ">= 100 and < 1.5e2"
    told = (99.9, 100, 149.9, 150.0, math.nan, math.inf, True, "120", None)
    assert [each for each in told if between.has(each)] == [100, 149.9]
    above = comparison(">-1")
    assert above is not None and not above.has(math.inf) and not above.has(-1) and above.has(0)
    assert [comparison(each) for each in ("120", "> x", "== 3", "", "> 1 or < 0")] == [None] * 5


def test_numbers_that_tell_ranges_apart_have_the_limits_and_one_between_each_two() -> None:
    ranges = [each for each in map(comparison, ("< 100", ">= 100 and <= 120")) if each is not None]
    assert apart(GRAMS, ranges) == (0.0, 50.0, 100.0, 110.0, 120.0, 310.0, 500.0)
    assert apart(NUMBER, ranges) == (0.0, 99.0, 100.0, 110.0, 120.0, 121.0)
    assert apart(INT, ranges[:1]) == (0, 99, 100, 101)
    assert apart(NUMBER, ()) == (0.0,)


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda gate: gate.says(at="> 3"), "at cannot be '> 3', as it is no number; a gate says away, left"),
        (lambda gate: gate.says(tlit="> 3"), "a gate has no fact 'tlit'"),
        (lambda gate: gate.becomes(tilt="> 3 and < 2", at_most_s=1), "tilt is never > 3 and < 2"),
    ],
)
def test_a_comparison_that_no_fact_can_meet_is_refused(make: Callable[[Any], Any], sentence: str) -> None:
    sort = made("sort", lambda cell: make(cell.device("gate")))
    here = Bench(line(sort))
    here.submit("line sort")
    assert sentence in str(here.outcome().sentence)


@pytest.mark.parametrize(("tilt", "state"), [(12.5, TaskState.DONE), (10.0, TaskState.FAILED)])
def test_a_fact_is_compared(tilt: float, state: TaskState) -> None:
    sort = made("sort", lambda cell: work(cell.device("gate").says(tilt="> 10"), cell.device("gate").left()))
    here = Bench(line(sort))
    here.machines["gate"].facts["tilt"] = tilt
    here.wait(1.0)
    here.submit("line sort")
    ended = here.outcome()
    assert ended.state is state
    if state is TaskState.FAILED:
        assert str(ended.sentence) == "gate says 10.0 of tilt; > 10 is needed"


def test_a_fact_is_waited_for_until_its_comparison_is_true() -> None:
    sort = made("sort", lambda cell: cell.device("gate").becomes(tilt=">= 10", at_most_s=5))
    here = Bench(line(sort))
    here.submit("line sort")
    here.wait(3.0)
    here.machines["gate"].facts["tilt"] = 10.0
    assert here.outcome().state is TaskState.DONE


def test_a_kind_in_python_answers_with_any_number_of_a_type() -> None:
    made = Kind(verbs={"weigh": query(answers=Number(5.0, 500.0)), "count": query(answers=int)}).declared
    weigh, count = made.verbs["weigh"], made.verbs["count"]
    assert weigh.number == FactType(type=float, first=5.0, lower=5.0, upper=500.0)
    assert (weigh.answers, count.number) == ((), INT)


def test_a_virtual_device_answers_a_number_of_the_type() -> None:
    with pytest.raises(
        KindError, match=r"virtual of weigh answers 7.0; its answers are a number from 0 to 5"
    ):
        Kind(verbs={"weigh": query(answers=Number(0.0, 5.0), virtual=lambda facts: 7.0)})
