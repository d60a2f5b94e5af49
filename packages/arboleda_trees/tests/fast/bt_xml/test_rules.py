"""Trees of files run by the rules of BehaviorTree.CPP 4: the same statuses at every tick."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from arboleda_trees.bt_xml import checking, reading
from arboleda_trees.bt_xml.findings import Findings
from arboleda_trees.bt_xml.forest import Node as Written
from arboleda_trees.bt_xml.running.build import MAKERS, Builder
from arboleda_trees.bt_xml.running.memory import Scope
from arboleda_trees.bt_xml.running.node import ENDED, Node, Result

from .findings import HEAD


def cases(name: str) -> list[tuple[str, str]]:
    lines = (Path(__file__).parent / name).read_text("utf-8").splitlines()
    lines = [line for line in lines if line[:1] != "#"]
    return list(zip(lines[::2], lines[1::2], strict=True))


CASES = [*cases("rules.txt"), *cases("rules_more.txt")]
TIMED = cases("rules_time.txt")
BETWEEN_S = 0.2  # two ticks of these
LETTERS = {Status.INVALID: "I", Status.RUNNING: "R", Status.SUCCESS: "S", Status.FAILURE: "F"}
RESULTS = {"S": Result.SUCCESS, "F": Result.FAILURE, "R": Result.RUNNING, "K": Result.SKIPPED}
SAID = {result: letter for letter, result in RESULTS.items()}
OF_VERSION_3 = {f"BlackboardCheck{each}" for each in ("Int", "Double", "String", "Bool")}
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


class Clock:
    """A clock that is moved by hand."""

    now = 0.0

    def wake_at(self, at: float) -> None:
        """Every tick comes anyway."""


def ticks(trees: str, many: int, *, between_s: float = BETWEEN_S) -> list[str]:
    findings = Findings()
    head = HEAD.replace(">", ' main_tree_to_execute="Main">')
    forest = reading.read("t.xml", f"{head}{trees}</root>".encode(), findings)
    checking.check(forest, findings)
    assert findings.mistakes == ()
    scope = Scope(values={"n": 0.0, "m": "2"})
    clock = Clock()
    tree = Builder(forest, leaf, clock).tree("Main", scope)
    said = []
    for number in range(many):
        clock.now = number * between_s
        result = tree.execute()
        if result in ENDED:
            tree.status = Status.INVALID
        said.append(f"{SAID[result]}:{letters(tree)}:{int(float(scope.values['n']))}")
    return said


@pytest.mark.sampled(5)
@pytest.mark.parametrize("part", range(10))
def test_a_tree_comes_to_the_same_at_every_tick(part: int) -> None:
    for trees, expected in [*CASES, *TIMED][part::10]:
        assert ticks(trees, 12) == expected.split(), trees


@pytest.mark.parametrize(
    "tree",
    [
        '<RetryUntilSuccessful num_attempts="3">{step}</RetryUntilSuccessful>',
        '<RecoveryNode number_of_retries="2">{step}<AlwaysSuccess/></RecoveryNode>',
    ],
)
def test_a_round_that_has_taken_several_ticks_and_no_time_is_followed_by_a_pause(tree: str) -> None:
    step = '<T plan="RF" _onFailure="n += 1"/>'
    trees = f'<BehaviorTree ID="Main">{tree.format(step=step)}</BehaviorTree>'
    assert {each.rpartition(":")[2] for each in ticks(trees, 12, between_s=0.0)[1:]} == {"1"}
    end = next(each for each in ticks(trees, 12) if each[0] == "F")
    assert end.rpartition(":")[2] == "3"


def test_there_are_many_trees_and_every_kind_of_node_is_in_some() -> None:
    assert len(CASES) >= 500
    there = set(re.findall(r"<(\w+)", "".join(trees for trees, _ in [*CASES, *TIMED])))
    assert set(MAKERS) - there - OF_VERSION_3 - SAME_AS_ANOTHER == {
        "SetBlackboard",
        "UnsetBlackboard",
        "ForEach",
    }


CHECKS = [
    ("Int", "2", "2.0", "S"),
    ("Int", "2", "3", "F"),
    ("Double", "0.5", "{m}", "F"),
    ("String", "2", "{m}", "S"),
    ("Bool", "true", "1", "S"),
    ("Bool", "true", "false", "F"),
    ("String", "{none}", "{none}", "F"),
]


@pytest.mark.parametrize(("kind", "one", "other", "ends"), CHECKS)
def test_the_checks_of_version_3_compare_by_type(kind: str, one: str, other: str, ends: str) -> None:
    check = f"BlackboardCheck{kind}"
    tree = f'<{check} value_A="{one}" value_B="{other}"><AlwaysSuccess/></{check}>'
    assert ticks(f'<BehaviorTree ID="Main">{tree}</BehaviorTree>', 1)[0][0] == ends


def test_a_check_of_version_3_leaves_its_child_when_the_values_differ() -> None:
    runs = '<T plan="R" _onHalted="n += 5"/>'
    check = f'<BlackboardCheckInt value_A="{{n}}" value_B="0">{runs}</BlackboardCheckInt>'
    later = '<Delay delay_msec="300"><Script code="n := 1"/></Delay>'
    tree = f'<Parallel success_count="2" failure_count="2">{check}{later}</Parallel>'
    said = ticks(f'<BehaviorTree ID="Main">{tree}</BehaviorTree>', 4)
    assert said[1:] == ["R:RRRRI:0", "R:RRRSI:1", "F:IIIII:6"]


SUB = '<SubTree ID="In" {} _autoremap="true"/>'
COUNTS = '<Script code="n = n * 10 + x"/>'
MODEL_OF_IN = '<TreeNodesModel><SubTree ID="In"><input_port name="x" default="5"/></SubTree></TreeNodesModel>'
SHARED = [
    (SUB.format(""), COUNTS, 1),
    (SUB.format('x="2"'), COUNTS, 2),
    (SUB.format('x="{y}"'), COUNTS, 3),
    (SUB.format('x="2"').replace("true", "false"), '<Script code="@n = x"/>', 2),
    (SUB.format('x="2"'), f"<Sequence>{SUB.replace('In', 'Under').format('')}</Sequence>", 2),
    (SUB.format('x="2"'), f'<Sequence><Script code="x = 4"/>{COUNTS}</Sequence>', 4),
    (SUB.format('x="2"'), '<Sequence><UnsetBlackboard key="x"/><Script code="n = x"/></Sequence>', 1),
    ('<Sequence><SubTree ID="In" x="2" _autoremap="1"/><Script code="n = x"/></Sequence>', COUNTS, 1),
]


@pytest.mark.parametrize(("subtree", "inner", "comes_to"), SHARED)
def test_what_a_subtree_is_given_stands_before_the_names_that_it_shares(
    subtree: str, inner: str, comes_to: int
) -> None:
    """With `_autoremap` also before a default of its model."""
    main = f'<Sequence><Script code="x := 1; y := 3"/>{subtree}</Sequence>'
    bodies = {"Main": main, "In": inner, "Under": COUNTS}
    trees = "".join(f'<BehaviorTree ID="{name}">{body}</BehaviorTree>' for name, body in bodies.items())
    assert ticks(trees + MODEL_OF_IN, 1)[0].endswith(f":{comes_to}")


def test_what_was_seen_of_a_variable_is_kept() -> None:
    scope = Scope()
    scope.set("x", 1)
    assert scope.kept() == {"values": {"x": 1}}
    seen = scope.watch("x")
    again = Scope()
    again.restore(scope.kept() or {})
    assert again.watch("x") == seen == 1
    again.set("x", 1)
    assert again.watch("x") == 2
    again.unset("x")
    assert again.watch("x") == 0


def test_a_timeout_leaves_a_child_that_was_skipped_when_the_time_came() -> None:
    """The page says that the original never does."""
    tree = '<Timeout msec="100"><T plan="KRRRSF"/></Timeout>'
    said = ticks(f'<BehaviorTree ID="Main">{tree}</BehaviorTree>', 3)
    assert said == ["K:RI:0", "R:RR:0", "F:II:0"]
