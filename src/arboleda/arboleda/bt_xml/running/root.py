"""Root of a running tree: turns its failure into the task's."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from arboleda.model.messages import Failure, Reason
from arboleda.model.sentence import Phrase
from arboleda.recipes.authoring import FINAL
from arboleda.trees.failures import Failures

from .leaves import Step
from .node import FAILURE, Node, Result
from .scripts import ScriptError

FAILED = Phrase("xml.failed", "the tree {tree} has failed")


class Forgiving(Step):
    """Step of the plant in a tree that may recover from its failure.

    The cause is kept until the whole tree fails; a cause that no recipe may recover from ends the tree.
    """

    def __init__(self, name: str, step: Behaviour, failures: Failures, causes: list[Failure]) -> None:
        super().__init__(name, step)
        self.failures = failures
        self.causes = causes

    def work(self) -> Result:
        if self.failures.first is not None:
            self.halt_step()
            return FAILURE
        result = super().work()
        cause = self.failures.first
        if result is FAILURE and cause is not None and cause.reason not in FINAL:
            self.causes[:] = [cause]
            self.failures.forgive()
        return result


class Main(Node):
    """Whole tree, with the variables of its outermost scope."""

    def __init__(self, name: str, tree: Node, failures: Failures, causes: list[Failure]) -> None:
        super().__init__(name, [tree])
        self.failures = failures
        self.causes = causes
        self.scope = tree.scope

    @property
    def parameters(self) -> Mapping[str, Any]:
        """The variables of the tree, for screens."""
        return dict(self.scope.values)

    def work(self) -> Result:
        self.begin()
        try:
            result = self.below[0].execute()
        except ScriptError as error:
            self._halt_all()
            self.causes[:] = [Failure(reason=Reason.REJECTED, sentence=error.sentence)]
            result = FAILURE
        if self.failures.first is not None:
            self._halt_all()
            return FAILURE
        if result is FAILURE:
            generic = Failure(reason=Reason.REJECTED, sentence=FAILED(tree=self.name))
            self.failures.add(self.causes[0] if self.causes else generic, self)
        return result

    def _halt_all(self) -> None:
        """Halt whatever runs, also below nodes that have ended: an error comes in the middle of a tick.

        A script that breaks while its node is halted keeps nothing else from being halted: what that left
        is halted from the innermost node on.
        """
        nodes = list(self.below[0].iterate())
        for node in (*nodes, *reversed(nodes)):
            if node.status is Status.RUNNING:
                with suppress(ScriptError):
                    node.stop(Status.INVALID)

    def halt(self) -> None:
        self._halt_all()
        self.below[0].reset()
        self.status = Status.INVALID

    def kept(self) -> Mapping[str, Any] | None:
        return self.scope.kept()

    def restore(self, state: Mapping[str, Any]) -> None:
        self.scope.restore(state)
