"""Which step the success of another one leads to, and through which leaves."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from py_trees.behaviour import Behaviour
from py_trees.behaviours import Success
from py_trees.common import ParallelPolicy
from py_trees.composites import Parallel, Selector, Sequence
from py_trees.decorators import Inverter

from arboleda.model.step_token import StepToken, hash_of
from arboleda.resume.succession import steps_between
from arboleda.trees.leaves import Act, Carry, Dwell, Note, TakeZones

CONTEXT: Any = SimpleNamespace(
    time=None, failures=None, zones=None, cell=SimpleNamespace(zone_wait_s=1.0), timing=None
)


def act(name: str) -> Act:
    return Act(name, CONTEXT, lambda id: None, name)  # type: ignore[arg-type, return-value]


def dwell() -> Dwell:
    return Dwell("dwell", CONTEXT.time, 0.5)


def in_order(*children: Behaviour) -> Sequence:
    return Sequence("in order", memory=True, children=list(children))


def test_the_leaves_between_two_commands_are_those_that_command_and_take_nothing() -> None:
    first, last = act("first"), act("last")
    passed = [dwell(), Carry("carry", None, None), Note("note", lambda: None)]  # type: ignore[arg-type]
    in_order(in_order(first, passed[0]), passed[1], in_order(passed[2], last))
    assert steps_between(first, last) == passed
    assert steps_between(last, first) is None


def test_a_wait_leads_to_the_command_after_it() -> None:
    wait, last = dwell(), act("last")
    in_order(wait, Selector("tries", memory=True, children=[in_order(last), act("again")]))
    assert steps_between(wait, last) == []


@pytest.mark.parametrize(
    "between",
    [
        lambda: act("another"),
        lambda: TakeZones("take", CONTEXT, "ra1", frozenset),
        lambda: Inverter("not", dwell()),
        lambda: Sequence("asked again", memory=False, children=[dwell()]),
        lambda: Success("of somebody"),
    ],
    ids=["a command", "zones", "a decorator", "without memory", "an unknown leaf"],
)
def test_anything_else_between_them_leaves_it_open(between: Any) -> None:
    first, last = act("first"), act("last")
    in_order(first, between(), last)
    assert steps_between(first, last) is None


def test_what_an_alternative_may_lead_to_as_well_is_not_certain() -> None:
    first, last = act("first"), act("last")
    in_order(Selector("tries", memory=True, children=[first, act("instead")]), last)
    assert steps_between(first, last) is None
    only, after = act("only"), act("after")
    in_order(Selector("tries", memory=True, children=[act("tried"), only]), after)
    assert steps_between(only, after) == []


def test_of_two_at_once_neither_leads_to_the_other() -> None:
    first, last = act("first"), act("last")
    Parallel("at once", policy=ParallelPolicy.SuccessOnAll(), children=[first, last])
    assert steps_between(first, last) is None


def test_a_token_is_read_as_it_was_written() -> None:
    assert StepToken.read(f"{hash_of('lot-1')}001a03") == StepToken(hash_of("lot-1"), 0x1A, 3)
    assert hash_of("lot-1") != hash_of("lot-2")


@pytest.mark.parametrize("text", ["", "of_my_own", "0a3f9x001a03", "0A3F97001A03", "0a3f97001a031"])
def test_what_no_plant_of_this_version_gave_is_no_token(text: str) -> None:
    assert StepToken.read(text) is None
