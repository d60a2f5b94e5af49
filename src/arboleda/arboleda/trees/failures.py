"""Failures of the task that runs: their causes, as leaves name them."""

from __future__ import annotations

from py_trees.behaviour import Behaviour

from arboleda.model.messages import Failure, Reason

from .parts import Parts


class Failures:
    """Causes for which a tree fails: the `first` one counts, named by `leaf`; `last` is the latest one."""

    def __init__(self, parts: Parts) -> None:
        self.first: Failure | None = None
        self.leaf: Behaviour | None = None
        self.last: Failure | None = None
        self._parts = parts

    def add(self, failure: Failure, leaf: Behaviour | None = None) -> None:
        """Name the cause of a failure. What was carried is now for recovery."""
        if self.first is None:
            self.first, self.leaf = failure, leaf
        self.last = failure
        self._parts.carrier = None

    def forgive(self) -> None:
        """Forget a failure that the recipe has an answer to: the task goes on."""
        self.first = self.leaf = None

    def bring_back(self, failure: Failure, leaf: Behaviour | None = None) -> None:
        """Name again the cause of a failure that came before all others, and was put aside for a while."""
        self.first, self.leaf = failure, leaf

    def clear(self) -> None:
        """Forget all failures of the last tree."""
        self.first = self.leaf = self.last = None

    def opened_effector(self) -> Failure | None:
        """The loss of a part by an effector that opened unbidden, where nothing else has failed before."""
        robot = self._parts.opened_by
        if robot is None or not self._parts.delivers or self.first is not None:
            return None
        return Failure(reason=Reason.PART_LOST, sentence=self._parts.opening(robot))
