"""Failures of the task that runs, as its leaves name them."""

from __future__ import annotations

from py_trees.behaviour import Behaviour

from arboleda.model.messages import Failure, Reason

from .parts import Parts


class Failures:
    """Causes for which a tree fails. The `first` counts, which `leaf` named; `last` is the latest."""

    def __init__(self, parts: Parts) -> None:
        self.first: Failure | None = None
        self.leaf: Behaviour | None = None
        self.last: Failure | None = None
        self._parts = parts

    def add(self, failure: Failure, leaf: Behaviour | None = None) -> None:
        """Name the cause of a failure; the part that was carried is a matter of the recovery then."""
        if self.first is None:
            self.first, self.leaf = failure, leaf
        self.last = failure
        self._parts.carrier = None

    def forgive(self) -> None:
        """Forget a failure that the recipe deals with, so that the task goes on."""
        self.first = self.leaf = None

    def bring_back(self, failure: Failure, leaf: Behaviour | None = None) -> None:
        """Put back the cause of a failure that came first, and was put aside for a while."""
        self.first, self.leaf = failure, leaf

    def clear(self) -> None:
        """Forget all failures of the last tree."""
        self.first = self.leaf = self.last = None

    def opened_effector(self) -> Failure | None:
        """The failure for an effector that opened unbidden with a part, where nothing has failed before."""
        robot = self._parts.opened_by
        if robot is None or not self._parts.delivers or self.first is not None:
            return None
        return Failure(reason=Reason.PART_LOST, sentence=self._parts.opening(robot))
