"""Run of a tree in a cell: the tree is built, ticked until it rests, and dropped."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterator
from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.composites import Selector, Sequence

from arboleda.dispatch.ledger import State
from arboleda.model.errors import ArboledaError
from arboleda.model.messages import Course, Failure, InternalError, Reason
from arboleda.model.sentence import Phrase, Sentence
from arboleda.model.tree_nodes import nodes_of

from . import steps
from .context import Context
from .leaves import Act, Leaf, title_of
from .node_state import Keeps

BROKE_IN_TREE = Phrase("cell.broke_in_tree", "{cell}: {kind} in the tree: {error}")
IN_RECOVERY = Phrase("step.in_recovery", "recovery: {step}")
TICK_BOUND = 20  # ticks in one step; more means a tree that never comes to rest


class TreeRun:
    """Run of at most one tree. An exception in the tree is its failure, which the context names."""

    def __init__(self, context: Context) -> None:
        self.tree: Behaviour | None = None
        self.nodes: list[Behaviour] = []  # of the tree, its root last
        self.keepers: list[tuple[int, Keeps]] = []  # nodes with more than a status to keep, by number
        self._acts: list[Act] = []
        self._recoveries: list[Behaviour] = []
        self._ended: list[Behaviour] = []  # nodes of trees that were dropped
        self._began: float | None = None  # in this start of the plant, s of the cell's time
        self.rested: tuple[object, ...] = ()  # the signature with which it came to rest last
        self._context = context

    @property
    def recovering(self) -> bool:
        """True while the recovery runs."""
        return Status.RUNNING in [node.status for node in self._recoveries]

    def begin(self, make: Callable[[], Behaviour]) -> Status:
        """Build a tree and tick it until it rests: RUNNING, SUCCESS or FAILURE."""
        self._began = self._context.time.now
        try:
            self.grow(make())
        except Exception as error:  # noqa: BLE001 - a recipe may be user code: it ends its task, not the plant
            return self._raised(error)
        return self.tick()

    def grow(self, tree: Behaviour) -> None:
        """Take a tree in the state in which it is."""
        self.tree, self.nodes = tree, nodes_of(tree)
        keepers = [(number, node) for number, node in enumerate(self.nodes) if isinstance(node, Keeps)]
        self.keepers = [(number, node) for number, node in keepers if type(node).kept is not Keeps.kept]
        acts = [(number, node) for number, node in enumerate(self.nodes) if isinstance(node, Act)]
        for number, act in acts:
            act.number_in_tree = number
        self._acts = [act for _, act in acts]
        self._recoveries = [node for node in self.nodes if node.name == steps.RECOVERY]

    def tick(self) -> Status:
        """Tick until a tick changes no status and sends no command; the status of the tree then."""
        try:
            return self._tick_to_rest()
        except Exception as error:  # noqa: BLE001 - a leaf may be user code: it ends its task, not the plant
            return self._raised(error)

    def drop(self) -> None:
        """End the tree, and halt what moves for it."""
        tree, self.tree = self.tree, None
        self._began = None
        self._ended += self.nodes
        self.nodes, self.keepers, self._acts, self._recoveries = [], [], [], []
        try:
            if tree is not None:
                tree.stop(Status.INVALID)
        except Exception as error:  # noqa: BLE001 - a leaf may be user code: whatever moves is halted all the same
            self._tell(error)
        self._context.commands.cancel_all()  # py_trees does not terminate a leaf that raised

    def take_apart(self) -> None:
        """Have the trees that have ended be given back at once; nobody asks for the path of a node any more.

        Their nodes refer to one another: a collector of garbage would look for them between two reactions.
        """
        for node in self._ended:
            node.parent, node.children, node.iterator = None, [], iter(())  # py_trees' own refers to its node
        self._ended.clear()

    @property
    def acts(self) -> list[Act]:
        """The commands that are under way."""
        return [act for act in self._acts if act.status is Status.RUNNING]

    @property
    def course(self) -> Course | None:
        """The course of the tree until now; None where an earlier start of the plant began it."""
        if self._began is None:
            return None
        now = self._context.time.now
        begun = {step: round(at - self._began, 3) for step, at in self._begun() if at < now}
        return Course(seconds=round(now - self._began, 3), begun=begun)

    @property
    def steps(self) -> list[tuple[str, float]]:
        """The steps that began in this start of the plant, the last first, and how many s ago.

        They have the names of a course. In a recovery there are none.
        """
        if self.recovering:
            return []
        now, in_order = self._context.time.now, sorted(self._begun(), key=lambda step: step[1])
        return [(step, now - at) for step, at in reversed(in_order)]

    def interrupted(self) -> list[Act]:
        """The steps that were under way and have ended without being done."""
        acts = [node for node in self._running() if isinstance(node, Act)]
        return [act for act in acts if act.entry and not act.entry.open and act.entry.state is not State.DONE]

    def _begun(self) -> Iterator[tuple[str, float]]:
        """The leaves that began in this start of the plant, and when; leaves of one name are numbered."""
        number = Counter[str]()
        for node in self.nodes:
            number[node.name] += 1
            if isinstance(node, Leaf) and node.began > -math.inf:
                yield f"{node.name} #{number[node.name]}", node.began

    def _running(self) -> list[Behaviour]:
        nodes = self.nodes if self.tree else ()
        return [node for node in nodes if node.status is Status.RUNNING]

    def _tick_to_rest(self) -> Status:
        tree = self.tree
        assert tree is not None
        before = self._signature()
        for _ in range(TICK_BOUND):
            tree.tick_once()
            if tree.status is not Status.RUNNING:
                return tree.status
            before, last = self._signature(), before
            if before == last or self._waits():
                self.rested = before
                return tree.status
        raise ArboledaError(f"the tree did not come to rest in {TICK_BOUND} ticks")

    def _waits(self) -> bool:
        """True where another tick would change nothing: it would only get to a command that waits."""
        node: Any
        for node in self.nodes:
            if node.status is not Status.RUNNING:
                continue
            kind = type(node)
            if kind is Sequence or (kind is Selector and node.current_child is node.children[0]):
                if not node.memory:  # it would tick the children before once more
                    return False
            elif kind is not Act or not node.waits:
                return False
        return True

    def _signature(self) -> tuple[object, ...]:
        return (self._context.commands.sent, [node.status for node in self.nodes])

    def _raised(self, error: Exception) -> Status:
        cell, kind = self._context.cell.name, type(error).__name__
        sentence = BROKE_IN_TREE(cell=cell, kind=kind, error=str(error))
        self._context.failures.add(Failure(reason=Reason.INTERNAL, sentence=sentence))
        self._tell(error)
        return Status.FAILURE

    def _tell(self, error: Exception) -> None:
        self._context.notify(InternalError(cell=self._context.cell.name, error=error))


def path_of(node: Behaviour) -> str:
    """The path of a node in its tree, as tasks and screens name it: child numbers, e.g. `0.2.1`."""
    numbers = []
    while node.parent is not None:
        numbers.append(node.parent.children.index(node))
        node = node.parent
    return ".".join(str(number) for number in reversed(numbers)) or "root"


def step_of(tree: Behaviour | None) -> Sentence | None:
    """The name of the step that runs, without its parts and frames; a step of a recovery says so."""
    running = [node for node in nodes_of(tree) if node.status is Status.RUNNING] if tree else []
    if not running:
        return None
    step = running[0]
    while step.parent is not None and not _frames(step.parent):
        step = step.parent
    phase = step.parent
    while phase is not None and phase.name not in steps.PHASES:
        phase = phase.parent
    title = title_of(step)
    return IN_RECOVERY(step=title) if phase is not None and phase.name == steps.RECOVERY else title


def _frames(node: Behaviour) -> bool:
    return node.name in steps.PHASES or steps.is_frame(node)
