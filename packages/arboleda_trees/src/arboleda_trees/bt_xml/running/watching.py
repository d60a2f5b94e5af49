"""Nodes that test whether a variable was set, or whether two values are equal."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from py_trees.common import Status

from .controls import same_number
from .decorators import status
from .leaves import Leaf
from .memory import Value
from .node import FAILURE, RUNNING, SUCCESS, Decorator, Node, Result
from .ports import NodePorts
from .scripts import is_true


class WasEntryUpdated(Leaf):
    """Leaf that succeeds if the variable was set since its last tick."""

    counts = ("seen",)

    def __init__(self, name: str, ports: NodePorts) -> None:
        super().__init__(name)
        self.variable = ports.variable("entry")
        self.seen = 0

    def work(self) -> Result:
        before, self.seen = self.seen, self.scope.watch(self.variable)
        return FAILURE if self.seen in (before, 0) else SUCCESS


class WhenUpdated(Decorator):
    """Decorator that runs its child if its variable was set since the last check; else `otherwise`."""

    counts = ("seen", "is_under_way")

    def __init__(self, name: str, child: Node, ports: NodePorts, otherwise: Result) -> None:
        super().__init__(name, [child])
        self.variable = ports.variable("entry")
        self.otherwise = otherwise
        self.seen = 0
        self.is_under_way = False

    def reset_counts(self) -> None:
        self.is_under_way = False

    def work(self) -> Result:
        if not self.is_under_way:
            before, self.seen = self.seen, self.scope.watch(self.variable)
            if self.seen in (before, 0):
                return self.otherwise
        result = self.child.execute()
        self.is_under_way = result is RUNNING
        return result


class BlackboardCheck(Decorator):
    """Decorator that runs its child while two values are equal, as version 3 has it."""

    def __init__(
        self, name: str, child: Node, ports: NodePorts, same: Callable[[Value, Value], bool]
    ) -> None:
        super().__init__(name, [child])
        self.ports = ports
        self.same = same

    def work(self) -> Result:
        self.begin()
        one, other = (self.ports.value_if_set(port, self.scope) for port in ("value_A", "value_B"))
        if one is not None and other is not None and self.same(one, other):
            return self.child.execute()
        self.child.reset()
        return status(self.ports.text("return_on_mismatch", self.scope, "FAILURE"))


SAME: Mapping[str, Callable[[Value, Value], bool]] = {
    "BlackboardCheckInt": same_number,
    "BlackboardCheckDouble": same_number,
    "BlackboardCheckBool": lambda one, other: is_true(one) is is_true(other),
    "BlackboardCheckString": lambda one, other: str(one) == str(other),
}


class SingleTrigger(Decorator):
    """Decorator that runs its child until it has ended once; it fails from then on, until it is reset."""

    counts = ("has_ended",)

    def __init__(self, name: str, child: Node, ports: NodePorts) -> None:
        super().__init__(name, [child])
        self.has_ended = False

    def reset_counts(self) -> None:
        self.has_ended = False

    def work(self) -> Result:
        if self.begin():
            self.has_ended = False
        if self.has_ended:
            return FAILURE
        result = self.child.execute()
        self.has_ended = result in (SUCCESS, FAILURE)
        return result


class GoalUpdatedController(Decorator):
    """Decorator that runs its child when it begins, and again whenever `goal` or `goals` has changed."""

    counts = ("goals", "is_new")

    def __init__(self, name: str, child: Node, ports: NodePorts) -> None:
        super().__init__(name, [child])
        self.ports = ports
        self.goals: list[Value | None] = []
        self.is_new = False

    def work(self) -> Result:
        goals = [self.ports.value_if_set(port, self.scope) for port in ("goal", "goals")]
        if self.begin() or goals != self.goals:
            self.goals, self.is_new = goals, True
        if self.child.status is Status.RUNNING or self.is_new:
            self.is_new = False
            return self.child.execute()
        return RUNNING
