"""Lesson 3: the same cycle as a state machine and as a tree; then a sensor and a retry come into both."""

from __future__ import annotations

from collections.abc import Callable

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.composites import Sequence
from py_trees.decorators import Retry

from arboleda_class.lessons import spoken

DONE, GIVEN_UP = "done", "given up"
TRIES = 3


class Robot:
    """Does what it is told and says whether it worked; its first grip misses the piece."""

    def __init__(self) -> None:
        self.did: list[str] = []
        self.grips = 0

    def do(self, action: str) -> bool:
        self.did.append(action)
        self.grips += action == "close"
        return action != "piece in hand?" or self.grips > 1


# A state machine: state -> (what to do, next state if it worked, next state if not)
Table = dict[str, tuple[str, str, str]]
SHORT: Table = {
    "at home": ("walk", "at pick-up", GIVEN_UP),
    "at pick-up": ("close", "gripped", GIVEN_UP),
    "gripped": ("move to station", "at station", GIVEN_UP),
    "at station": ("open", DONE, GIVEN_UP),
}
LONG: Table = {
    "at home": ("walk", "at pick-up", GIVEN_UP),
    "at pick-up": ("piece there?", "try 1", GIVEN_UP),
    "try 1": ("close", "closed 1", GIVEN_UP),
    "closed 1": ("piece in hand?", "gripped", "missed 1"),
    "missed 1": ("open", "try 2", GIVEN_UP),
    "try 2": ("close", "closed 2", GIVEN_UP),
    "closed 2": ("piece in hand?", "gripped", "missed 2"),
    "missed 2": ("open", "try 3", GIVEN_UP),
    "try 3": ("close", "closed 3", GIVEN_UP),
    "closed 3": ("piece in hand?", "gripped", "missed 3"),
    "missed 3": ("open", GIVEN_UP, GIVEN_UP),
    "gripped": ("move to station", "at station", GIVEN_UP),
    "at station": ("open", DONE, GIVEN_UP),
}


def run_table(table: Table, robot: Robot) -> str:
    """From the first state to an end."""
    state = next(iter(table))
    while state in table:
        action, worked, failed = table[state]
        state = worked if robot.do(action) else failed
    return state


class Do(Behaviour):
    """One action, or one question, of the robot."""

    def __init__(self, action: str, robot: Robot) -> None:
        super().__init__(action)
        self.robot = robot

    def update(self) -> Status:
        return Status.SUCCESS if self.robot.do(self.name) else Status.FAILURE


class OpenAfterMiss(Do):
    """Asks; where the answer is no, the effector opens, ready for another try."""

    def update(self) -> Status:
        answer = super().update()
        if answer is Status.FAILURE:
            self.robot.do("open")
        return answer


def short_tree(robot: Robot) -> Behaviour:
    steps = ("walk", "close", "move to station", "open")
    return Sequence("cycle", memory=True, children=[Do(step, robot) for step in steps])


def long_tree(robot: Robot) -> Behaviour:
    grip = Sequence(
        "grip", memory=True, children=[Do("close", robot), OpenAfterMiss("piece in hand?", robot)]
    )
    tree = short_tree(robot)
    tree.replace_child(tree.children[1], Retry("up to three times", grip, TRIES))
    tree.insert_child(Do("piece there?", robot), 1)
    return tree


def run_tree(tree: Behaviour) -> str:
    tree.tick_once()
    while tree.status is Status.RUNNING:  # a Retry says RUNNING between two tries
        tree.tick_once()
    return DONE if tree.status is Status.SUCCESS else GIVEN_UP


def compare(title: str, table: Table, make: Callable[[Robot], Behaviour]) -> None:
    robots = Robot(), Robot()
    tree = make(robots[1])
    ends = run_table(table, robots[0]), run_tree(tree)
    print(f"{title}\n  state machine: {ends[0]}; {', '.join(robots[0].did)}")
    print(f"  tree:          {ends[1]}; {', '.join(robots[1].did)}")
    print(f"  the same: {robots[0].did == robots[1].did and ends[0] == ends[1]}")


def main() -> None:
    compare("The plain cycle", SHORT, short_tree)
    compare("\nWith a sensor and a retry", LONG, long_tree)
    touched = [state for state, row in SHORT.items() if LONG[state] != row]
    nodes = [sum(1 for _ in make(Robot()).iterate()) for make in (short_tree, long_tree)]
    print("\nWhat the change took")
    changed = f"{len(touched)} old one changed ({touched[0]})"
    print(f"  state machine: from {len(SHORT)} to {len(LONG)} states, {changed}")
    print(f"  tree:          from {nodes[0]} to {nodes[1]} nodes, none of the old leaves changed")


if __name__ == "__main__":
    spoken(main)
