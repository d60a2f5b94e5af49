"""Trees of files run by the rules of BehaviorTree.CPP 4: the same statuses at every tick."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from arboleda.bt_xml import checking, reading
from arboleda.bt_xml.findings import Findings
from arboleda.bt_xml.forest import Node as Written
from arboleda.bt_xml.running.build import MAKERS, Builder
from arboleda.bt_xml.running.memory import Scope
from arboleda.bt_xml.running.node import ENDED, NoClock, Node, Result

from .told import HEAD

LINES = [line for line in (Path(__file__).parent / "rules.txt").read_text().splitlines() if line[:1] != "#"]
CASES = list(zip(LINES[::2], LINES[1::2], strict=True))
LETTERS = {Status.INVALID: "I", Status.RUNNING: "R", Status.SUCCESS: "S", Status.FAILURE: "F"}
RESULTS = {"S": Result.SUCCESS, "F": Result.FAILURE, "R": Result.RUNNING, "K": Result.SKIPPED}
SAID = {result: letter for letter, result in RESULTS.items()}
NEED_TIME = {"Timeout", "Delay", "Sleep", "RateController"}
OF_NAV2 = {"RecoveryNode", "PipelineSequence", "RoundRobin"}
SAME_AS_ANOTHER = {"Switch3", "Switch4", "Switch5", "Switch6", "LoopBool", "LoopDouble", "LoopString"}


class Planned(Node):
    """A leaf that ends by a plan."""

    def __init__(self, plan: str) -> None:
        super().__init__("T")
        self.plan = plan
        self.ticks = 0

    def work(self) -> Result:
        letter = self.plan[self.ticks % len(self.plan)]
        self.ticks += 1
        return RESULTS[letter]


def leaf(node: Written, below: list[Node], scope: Scope) -> Node | None:
    return Planned(node.port("plan") or "S") if node.kind == "T" else None


def letters(node: Behaviour) -> str:
    return LETTERS[node.status] + "".join(map(letters, node.children))


def ticks(trees: str, many: int) -> list[str]:
    findings = Findings()
    head = HEAD.replace(">", ' main_tree_to_execute="Main">')
    forest = reading.read("t.xml", f"{head}{trees}</root>".encode(), findings)
    checking.check(forest, findings)
    assert findings.mistakes == ()
    scope = Scope(values={"n": 0.0, "m": "2"})
    tree = Builder(forest, leaf, NoClock()).tree("Main", scope)
    said = []
    for _ in range(many):
        result = tree.execute()
        if result in ENDED:
            tree.status = Status.INVALID
        said.append(f"{SAID[result]}:{letters(tree)}:{int(float(scope.values['n']))}")
    return said


@pytest.mark.parametrize("part", range(10))
def test_a_tree_comes_to_the_same_at_every_tick(part: int) -> None:
    for trees, expected in CASES[part::10]:
        assert ticks(trees, 12) == expected.split(), trees


def test_there_are_many_trees_and_every_kind_of_node_is_in_some() -> None:
    assert len(CASES) >= 500
    there = set(re.findall(r"<(\w+)", "".join(trees for trees, _ in CASES)))
    assert set(MAKERS) - there - NEED_TIME - OF_NAV2 - SAME_AS_ANOTHER == {"SetBlackboard", "UnsetBlackboard"}
