"""Nodes written in Python: steps around the nodes below them, and functions of values."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from arboleda.engine import Failures
from arboleda.model.messages import Failure
from arboleda.recipes import WrittenNode

from .device_steps import Order, as_variable
from .leaves import Leaf
from .node import FAILURE, SUCCESS, Node, Result
from .root import generic


class WrapperNode(Node):
    """Node below a step in Python; the step reads the cause of the node's failure from `failures`."""

    frame = True

    def __init__(self, child: Node, failures: Failures, causes: list[Failure]) -> None:
        super().__init__(child.name, [child])
        self.failures = failures
        self.causes = causes

    def tick(self) -> Iterator[Behaviour]:
        if self.status is not Status.RUNNING:
            self.reset_children()
        yield from super().tick()

    def work(self) -> Result:
        self.begin()
        result = self.below[0].execute()
        if result is FAILURE and self.failures.first is None:
            self.failures.add(self.causes[0] if self.causes else generic(self.name, self.blamed), self)
        return result


class FunctionNode(Leaf):
    """Leaf that calls a function of values at each tick; an exception in the function ends the tree."""

    def __init__(self, name: str, written: WrittenNode, order: Order, outs: Mapping[str, str]) -> None:
        super().__init__(name)
        self.written = written
        self.order = order
        self.outs = outs  # by the name of a value that the function gives: its variable

    def work(self) -> Result:
        results = self.written.calculate(self.order.values(self.scope))
        if results is None:
            return FAILURE
        for name, variable in self.outs.items():
            self.scope.set(variable, as_variable(results[name]))
        return SUCCESS
