"""Control nodes with several children: in order, at once, by a condition."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from py_trees.common import Status

from .memory import Scope
from .node import ENDED, FAILURE, PAUSE_S, RUNNING, SKIPPED, SUCCESS, Node, Result
from .ports import THRESHOLD, NodePorts
from .scripts import ScriptError


class OrderedControl(Node):
    """Node that runs one child after the other until one ends as `stops` says; a tick continues in place."""

    counts = ("at", "skipped")
    stops: ClassVar[Result]
    ends: ClassVar[Result]
    pauses: ClassVar[bool] = False  # between two children, where the first took no time

    def __init__(self, name: str, children: Sequence[Node]) -> None:
        super().__init__(name, children)
        self.at = self.skipped = 0

    def reset_counts(self) -> None:
        self.at = self.skipped = 0

    def work(self) -> Result:
        if self.begin():
            self.skipped = 0
        while self.at < len(self.below):
            child = self.below[self.at]
            was_idle = child.status is Status.INVALID
            result = child.execute()
            if result is RUNNING:
                return RUNNING
            if result is self.stops:
                return self.stopped()
            self.at += 1
            if result is SKIPPED:
                self.skipped += 1
            elif self.pauses and was_idle and self.at < len(self.below):
                return self.again()
        all_skipped = self.skipped == len(self.below)
        self.reset_children()
        self.at = self.skipped = 0
        return SKIPPED if all_skipped else self.ends

    def stopped(self) -> Result:
        """The result once a child has ended as `stops` says; the children begin anew."""
        self.reset_children()
        self.at = 0
        return self.stops


class InSequence(OrderedControl):
    """BehaviorTree.CPP's Sequence."""

    sign = "sequence"
    stops, ends = FAILURE, SUCCESS


class InFallback(OrderedControl):
    """BehaviorTree.CPP's Fallback."""

    sign = "selector"
    stops, ends = SUCCESS, FAILURE


class AsyncSequence(InSequence):
    """Sequence that returns RUNNING between two children, so that others can look."""

    pauses = True


class AsyncFallback(InFallback):
    """Fallback that returns RUNNING between two children, so that others can look."""

    pauses = True


class SequenceWithMemory(InSequence):
    """Sequence that continues with the child that failed, even after being halted."""

    pauses = True

    def reset_counts(self) -> None:
        """Does nothing: this sequence keeps its place when it is halted."""

    def stopped(self) -> Result:
        for child in self.below[self.at :]:
            child.reset()
        return FAILURE


class TryCatch(Node):
    """Sequence of all children but the last; if one fails, the last one is ticked, and the node fails."""

    sign = "sequence"
    counts = ("at", "skipped", "catches")

    def __init__(self, name: str, children: Sequence[Node]) -> None:
        super().__init__(name, children)
        self.reset_counts()

    def reset_counts(self) -> None:
        self.at = self.skipped = 0
        self.catches = False

    def work(self) -> Result:
        if self.begin():
            self.skipped, self.catches = 0, False
        *tried, caught = self.below
        while not self.catches and self.at < len(tried):
            result = tried[self.at].execute()
            if result is RUNNING:
                return RUNNING
            if result is FAILURE:
                self.reset_children()
                self.at, self.catches = 0, True
                self.caught()
            else:
                self.at += 1
                self.skipped += result is SKIPPED
        if self.catches and caught.execute() is RUNNING:
            return RUNNING
        if self.catches:
            self.rescued()
        all_skipped, failed = self.skipped == len(tried), self.catches
        self.reset_children()
        self.reset_counts()
        return FAILURE if failed else SKIPPED if all_skipped else SUCCESS

    def caught(self) -> None:
        """Called when a child has failed, before the last one begins."""

    def rescued(self) -> None:
        """Called when the last child has ended."""


class Reactive(Node):
    """Node that ticks all children from the first at every tick, until one runs or ends as `stops` says."""

    is_limit = True
    stops: ClassVar[Result]
    ends: ClassVar[Result]

    def work(self) -> Result:
        self.begin()
        all_skipped = True
        for child in self.below:
            result = child.execute()
            all_skipped = all_skipped and result is SKIPPED
            if result is RUNNING:
                for other in self.below:
                    if other is not child:
                        other.reset()
                return RUNNING
            if result is self.stops:
                self.reset_children()
                return self.stops
            if result is SKIPPED:
                child.reset()
        self.reset_children()
        return SKIPPED if all_skipped else self.ends


class ReactiveSequence(Reactive):
    """BehaviorTree.CPP's ReactiveSequence."""

    sign = "sequence"
    stops, ends = FAILURE, SUCCESS


class ReactiveFallback(Reactive):
    """BehaviorTree.CPP's ReactiveFallback."""

    sign = "selector"
    stops, ends = SUCCESS, FAILURE


def _threshold(ports: NodePorts, port: str, number: float, many: int) -> int:
    """The number of children that a threshold means; a negative number counts down from all children.

    BehaviorTree.CPP refuses a threshold that cannot be reached, even where the node would end.
    """
    if number > many:
        raise ScriptError(THRESHOLD(port=port, node=ports.node, number=int(number), many=many))
    return max(many + int(number) + 1, 0) if number < 0 else int(number)


class Parallel(Node):
    """Node that runs all children at once; it succeeds or fails once enough of them have."""

    is_limit = True
    sign = "parallel"
    counts = ("ended", "done", "failed")

    def __init__(self, name: str, children: Sequence[Node], ports: NodePorts) -> None:
        super().__init__(name, children)
        self.ports = ports
        self.ended: list[int] = []
        self.done = self.failed = 0

    def reset_counts(self) -> None:
        self.ended = []
        self.done = self.failed = 0

    def needs_all(self, scope: Scope) -> bool:
        """True if the node succeeds only where all children do."""
        many = len(self.below)
        return _threshold(self.ports, "success_count", self._success(scope), many) == many

    def _success(self, scope: Scope) -> float:
        return self.ports.number("success_count", scope, self._old("success_threshold", "-1"))

    def work(self) -> Result:
        success = self._success(self.scope)
        failure = self.ports.number("failure_count", self.scope, self._old("failure_threshold", "1"))
        many = len(self.below)
        enough = _threshold(self.ports, "success_count", success, many)
        too_many = _threshold(self.ports, "failure_count", failure, many)
        self.begin()
        skipped = 0
        for number, child in enumerate(self.below):
            if number not in self.ended:
                result = child.execute()
                skipped += result is SKIPPED
                if result in ENDED:
                    self.ended = [*self.ended, number]
                    self.done += result is SUCCESS
                    self.failed += result is FAILURE
            if self.done >= enough or (success < 0 and self.done + skipped >= enough):
                return self._over(SUCCESS)
            if many - self.failed < enough or self.failed == too_many:
                return self._over(FAILURE)
        if skipped == many:
            return SKIPPED
        if any(child.status is Status.RUNNING for child in self.below):
            return RUNNING
        self.time.wake_at(self.time.now + PAUSE_S)  # skipped children are ticked again
        return RUNNING

    def _old(self, name: str, default: str) -> str:
        """The value of the port by its name in version 3, or the default."""
        return self.ports.texts.get(
            name, self.ports.texts.get("threshold", default) if "succ" in name else default
        )

    def _over(self, result: Result) -> Result:
        self.reset_counts()
        self.reset_children()
        return result


class ParallelAll(Node):
    """Node that runs all children at once until each has ended; it fails if too many have."""

    is_limit = True
    sign = "parallel"
    counts = ("ended", "failed")

    def __init__(self, name: str, children: Sequence[Node], ports: NodePorts) -> None:
        super().__init__(name, children)
        self.ports = ports
        self.ended: list[int] = []
        self.failed = 0

    def reset_counts(self) -> None:
        self.ended = []
        self.failed = 0

    def needs_all(self, scope: Scope) -> bool:
        """True if the node succeeds only where all children do."""
        most = self.ports.number("max_failures", scope, "1")
        return _threshold(self.ports, "max_failures", most, len(self.below)) <= 1

    def work(self) -> Result:
        many = len(self.below)
        most = self.ports.number("max_failures", self.scope, "1")
        too_many = _threshold(self.ports, "max_failures", most, many)
        self.begin()
        skipped = 0
        for number, child in enumerate(self.below):
            if number in self.ended:
                continue
            result = child.execute()
            skipped += result is SKIPPED
            if result in ENDED:
                self.ended = [*self.ended, number]
                self.failed += result is FAILURE
        if skipped == many:
            return SKIPPED
        if skipped + len(self.ended) < many:
            return RUNNING
        result = FAILURE if self.failed >= too_many else SUCCESS
        self.reset_children()
        self.reset_counts()
        return result


class IfThenElse(Node):
    """Node whose first child decides once which of the others is ticked."""

    counts = ("at",)

    def __init__(self, name: str, children: Sequence[Node]) -> None:
        super().__init__(name, children)
        self.at = 0

    def reset_counts(self) -> None:
        self.at = 0

    def work(self) -> Result:
        self.begin()
        if self.at == 0:
            result = self.below[0].execute()
            if result is RUNNING:
                return RUNNING
            if result is FAILURE and len(self.below) < 3:
                return FAILURE
            if result is SKIPPED:  # BehaviorTree.CPP raises an error here
                self.below[0].reset()
                return SKIPPED
            self.at = 1 if result is SUCCESS else 2
        result = self.below[self.at].execute()
        if result is not RUNNING:
            self.reset_children()
            self.at = 0
        return result


class WhileDoElse(Node):
    """Node whose first child decides at every tick which of the others is ticked."""

    is_limit = True

    def work(self) -> Result:
        self.begin()
        condition = self.below[0].execute()
        if condition is RUNNING:
            return RUNNING
        result = SKIPPED  # of a skipped condition; BehaviorTree.CPP raises an error there
        if condition is SUCCESS:
            if len(self.below) > 2:
                self.below[2].reset()
            result = self.below[1].execute()
        elif condition is FAILURE and len(self.below) > 2:
            self.below[1].reset()
            result = self.below[2].execute()
        elif condition is FAILURE:
            result = FAILURE
        if result is not RUNNING:
            self.reset_children()
        return result


class Switch(Node):
    """Node that ticks the child of the case that a variable has; the last child if no case matches."""

    counts = ("ran",)

    def __init__(self, name: str, children: Sequence[Node], ports: NodePorts) -> None:
        super().__init__(name, children)
        self.ports = ports
        self.ran: int | None = None

    def reset_counts(self) -> None:
        self.ran = None

    def work(self) -> Result:
        chosen = self.chosen(self.scope)
        if self.ran is not None and self.ran != chosen:
            self.below[self.ran].reset()
        result = self.below[chosen].execute()
        if result is SKIPPED:
            self.ran = None
        elif result is RUNNING:
            self.ran = chosen
        else:
            self.reset_children()
            self.ran = None
        return result

    def chosen(self, scope: Scope) -> int:
        """The number of the child that the present value of the variable means."""
        variable = self.ports.value_if_set("variable", scope)
        for number in range(len(self.below) - 1):
            case = self.ports.text(f"case_{number + 1}", scope)
            if str(case) == str(variable) or same_number(case, variable):
                return number
        return len(self.below) - 1


def same_number(one: object, other: object) -> bool:
    """True if both are numbers, and equal."""
    try:
        return float(str(one)) == float(str(other))
    except ValueError:
        return False
