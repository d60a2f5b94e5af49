"""How often a tree is ticked until it rests: once where another tick could change nothing."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from py_trees.behaviour import Behaviour
from py_trees.common import ParallelPolicy, Status
from py_trees.composites import Parallel, Selector, Sequence

from arboleda.trees.leaves import Act
from arboleda.trees.tree_run import TreeRun


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
        return SimpleNamespace(open=True, left=True, too_early=False, failure=None)


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
