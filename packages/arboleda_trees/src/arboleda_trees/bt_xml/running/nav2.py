"""Control nodes of Nav2."""

from __future__ import annotations

import math
from collections.abc import Sequence

from py_trees.common import Status

from .node import FAILURE, RUNNING, SKIPPED, SUCCESS, Node, Result
from .ports import NodePorts

AT = "current_child_idx"


class RecoveryNode(Node):
    """Node that runs its first child; if it fails, the second child and then the first again, so many times.

    A pause follows a round of several ticks that took no time: a tree may be ticked only so often at one
    instant.
    """

    counts = ("recovers", "retries")

    def __init__(self, name: str, children: Sequence[Node], ports: NodePorts) -> None:
        super().__init__(name, children)
        self.ports = ports
        self.recovers = False
        self.retries = 0
        self.round_began = -math.inf

    def reset_counts(self) -> None:
        self.recovers, self.retries = False, 0

    def work(self) -> Result:
        most = self.ports.number("number_of_retries", self.scope, "1")
        work, recovery = self.below
        self.begin()
        goes_on = any(child.status is Status.RUNNING for child in self.below)
        while self.retries <= most:
            if not self.recovers and work.status is Status.INVALID:
                self.round_began = self.time.now
            result = (recovery if self.recovers else work).execute()
            if result is RUNNING:
                return RUNNING
            if not self.recovers and (result is not FAILURE or self.retries >= most):
                return self._over(result)
            if not self.recovers:
                work.reset()
                self.recovers = True
            elif result is SUCCESS:
                recovery.reset()
                self.recovers, self.retries = False, self.retries + 1
                if goes_on and self.round_began == self.time.now:
                    return self.again()
            elif result is SKIPPED:  # no recovery is possible, so this is no retry
                recovery.reset()
                self.recovers = False
                return FAILURE
            else:
                return self._over(FAILURE)
        return self._over(FAILURE)

    def _over(self, result: Result) -> Result:
        self.forget()
        return result


class PipelineSequence(Node):
    """Sequence that ticks all children up to the running one at every tick, even if earlier ones run."""

    sign = "parallel"
    counts = ("last",)

    def __init__(self, name: str, children: Sequence[Node]) -> None:
        super().__init__(name, children)
        self.last = 0

    def reset_counts(self) -> None:
        self.last = 0

    def work(self) -> Result:
        skipped = 0
        for number, child in enumerate(self.below):
            result = child.execute()
            skipped += result is SKIPPED
            if result is FAILURE:
                return self._over(FAILURE)
            if result is RUNNING and number >= self.last:
                self.last = number
                return RUNNING
        return self._over(SKIPPED if skipped == len(self.below) else SUCCESS)

    def _over(self, result: Result) -> Result:
        self.reset_children()
        self.last = 0
        return result


class NonblockingSequence(Node):
    """Node that ticks all children at every tick, until all succeed in the same tick or one fails."""

    sign = "parallel"

    def work(self) -> Result:
        self.begin()
        is_done = True
        for child in self.below:
            result = child.execute()
            if result is FAILURE:
                self.reset_children()
                return FAILURE
            is_done = is_done and result is not RUNNING
        if not is_done:
            return RUNNING
        self.reset_children()
        return SUCCESS


class PersistentSequence(Node):
    """Sequence that keeps its place in a variable, also when it is halted."""

    sign = "sequence"

    def __init__(self, name: str, children: Sequence[Node], ports: NodePorts) -> None:
        super().__init__(name, children)
        self.ports = ports

    def work(self) -> Result:
        at = max(int(self.ports.number(AT, self.scope)), 0)
        variable = self.ports.variable(AT)
        self.begin()
        for child in self.below[at:]:
            result = child.execute()
            if result is RUNNING:
                return RUNNING
            at = 0 if result is FAILURE else at + 1
            self.scope.set(variable, at)
            if result is FAILURE:
                self.reset_children()
                return FAILURE
        self.reset_children()
        self.scope.set(variable, 0)
        return SUCCESS


class RoundRobin(Node):
    """Node that ticks the next child at each tick until one succeeds; it fails once all have failed."""

    counts = ("at", "failed")

    def __init__(self, name: str, children: Sequence[Node], ports: NodePorts) -> None:
        super().__init__(name, children)
        self.ports = ports
        self.at = self.failed = 0

    def reset_counts(self) -> None:
        self.at = self.failed = 0

    def work(self) -> Result:
        wraps = self.ports.is_set("wrap_around", self.scope, "false")
        self.begin()
        many, skipped = len(self.below), 0
        while self.failed + skipped < many and self.at < many:
            result = self.below[self.at].execute()
            if result is RUNNING:
                return RUNNING
            self.at += 1
            if self.at == many and wraps:
                self.at = 0
            if result is SUCCESS and self.at < many:
                self.failed = 0
                self.reset_children()
                return SUCCESS
            self.failed += result is FAILURE
            skipped += result is SKIPPED
        self.forget()
        return SKIPPED if skipped == many else FAILURE
