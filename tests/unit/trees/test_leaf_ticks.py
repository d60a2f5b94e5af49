"""Our leaves are ticked as py_trees ticks its own: what is called, in which order, and which status stays."""

from __future__ import annotations

from itertools import product
from typing import Any

import pytest
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from arboleda.trees.leaves import Leaf

STATUSES: list[Any] = [*Status, None]


class Calls(Behaviour):
    """Notes what is called while it returns one status after the other."""

    def __init__(self, returns: tuple[Any, ...]) -> None:
        super().__init__("calls")
        self.returns = iter(returns)
        self.seen: list[Any] = []

    def initialise(self) -> None:
        self.seen.append(("initialise", self.status))

    def update(self) -> Status:
        self.seen.append(("update", self.status))
        return next(self.returns)

    def terminate(self, new_status: Status) -> None:
        self.seen.append(("terminate", self.status, new_status))


class OurCalls(Leaf, Calls):
    """The same, ticked as our leaves are."""

    def __init__(self, returns: tuple[Any, ...]) -> None:
        Calls.__init__(self, returns)


def _ticked(leaf: Calls) -> list[Any]:
    for _ in range(3):
        leaf.seen.append(("nodes", [node is leaf for node in leaf.tick()], leaf.status))
    leaf.stop(Status.INVALID)
    return [*leaf.seen, leaf.status]


@pytest.mark.parametrize("returns", list(product(STATUSES, repeat=3)), ids=str)
def test_a_leaf_is_ticked_and_stopped_as_py_trees_does_it(returns: tuple[Any, ...]) -> None:
    assert _ticked(OurCalls(returns)) == _ticked(Calls(returns))


def test_what_is_raised_leaves_the_status_as_py_trees_does() -> None:
    for kind in (Calls, OurCalls):
        leaf = kind((Status.RUNNING,))
        leaf.tick_once()
        with pytest.raises(RuntimeError):
            leaf.tick_once()
        assert leaf.status is Status.RUNNING
