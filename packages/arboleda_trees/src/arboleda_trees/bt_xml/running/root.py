"""Root of a running tree: turns its failure into the task's."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from functools import partial
from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from arboleda.engine import Failures
from arboleda.model.kept_failures import failure_kept, read_failure
from arboleda.model.messages import Failure, Reason
from arboleda.recipes.authoring import FINAL
from arboleda.recipes.decorators import NO_RESCUE, with_second
from arboleda.recipes.holding import Take, used
from arboleda.recipes.of_files import FAILED, FAILED_AT

from .controls import InSequence, TryCatch
from .decorators import SubTree
from .leaves import AlwaysFailure, Step
from .node import FAILURE, Node, Result
from .scripts import ScriptError


def generic(tree: str, leaf: Node | None) -> Failure:
    """The failure of a tree without a failed step: the name of the leaf, if it has one, says why."""
    said = leaf.said if leaf is not None else ""
    sentence = FAILED_AT(tree=tree, leaf=said) if said else FAILED(tree=tree)
    return Failure(reason=Reason.REJECTED, sentence=sentence)


class Forgiving(Step):
    """Step of the plant in a tree that may recover from its failure.

    The cause is kept until the whole tree fails. A cause from which no recipe may recover ends the tree.
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
            self._note(cause)
            self.failures.forgive()
        return result

    def _note(self, cause: Failure) -> None:
        """Keep the cause until a node around this one succeeds."""
        before = self.causes[:]
        self.causes[:] = [cause]
        node = self.parent
        while node is not None:
            if isinstance(node, Node) and node.forget_failures is None:
                node.forget_failures = partial(_bring_back, self.causes, before)
            node = node.parent


def _bring_back(causes: list[Failure], before: list[Failure]) -> None:
    causes[:] = before


class Rescue(TryCatch):
    """TryCatch of a plant: the cause of a child's failure stays, whatever the result of the last child."""

    def __init__(
        self, name: str, children: Sequence[Node], failures: Failures, causes: list[Failure]
    ) -> None:
        super().__init__(name, children)
        self.failures = failures
        self.causes = causes
        self.cause: Failure | None = None
        self.ends_tree = False  # with its cause
        self.leaf: Node | None = None  # by whose failure the child failed

    def caught(self) -> None:
        """Put the cause aside, unless no part of the task may go on after it."""
        first = self.failures.first
        if first is not None and first.reason in NO_RESCUE:
            return
        self.leaf = self.blamed if first is None else None
        self.cause = first or (self.causes[0] if self.causes else generic(self.name, self.leaf))
        self.ends_tree = first is not None
        self._forget()

    def rescued(self) -> None:
        """Bring the cause back, with the cause of the last child's failure, if it failed."""
        if self.cause is None:
            return
        failed = self.below[-1].status is Status.FAILURE
        second = self.failures.first or (self.causes[0] if failed and self.causes else None)
        self._bring_back(with_second(self.cause, second))

    def halt(self) -> None:
        """Bring back the first cause, as the rescue does not end."""
        super().halt()
        if self.cause is not None:
            self.blame(self.leaf)
            self._bring_back(self.cause)

    def _forget(self) -> None:
        self.causes.clear()
        self.failures.forgive()

    def _bring_back(self, cause: Failure) -> None:
        self.causes[:] = [cause]
        if self.ends_tree or self.failures.first is not None:
            self.failures.bring_back(cause)
        self.blamed = self.leaf
        self.cause, self.leaf, self.ends_tree = None, None, False

    def kept(self) -> Mapping[str, Any] | None:
        if self.cause is None:
            return super().kept()
        return {**(super().kept() or {}), "cause": failure_kept(self.cause), "ends_tree": self.ends_tree}

    def restore(self, state: Mapping[str, Any]) -> None:
        counts = dict(state)
        if cause := counts.pop("cause", None):
            self.cause = read_failure(*cause)
        super().restore(counts)


def put_aside(tree: Node) -> Failure | None:
    """The cause of the outermost rescue that is under way in a tree."""
    rescues = [node for node in tree.iterate() if isinstance(node, Rescue)]
    return next((node.cause for node in reversed(rescues) if node.cause is not None), None)


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
            broken = Failure(reason=Reason.REJECTED, sentence=error.sentence)
            first = put_aside(self.below[0])
            self._halt_all()
            self.causes[:] = [with_second(first, broken) if first is not None else broken]
            result = FAILURE
        if self.failures.first is not None:
            self._halt_all()
            return FAILURE
        if result is FAILURE:
            cause = self.causes[0] if self.causes else generic(self.name, self.blamed)
            self.failures.add(cause, self.blamed if isinstance(self.blamed, AlwaysFailure) else self)
        return result

    def uses_first(self) -> bool:
        return self._first_use() is None

    def take_late(self, take: Take) -> None:
        """Insert the taking of shared devices before their first use, into the sequence of that use."""
        first_use = self._first_use()
        assert first_use is not None
        sequence, index = first_use
        step = take()
        taking = Forgiving(step.name, step, self.failures, self.causes)
        taking.time = sequence.time
        taking.parent = sequence
        sequence.children.insert(index, taking)

    def _first_use(self) -> tuple[Node, int] | None:
        """The innermost sequence with steps before the first use of a shared device, and the use's index.

        None where no step comes before the first use.
        """
        innermost: tuple[Node, int] | None = None
        node: Node = self.below[0]
        while isinstance(node, InSequence | SubTree):
            index = next((n for n, child in enumerate(node.below) if any(used(child))), 0)
            if isinstance(node, InSequence) and index:
                innermost = (node, index)
            node = node.below[index]
        return innermost

    def _halt_all(self) -> None:
        """Halt all running nodes, also those below ended ones: an error comes in the middle of a tick.

        A script may break while its node is halted, which leaves nodes below it running. So all nodes are
        halted a second time, from the innermost on.
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
