"""People who do what a file says."""

from __future__ import annotations

from typing import Any

import pytest

from arboleda.testing import shipped
from arboleda_proofs.simulator.checks import BadFaults
from arboleda_proofs.simulator.faults import Fault
from arboleda_proofs.simulator.run import Result, Simulation
from arboleda_proofs.simulator.scripted_people import script_from

MODEL = shipped("sis_a")
TASK = {"at": 2.0, "task": "sis_a 0B 7 #lot"}


def run(people: list[dict[str, Any]], *faults: Fault, **more: Any) -> Result:
    script = script_from(MODEL, {"people": people, **more})
    plan = {0: faults}
    simulation = Simulation(MODEL, 1, lambda minute: plan.get(minute, ()), keep=True, script=script)
    return simulation.run(cycles=50)


def said(result: Result, who: str) -> list[tuple[float, str]]:
    found = [line.split(None, 2) for line in result.lines]
    return [(float(at), what) for at, by, what in found if by == who]


def test_nobody_else_asks_for_anything() -> None:
    result = run([TASK])
    assert result.broken is None and result.outcomes == {"done": 1} and result.cycles == 1
    assert said(result, "asked") == [(2.0, "'sis_a 0B 7 #lot'")]


def test_operators_do_what_is_told_at_its_time() -> None:
    people = [
        TASK,
        {"at": 6.0, "do": "hold sis_a"},
        {"at": 9.0, "do": "resume sis_a"},
        {"at": 10.0, "do": "cancel lot"},
        {"at": 40.0, "do": "home ra1 --by-hand"},
    ]
    result = run(people, seconds=45)
    assert result.broken is None and result.outcomes == {"cancelled": 1}
    whats = [(6.0, "hold sis_a"), (9.0, "resume sis_a"), (10.0, "cancel lot")]
    assert said(result, "asked")[1:4] == whats
    assert (40.0, "home ra1 by hand") in said(result, "asked")


def test_an_attendant_comes_after_the_time_that_is_told() -> None:
    result = run([TASK, {"at": 6.0, "do": "stop"}], seconds=30)
    assert result.broken is None and result.outcomes == {"stopped": 1}
    assert said(result, "asked")[2][0] > 30.0


def test_without_a_time_an_attendant_comes_after_the_last_act() -> None:
    result = run([TASK, {"at": 6.0, "do": "stop"}])
    assert result.broken is None and 6.0 < said(result, "asked")[2][0] < 13.0


@pytest.mark.parametrize(
    ("data", "place", "words"),
    [
        ({"people": {}}, ("people",), "people is not a list, e.g. "),
        ({"people": [3]}, ("people", 0), "what somebody does is not a mapping; its keys are at, task, do"),
        ({"people": [{"task": "sis_a 0B 7"}]}, ("people", 0, "at"), "at is in s since the run began"),
        ({"people": [{**TASK, "at": -1}]}, ("people", 0, "at"), "0 or more"),
        ({"people": [TASK, {"at": 3}]}, ("people", 1), "task or do"),
        ({"people": [{**TASK, "do": "stop"}]}, ("people", 0), "task or do"),
        ({"people": [{"at": 3, "do": 7}]}, ("people", 0, "do"), "do is 7; a text is needed"),
        ({"people": [{"at": 3, "task": "sis_a 0B 70"}]}, ("people", 0, "task"), "'70' is not a station"),
        ({"people": [{"at": 3, "do": "halt"}]}, ("people", 0, "do"), "'halt' is nothing that operators do"),
        ({"people": [{"at": 3, "do": ""}]}, ("people", 0, "do"), "'' is nothing that operators do"),
        (
            {"people": [TASK, {"at": 3, "do": "cancel lott"}]},
            ("people", 1, "do"),
            "'lott' is nothing of this plant, and no task of the file; there are sis_a, ra1, rm_sis_a",
        ),
        ({"people": [TASK], "seconds": "long"}, ("seconds",), "seconds is how long"),
    ],
)
def test_a_bad_script_is_refused_with_its_place(data: Any, place: tuple[Any, ...], words: str) -> None:
    with pytest.raises(BadFaults) as refused:
        script_from(MODEL, data)
    assert refused.value.place == place and words in str(refused.value)
