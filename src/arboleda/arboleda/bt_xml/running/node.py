"""What every node does around its own tick: conditions before, scripts after, halting, and being kept.

A node's status is that of py_trees, where INVALID is what BehaviorTree.CPP calls IDLE. A tick also may come
to SKIPPED, which no status shows: the parent is told, and the node stays as it is.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from enum import Enum
from typing import Any, ClassVar, Protocol, cast

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from arboleda.trees.trail import Keeps

from .memory import Scope
from .scripts import Script


class Result(Enum):
    """What a tick came to."""

    RUNNING = "RUNNING"
    SUCCESS = "SUCCESS"
    FAILURE = "FAILURE"
    SKIPPED = "SKIPPED"


RUNNING, SUCCESS, FAILURE, SKIPPED = Result
STATUSES = {RUNNING: Status.RUNNING, SUCCESS: Status.SUCCESS, FAILURE: Status.FAILURE}
ENDED = (SUCCESS, FAILURE)
TICK_S = 0.01  # until the next tick, as BehaviorTree.CPP's own loops have it
PAUSE_S = 0.1  # before what may take no time is asked once more, without end


class Clock(Protocol):
    """What a node knows of time: that of its cell."""

    @property
    def now(self) -> float: ...

    def wake_at(self, at: float) -> None: ...


class NoClock:
    """Of a node that is not built into a tree."""

    now = 0.0

    def wake_at(self, at: float) -> None:
        """Nobody is woken."""


class Node(Keeps, Behaviour):
    """`counts` are the names of attributes that say how far it came, which are kept for the next start."""

    counts: ClassVar[tuple[str, ...]] = ()
    sign: ClassVar[str] = "step"  # the word of drawings and of the page for it
    frame = True  # where it runs, screens name the step in it

    def __init__(self, name: str, children: Sequence[Node] = ()) -> None:
        super().__init__(name)
        self.scope = Scope()
        self.context: Clock = NoClock()
        self.before: Mapping[str, Script] = {}
        self.after: Mapping[str, Script] = {}
        for child in children:
            self.children.append(child)
            child.parent = self

    @property
    def below(self) -> list[Node]:
        """Its children."""
        return cast("list[Node]", self.children)

    def work(self) -> Result:
        """Its own tick."""
        raise NotImplementedError

    def reset_counts(self) -> None:
        """Forget how far it came, as it does when it is halted."""

    def execute(self) -> Result:
        """Tick it, with the conditions and scripts that stand at it."""
        result = self._by_condition()
        if result is None:
            result = self.work()
        if result in ENDED:
            self._run({SUCCESS: "_onSuccess", FAILURE: "_onFailure"}[result])
            self._run("_post")
        if result is not SKIPPED:
            self.status = STATUSES[result]
        return result

    def halt(self) -> None:
        """Leave it while it runs, with all that runs below it."""
        self.forget()
        self._run("_onHalted")

    def forget(self) -> None:
        """Be as it was before it began."""
        self.reset_counts()
        self.reset_children()
        self.status = Status.INVALID

    def reset(self) -> None:
        """Have it begin anew when it is ticked next."""
        if self.status is Status.RUNNING:
            self.halt()
        self.status = Status.INVALID

    def again(self, *, after_s: float = TICK_S) -> Result:
        """It goes on with the next tick, which comes by itself."""
        self.context.wake_at(self.context.now + after_s)
        return RUNNING

    def begin(self) -> bool:
        """It runs from now on; whether it did not before."""
        was = self.status
        self.status = Status.RUNNING
        return was is Status.INVALID

    def reset_children(self) -> None:
        for child in self.below:
            child.reset()

    def tick(self) -> Iterator[Behaviour]:
        """As a node of py_trees: what was skipped had nothing to do."""
        if self.execute() is SKIPPED:
            self.reset()
            self.status = Status.SUCCESS
        yield self

    def update(self) -> Status:
        """As py_trees wants it; `tick` does without."""
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
        """What a condition makes of the tick; while it runs only `_while` is looked at."""
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
    """A node around one; what has ended below it begins anew with the next tick."""

    @property
    def child(self) -> Node:
        return self.below[0]

    def execute(self) -> Result:
        result = super().execute()
        if self.child.status in (Status.SUCCESS, Status.FAILURE):
            self.child.status = Status.INVALID
        return result
