"""Keeper of a cell's running task: writes its trail, and puts that of an earlier start into a tree.

A trail names steps by their numbers, so it fits only a tree that is made of the same: fingerprints say that.
A tree is made at the start, and goes on only once a person says so. Until then devices are heard, so what
became of its steps is judged anew whenever they report, and once more as it goes on.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from arboleda.model.commands import Process
from arboleda.model.messages import Failure
from arboleda.model.sentence import Phrase, Sentence
from arboleda.model.task import Order
from arboleda.model.tree_nodes import nodes_of
from arboleda.trees.cell_robots import Planned
from arboleda.trees.context import Context
from arboleda.trees.leaves import Act, Await, Dwell
from arboleda.trees.node_state import SWITCH
from arboleda.trees.tree_run import TreeRun

from . import fingerprint, trail
from .trail import Begun, Knowledge, Trail
from .walk_back import Judgement, WalkBack

CHANGED = Phrase("walk.changed", "its recipe or the plant file has changed since it began")
UNREADABLE = Phrase("walk.unreadable", "what was kept of it cannot be read")
WAS_RECOVERING = Phrase("walk.was_recovering", "its work has failed, and the recovery was cut off")
NOTHING_KEPT = Trail(
    begun=Begun(made="", planned=Planned(standing={}, positions={})),
    statuses="",
    nodes={},
    carrier=None,
    back={},
    origins=(),
    used=(),
    knowledge={},
    grips={},
    zones={},
)


class Keeping:
    """Keeper of one cell's task. `walk` has the trail of an earlier start, until a person says more.

    `build` makes the tree of an order.
    """

    def __init__(self, context: Context, run: TreeRun, build: Callable[[Order, Context], Behaviour]) -> None:
        self.walk: WalkBack | None = None
        self._context = context
        self._run = run
        self._build = build
        self._begun = NOTHING_KEPT.begun
        self._cells: dict[str, tuple[str, fingerprint.Seen, str]] = {}  # by recipe, of `_of_cell`
        self._last_state: tuple[object, ...] = ()  # of which the last trail was made

    def revise(self) -> None:
        """Go by another version of the cell from the next task on."""
        self._cells.clear()

    @property
    def envelope(self) -> Sequence[str]:
        """The effectors that the task may tell to switch before their new grip is durable."""
        return self._begun.envelope

    def make(self, order: Order) -> Behaviour:
        """The tree of a task that begins."""
        self.walk = None
        return self._grown(order, self._context.robots.planned(), self._context.parts.witnessed)

    def revive(self, order: Order, text: str) -> Sentence | None:
        """Take over the task of an earlier start from its trail; returns why it cannot go on at its step."""
        try:
            self.walk = WalkBack(Trail.read(text), (), ())
        except ValueError:
            self.walk = WalkBack(NOTHING_KEPT, (), ())
            return UNREADABLE()
        earlier = self.walk.trail
        if earlier.recovers:
            self._take_over(earlier)
            return WAS_RECOVERING()
        try:
            self._context.robots.as_planned = earlier.begun.planned
            tree = self._grown(order, earlier.begun.planned, earlier.begun.envelope)
            nodes = nodes_of(tree)
            begun = (
                trail.put_back(nodes, earlier) if self._is_alike(order, tree, earlier.begun.made) else None
            )
        except Exception:  # noqa: BLE001 - a recipe may be user code, and another one than it was
            begun = None
        finally:
            self._context.robots.as_planned = None
        self._take_over(earlier)
        if begun is None:
            return CHANGED()
        self._run.grow(tree)
        for step in begun:
            if isinstance(step, Await | Dwell):
                step.begin_anew()
            if isinstance(step, Act) and step.last is not None and step.last["effect"] == SWITCH:
                self._context.parts.leave_unsettled(step.last["robot"], sets=dict(step.last["sets"]))
        self.walk = WalkBack(earlier, begun, self._run.nodes)
        return earlier.stranded

    def _take_over(self, earlier: Trail) -> None:
        """Take over the books of an earlier start's task; its time stands until `time.go_on`."""
        context = self._context
        context.start_afresh()
        context.time.pause()
        context.commands.used = set(earlier.used)
        context.handling.begin(earlier.taken, earlier.unchecked)
        context.answers[:] = earlier.answers
        context.zones.interlocks.reserved = earlier.zones
        context.parts.take_over(carrier=earlier.carrier, origins=earlier.origins, back=earlier.back)

    def judge(self) -> Judgement:
        """Judge the steps at which an earlier start ended, by the devices' reports."""
        assert self.walk is not None
        return self.walk.judge(self._context)

    def go_on(self) -> None:
        """Go on at the steps at which an earlier start ended, by the devices' reports until now."""
        assert self.walk is not None
        walk, self.walk = self.walk, None
        self._last_state = ()
        judgement = walk.judge(self._context)
        self._context.settle()
        walk.go_on(judgement)
        self._context.zones.forsake()  # machines keep the zones of commands that were given, and no others

    def end(self) -> None:
        """End the trail: the task has ended, or only recovers."""
        self.walk, self._last_state = None, ()
        self._context.settle()
        self._context.zones.forsake()

    def news(
        self, *, failure: Failure | None, cancels: bool, holds: bool, stranded: Sentence | None
    ) -> str | None:
        """The trail of the task, to be kept; None where it has not changed since it was kept."""
        if self.walk is not None:
            return self._stranded(self.walk, stranded)
        numbers = [
            act.entry.number
            for act in self._run.acts
            if act.status is Status.RUNNING
            and act.entry is not None
            and isinstance(act.entry.command, Process)
        ]
        state = (self._run.rested, holds, cancels, stranded, numbers)
        if state == self._last_state:
            return None
        self._last_state = state
        return self._trail(failure, cancels=cancels, stranded=stranded).text()

    def _stranded(self, walk: WalkBack, stranded: Sentence | None) -> str | None:
        """The trail of an earlier start, once its task can only be abandoned; None where that is kept."""
        if stranded is None or walk.trail.stranded is not None or self._run.tree is None:
            return None
        walk.trail = walk.trail._replace(stranded=stranded)
        return walk.trail.text()

    def _trail(self, failure: Failure | None, *, cancels: bool, stranded: Sentence | None) -> Trail:
        context, recovers = self._context, self._run.recovering
        back, machines = context.parts.back, context.cell.interlocked  # empty ones cost no call below
        nodes = [] if recovers else self._run.nodes
        told = context.commands.used.union(self._begun.planned.positions)
        knowledge = {}
        for belief, more in () if recovers else context.robots.receiving(told):
            heard = Knowledge(belief.boot_id, belief.receipt, more, belief.epoch)
            knowledge[belief.robot.name] = heard
        return Trail(
            begun=self._begun,
            statuses=trail.statuses(nodes),
            nodes=trail.kept_of(() if recovers else self._run.keepers),
            carrier=context.parts.carrier,
            back={robot: pose.name for robot, pose in back.items()} if back else {},
            origins=sorted(context.parts.origins),
            used=sorted(context.commands.used),
            knowledge=knowledge,
            grips={} if recovers else context.parts.grips,
            zones={name: sorted(context.zones.held_by(name)) for name in machines} if machines else {},
            failure=(failure or context.failures.first) if recovers else None,
            recovers=recovers,
            cancels=cancels,
            stranded=stranded,
            answers=tuple(context.answers),
            taken=dict(context.handling.taken),
            unchecked=context.handling.unchecked,
        )

    def _grown(self, order: Order, planned: Planned, envelope: Sequence[str]) -> Behaviour:
        """The tree of an order; what it was made of is noted."""
        of_cell, seen, source = self._of_cell(order.recipe)
        tree = self._build(order, self._context)
        of_tree = fingerprint.of_tree(tree, seen, source=source)
        made = fingerprint.BY_SOURCE + fingerprint.joined(of_cell, order.short, of_tree)
        self._begun = Begun(made=made, planned=planned, envelope=envelope)
        return tree

    def _of_cell(self, recipe: str) -> tuple[str, fingerprint.Seen, str]:
        """The fingerprint of the cell for a recipe, the values seen in it, the recipe's source; made once."""
        if recipe not in self._cells:
            cell = self._context.cell
            seen: fingerprint.Seen = {}
            sources = (each.source for each in cell.recipes if each.name == recipe)
            made = fingerprint.of_cell(cell, recipe, seen)
            self._cells[recipe] = made, seen, next(sources, "")
        return self._cells[recipe]

    def _is_alike(self, order: Order, tree: Behaviour, made: str) -> bool:
        """True where the tree of an earlier start had the fingerprint of this tree.

        A fingerprint of an earlier version has the code of functions, and is compared with one of that form.
        """
        if made.startswith(fingerprint.BY_SOURCE):
            return made == self._begun.made
        seen: fingerprint.Seen = {}
        of_cell = fingerprint.of_cell(self._context.cell, order.recipe, seen, by_code=True)
        of_tree = fingerprint.of_tree(tree, seen, by_code=True)
        return made == fingerprint.joined(of_cell, order.short, of_tree)
