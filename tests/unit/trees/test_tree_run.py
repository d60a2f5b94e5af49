"""How often a tree is ticked until it rests: once where another tick could change nothing; and its end."""

from __future__ import annotations

import gc
import weakref
from functools import partial
from types import SimpleNamespace
from typing import Any

import pytest
from py_trees.behaviour import Behaviour
from py_trees.common import ParallelPolicy, Status
from py_trees.composites import Parallel, Selector, Sequence

from arboleda.model.messages import Failure, Reason
from arboleda.model.plant_model import Retry
from arboleda.trees.cell_time import CellTime
from arboleda.trees.failures import Failures
from arboleda.trees.leaves import Act
from arboleda.trees.tree_run import TICK_BOUND, TreeRun


class Known(Behaviour):
    """A condition that counts how often it is asked."""

    def __init__(self, status: Status = Status.SUCCESS) -> None:
        super().__init__("known")
        self.status_then = status
        self.asked = 0

    def update(self) -> Status:
        self.asked += 1
        return self.status_then


class Commands:
    """Commands of a cell whose robot never ends them."""

    sent = 0

    def send(self, *_: Any, **__: Any) -> Any:
        self.sent += 1
        return SimpleNamespace(open=True, was_sent=True, too_early=False, failure=None)


def run_of(make: Any) -> tuple[TreeRun, Behaviour]:
    context: Any = SimpleNamespace(
        time=SimpleNamespace(now=0.0),
        commands=Commands(),
        failures=SimpleNamespace(opened_effector=lambda: None),
        timing=SimpleNamespace(stop_timeout_s=5.0),
    )
    tree = make(Act("move", context, lambda: None, "moving"))
    run, ticks = TreeRun(context), []
    tick_once = tree.tick_once
    tree.tick_once = lambda: (ticks.append(1), tick_once())
    tree.ticks = ticks
    return run, tree


def ticks_of(make: Any) -> int:
    run, tree = run_of(make)
    assert run.begin(lambda: tree) is Status.RUNNING
    return len(tree.ticks)  # type: ignore[attr-defined]


def test_a_tree_whose_only_step_under_way_is_a_command_is_ticked_once() -> None:
    assert ticks_of(lambda act: Sequence("a", memory=True, children=[Known(), act])) == 1
    assert ticks_of(lambda act: Selector("a", memory=True, children=[act, Known()])) == 1


@pytest.mark.parametrize(
    "make",
    [
        lambda act: Sequence("a", memory=False, children=[Known(), act]),
        lambda act: Selector("a", memory=False, children=[Known(Status.FAILURE), act]),
        lambda act: Selector("a", memory=True, children=[Known(Status.FAILURE), act]),
        lambda act: Parallel("a", policy=ParallelPolicy.SuccessOnAll(), children=[Known(), act]),
    ],
)
def test_a_tree_that_asks_others_once_more_is_ticked_until_it_rests(make: Any) -> None:
    assert ticks_of(make) > 1


class Refused:
    """Commands of a cell whose robot was lost: none leaves."""

    sent = 0

    def send(self, *_: Any, **__: Any) -> Any:
        self.sent += 1
        lost = Failure(reason=Reason.LINK_LOST, sentence="it is lost")
        return SimpleNamespace(open=False, was_sent=False, too_early=False, failure=lost, state=None)

    def cancel_all(self) -> None:
        """Nothing is open."""


def test_tries_that_take_no_time_are_not_all_at_one_instant() -> None:
    """However many steps there are, each with as many tries as a plant file may allow, without a pause."""
    clock = SimpleNamespace(now=0.0)
    failures = Failures(SimpleNamespace(carrier=None, opened_by=None))  # type: ignore[arg-type]
    context: Any = SimpleNamespace(
        cell=SimpleNamespace(name="cell", retry=Retry(times=10, backoff_s=0.0)),
        time=CellTime(clock),
        commands=Refused(),
        failures=failures,
        timing=SimpleNamespace(stop_timeout_s=5.0),
    )
    acts = [Act(f"move {n}", context, lambda: None, "moving") for n in range(TICK_BOUND + 1)]
    run = TreeRun(context)
    status = run.begin(lambda: Selector("one of them", memory=True, children=[*acts]))
    while status is Status.RUNNING:
        clock.now = context.time.next_deadline
        assert context.time.woken()
        status = run.tick()
    assert failures.last is not None and failures.last.reason is Reason.LINK_LOST
    assert context.commands.sent == len(acts) * 11


def test_a_tree_that_has_ended_is_given_back_without_a_collection_of_garbage() -> None:
    context: Any = SimpleNamespace(time=SimpleNamespace(now=0.0), commands=Refused())
    run = TreeRun(context)
    ways = Selector("ways", memory=False, children=[Known()])
    run.begin(partial(Sequence, "work", memory=True, children=[ways]))
    nodes = [weakref.ref(node) for node in run.nodes]
    del ways
    gc.disable()
    try:
        run.drop()
        assert None not in [node() for node in nodes]
        run.take_apart()
        assert [node() for node in nodes] == [None] * 3
    finally:
        gc.enable()
