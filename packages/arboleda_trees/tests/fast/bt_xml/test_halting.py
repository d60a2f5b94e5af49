"""Nothing runs below a node that has ended, for every kind of node, every way out of it and every cause: of
trees as XML, and of recipes in Python, of which what they raise is tried by arboleda_proofs.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from typing import Any

import pytest
from py_trees.behaviour import Behaviour
from py_trees.common import Status
from tests.lengths import sample

from arboleda.model.messages import Failure, Reason
from arboleda.model.sentence import as_sentence
from arboleda.recipes import parallel, work
from arboleda.recipes.authoring import Kit
from arboleda_trees.bt_xml import checking, nodes, reading
from arboleda_trees.bt_xml.findings import Findings
from arboleda_trees.bt_xml.forest import Node as Written
from arboleda_trees.bt_xml.running.build import MAKERS, Builder
from arboleda_trees.bt_xml.running.memory import Scope
from arboleda_trees.bt_xml.running.node import Node
from arboleda_trees.bt_xml.running.root import Forgiving, Main

from .findings import HEAD

TICKS = 6
BETWEEN_S = 0.2  # two ticks
LOST = Failure(reason=Reason.PART_LOST, sentence=as_sentence("a part is lost"))
REFUSED = Failure(reason=Reason.REJECTED, sentence=as_sentence("it cannot"))


class Context:
    """Context of a tree: the time, and the failure of its task."""

    def __init__(self) -> None:
        self.now = 0.0
        self.first: Failure | None = None
        self.leaf = None
        self.time = self.failures = self

    def wake_at(self, at: float) -> None:
        """Every tick comes anyway."""

    def add(self, failure: Failure, leaf: Behaviour | None = None) -> None:
        self.first = self.first or failure

    def forgive(self) -> None:
        self.first = None

    def bring_back(self, failure: Failure, leaf: Behaviour | None = None) -> None:
        self.first = failure


class Acts(Behaviour):
    """A step of the plant that runs for so many ticks and then ends."""

    def __init__(self, context: Context, ticks: int, ends: str) -> None:
        super().__init__("acts")
        self.context, self.left, self.ends = context, ticks, ends

    def update(self) -> Status:
        self.left -= 1
        if self.left >= 0:
            return Status.RUNNING
        if self.ends == "done":
            return Status.SUCCESS
        self.context.failures.add({"lost": LOST, "refused": REFUSED}[self.ends], self)
        return Status.FAILURE


def leaf(context: Context) -> object:
    """Makes the leaf `T`, by its port `ends`."""

    def make(node: Written, below: list[Node], scope: Scope) -> Node | None:
        if node.kind != "T":
            return None
        ticks, ends = (node.port("ends") or "").split()
        return Forgiving("T", Acts(context, int(ticks), ends), context, [])  # type: ignore[arg-type]

    return make


def t(ticks: int, ends: str, more: str = "") -> str:
    return f'<T ends="{ticks} {ends}" {more}/>'


RUNS = t(99, "done")
BREAKS = '<ScriptCondition code="1 / 0 == 1"/>'
ON_HALTED = '_onHalted="1 / 0"'
CAUSES = {
    "done": t(1, "done"),
    "at once": t(0, "done"),
    "refused": t(1, "refused"),
    "lost": t(1, "lost"),
    "a script": f"<Sequence>{t(1, 'done')}{BREAKS}</Sequence>",
    "a condition": t(99, "done", '_while="n &lt; 3"'),
    "a script of what is halted": (
        f'<Parallel success_count="2">{t(99, "done", ON_HALTED)}{t(1, "lost")}</Parallel>'
    ),
}
GIVEN = {
    "Switch": 'variable="{n}" case_1="1" case_2="2"',
    "Loop": 'queue="a;b" value="{v}"',
    "BlackboardCheck": 'value_A="{n}" value_B="1"',
    "ForEach": 'vector_in="a;b" out="{v}"',
    "Repeat": 'num_cycles="2"',
    "RetryUntilSuccessful": 'num_attempts="2"',
    "Timeout": 'msec="500"',
    "Delay": 'delay_msec="1"',
    "Precondition": 'if="n &lt; 4"',
    "SkipUnlessUpdated": 'entry="{n}"',
    "WaitValueUpdate": 'entry="{n}"',
    "GoalUpdatedController": 'goal="{n}"',
    "PersistentSequence": 'current_child_idx="{at}"',
}
AROUND = sorted(
    name for name, kind in nodes.BUILT_IN.items() if name in MAKERS and kind.most and "Switch" not in name
)
WITH_CHILDREN = [*AROUND, "Switch2"]


def written(kind: str, children: tuple[str, ...]) -> str:
    given = next((given for name, given in GIVEN.items() if kind.startswith(name)), "")
    return f"<{kind} {given}>{''.join(children)}</{kind}>"


def bodies(kind: str, cause: str) -> Iterator[str]:
    """The kind with children that run, that end by the cause, and both at once, in every order."""
    known = nodes.BUILT_IN[kind]
    both = f'<Parallel success_count="2" failure_count="1">{RUNS}{CAUSES[cause]}</Parallel>'
    one_at_once = f"<NonblockingSequence>{CAUSES[cause]}{RUNS}</NonblockingSequence>"
    for children in product(
        (RUNS, CAUSES[cause], both, one_at_once), repeat=max(known.fewest, min(known.most, 2))
    ):
        yield written(kind, children)


def main(body: str) -> tuple[Main, Context]:
    findings = Findings()
    text = f'{HEAD}<BehaviorTree ID="Main">{body}</BehaviorTree></root>'
    forest = reading.read("t.xml", text.encode(), findings)
    checking.check(forest, findings)
    assert findings.mistakes == (), body
    context = Context()
    scope = Scope(values={"n": 1, "at": 0})
    tree = Builder(forest, leaf(context), context).tree("Main", scope)  # type: ignore[arg-type]
    return Main("t", tree, context, []), context  # type: ignore[arg-type]


def at_work(tree: Behaviour) -> list[Acts]:
    return [node for node in tree.iterate() if isinstance(node, Acts) and node.status is Status.RUNNING]


def left_alone(tree: Behaviour) -> list[Acts]:
    """The steps that run below a node that does not."""

    def is_held(node: Behaviour | None) -> bool:
        return node is None or (node.status is Status.RUNNING and is_held(node.parent))

    return [node for node in at_work(tree) if not is_held(node)]


@pytest.mark.sampled(5)
@pytest.mark.parametrize(("kind", "cause"), sample(product(WITH_CHILDREN, CAUSES), every=2))
def test_nothing_runs_below_what_has_ended(kind: str, cause: str) -> None:
    began = 0
    for body in sample(bodies(kind, cause), every=3):
        tree, context = main(body)
        for number in range(TICKS):
            context.time.now = number * BETWEEN_S
            tree.scope.set("n", number + 1)
            tree.tick_once()
            assert left_alone(tree) == [], (body, number)
            began += len(at_work(tree))
            if tree.status is not Status.RUNNING:
                break
    assert began, "no step of it ever ran"


@pytest.mark.sampled(5)
@pytest.mark.parametrize(("kind", "cause"), sample(product(WITH_CHILDREN, CAUSES), every=2))
def test_nothing_runs_once_the_whole_is_left(kind: str, cause: str) -> None:
    """As an operator's abandon leaves it, after each tick."""
    for body in sample(bodies(kind, cause), every=5):
        for ticks in range(1, 4):
            tree, context = main(body)
            for number in range(ticks):
                context.time.now = number * BETWEEN_S
                tree.tick_once()
            tree.stop(Status.INVALID)
            assert at_work(tree) == [], (body, ticks)


@pytest.mark.sampled(4)
@pytest.mark.parametrize("kind", WITH_CHILDREN)
def test_nothing_runs_once_the_task_has_failed_beside_the_tree(kind: str) -> None:
    for body in bodies(kind, "done"):
        tree, context = main(body)
        tree.tick_once()
        context.failures.add(LOST)
        tree.tick_once()
        assert (tree.status, at_work(tree)) == (Status.FAILURE, []), body


IN_PYTHON = {
    "work": lambda kit, *steps: work(*steps),
    "parallel": lambda kit, *steps: parallel(*steps),
    "fallback": lambda kit, *steps: kit.fallback(*steps),
    "retry": lambda kit, *steps: kit.retry(parallel(*steps), pause_s=0.1),
    "repeat": lambda kit, *steps: kit.repeat(parallel(*steps), 2),
    "timeout": lambda kit, *steps: kit.timeout(parallel(*steps), 0.5),
    "recover": lambda kit, *steps: kit.recover(steps[0], steps[1:]),
    "invert": lambda kit, *steps: kit.invert(parallel(*steps)),
}
NO_FRAMES = {
    "devices",
    "device",
    "group",
    "place",
    "handover",
    "run",
    "using",
    "choose",
    "fail",
    "wait",
}  # sequences and selectors, or leaves
STEPS = [(0, "done"), (1, "done"), (1, "refused"), (1, "lost"), (99, "done")]


def test_every_frame_of_recipes_is_among_these() -> None:
    of_kit = {name for name in vars(Kit) if not name.startswith("_")}
    assert of_kit - NO_FRAMES == set(IN_PYTHON) - {"work", "parallel"}


@pytest.mark.parametrize(("outer", "inner"), list(product(IN_PYTHON, repeat=2)))
def test_nothing_runs_below_what_has_ended_in_python(outer: str, inner: str) -> None:
    began = 0
    for ends in sample(product(STEPS, repeat=3), every=7):
        context = Context()
        kit: Any = Kit(context)  # type: ignore[arg-type]
        one, two, three = (Acts(context, ticks, end) for ticks, end in ends)
        tree = work(IN_PYTHON[outer](kit, IN_PYTHON[inner](kit, one, two), three))
        for number in range(TICKS):
            context.time.now = number * BETWEEN_S
            tree.tick_once()
            assert left_alone(tree) == [], (ends, number)
            began += len(at_work(tree))
            if tree.status is not Status.RUNNING:
                break
        tree.stop(Status.INVALID)
        assert at_work(tree) == [], ends
    assert began, "no step of it ever ran"
