"""Base of every node: conditions before its tick, scripts after it, halting, and the state that is kept.

A node's status is that of py_trees; INVALID is IDLE in BehaviorTree.CPP. The result of a tick may also be
SKIPPED, which is no status: the parent gets the result, and the node's status does not change.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from enum import Enum
from typing import Any, ClassVar, Protocol, cast

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from arboleda.engine import Keeps
from arboleda.recipes.of_files import FileNode, Place

from .memory import Scope
from .ports import NodePorts
from .scripts import Script


class Result(Enum):
    """Result of a tick."""

    RUNNING = "RUNNING"
    SUCCESS = "SUCCESS"
    FAILURE = "FAILURE"
    SKIPPED = "SKIPPED"


RUNNING, SUCCESS, FAILURE, SKIPPED = Result
STATUSES = {RUNNING: Status.RUNNING, SUCCESS: Status.SUCCESS, FAILURE: Status.FAILURE}
ENDED = (SUCCESS, FAILURE)
TICK_S = 0.01  # until the next tick, as in the loops of BehaviorTree.CPP
PAUSE_S = 0.1  # before a child that may take no time is repeated without end


class Clock(Protocol):
    """Time of a node: the clock of its cell."""

    @property
    def now(self) -> float: ...

    def wake_at(self, at: float) -> None: ...


class NoClock:
    """Clock of a node that is not part of a tree."""

    now = 0.0

    def wake_at(self, at: float) -> None:
        """Does nothing."""


class Node(Keeps, FileNode):
    """Base of nodes; `counts` are the attributes with the node's progress, which is kept for the next start.

    `forget_failures` is called when the node succeeds although a step in it has failed. `place` is in the
    file. `said` is its name or note in the file. `blamed` is the leaf by whose failure the node fails.
    """

    sign: ClassVar[str] = "step"  # its kind in drawings and on the page
    frame = True  # while the node runs, screens name the step inside it
    is_leaf: ClassVar[bool] = False
    ports: NodePorts  # of nodes that have some

    def __init__(self, name: str, children: Sequence[Node] = ()) -> None:
        super().__init__(name)
        self.scope: Scope = Scope()
        self.time: Clock = NoClock()
        self.before: Mapping[str, Script] = {}
        self.after: Mapping[str, Script] = {}
        self.forget_failures: Callable[[], None] | None = None
        self.place: Place | None = None
        self.said = ""
        self.blamed: Node | None = None
        self.rests_until: float | None = None
        self.writes: tuple[tuple[Scope, str], ...] = ()
        for child in children:
            self.children.append(child)
            child.parent = self

    @property
    def below(self) -> list[Node]:
        """The children."""
        return cast("list[Node]", self.children)

    def work(self) -> Result:
        """Carry out the node's own tick."""
        raise NotImplementedError

    def reset_counts(self) -> None:
        """Forget the progress; called when the node is halted."""

    def execute(self) -> Result:
        """Tick the node, with its conditions and scripts."""
        result = self._by_condition()
        if result is None:
            rests = self.rests_until is not None and self.time.now < self.rests_until
            result = RUNNING if rests else self.work()
        if self.forget_failures is not None and result is not RUNNING:
            if result is SUCCESS:
                self.forget_failures()
            self.forget_failures = None
        if result in ENDED:
            if result is FAILURE:
                self.blame(self if self.is_leaf else self.blamed)
            self.blamed = None
            self._run({SUCCESS: "_onSuccess", FAILURE: "_onFailure"}[result])
            self._run("_post")
        if result is not SKIPPED:
            self.status = STATUSES[result]
        return result

    def blame(self, leaf: Node | None) -> None:
        """Tell the parent which leaf failed. A parent that handles the failure may override this."""
        if isinstance(self.parent, Node):
            self.parent.blamed = leaf

    def halt(self) -> None:
        """Halt the node if it runs, with all nodes that run below it."""
        self.forget()
        self._run("_onHalted")

    def forget(self) -> None:
        """Return to the state before the node began."""
        self.reset_counts()
        self.reset_children()
        self.rests_until = None
        self.status = Status.INVALID

    def reset(self) -> None:
        """Let the node begin anew at the next tick."""
        if self.status is Status.RUNNING:
            self.halt()
        self.status = Status.INVALID

    def again(self, *, after_s: float = TICK_S) -> Result:
        """Returns RUNNING, and asks for another tick after `after_s`.

        The node rests for TICK_S, however often the plant ticks in one step, as in BehaviorTree.CPP.
        """
        self.rests_until = self.time.now + TICK_S
        self.time.wake_at(self.time.now + after_s)
        return RUNNING

    def begin(self) -> bool:
        """Mark the node as running; True if it was not."""
        was = self.status
        self.status = Status.RUNNING
        return was is Status.INVALID

    def reset_children(self) -> None:
        for child in self.below:
            child.reset()

    def tick(self) -> Iterator[Behaviour]:
        """Tick as a node of py_trees; a skipped node had nothing to do."""
        if self.execute() is SKIPPED:
            self.reset()
            self.status = Status.SUCCESS
        yield self

    def update(self) -> Status:
        """Required by py_trees; `tick` does not call it."""
        return self.status

    def stop(self, new_status: Status = Status.INVALID) -> None:
        if new_status is Status.INVALID:
            self.reset()
        self.status = new_status

    def kept(self) -> Mapping[str, Any] | None:
        return {name: value for name in self.counts if (value := getattr(self, name))}

    def restore(self, state: Mapping[str, Any]) -> None:
        for name, value in state.items():
            setattr(self, name, value)

    def _by_condition(self) -> Result | None:
        """The result by a condition; None if the node is to tick. For a running node only `_while` counts."""
        if self.status is Status.RUNNING:
            script = self.before.get("_while")
            if script is None or script.holds(self.scope):
                return None
            self.halt()
            return SKIPPED
        if self.status is not Status.INVALID:
            return None
        for name, result in (("_failureIf", FAILURE), ("_successIf", SUCCESS), ("_skipIf", SKIPPED)):
            if name in self.before and self.before[name].holds(self.scope):
                return result
        if "_while" in self.before and not self.before["_while"].holds(self.scope):
            return SKIPPED
        return None

    def _run(self, name: str) -> None:
        if name in self.after:
            self.after[name].run(self.scope)


class Decorator(Node):
    """Base of nodes around one child; a child that has ended begins anew at the next tick."""

    @property
    def child(self) -> Node:
        return self.below[0]

    def execute(self) -> Result:
        result = super().execute()
        if self.child.status in (Status.SUCCESS, Status.FAILURE):
            self.child.status = Status.INVALID
        return result
