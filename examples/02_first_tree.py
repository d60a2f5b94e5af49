"""Lesson 2: the first tree: find the path, go home, walk point by point, grip, let go. No ROS, no robot."""

from __future__ import annotations

from argparse import ArgumentParser
from importlib import import_module
from pathlib import Path

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.composites import Sequence
from py_trees.display import ascii_tree

from arboleda.cli.draw import draw
from arboleda.views.tree_view import rows
from arboleda_class.lessons import said, spoken

paths = import_module("01_paths")  # an import statement cannot name a file that begins with a digit

TICK_S = 0.5  # simulated seconds from one tick to the next
EDGE_S = 1.0  # simulated seconds from one node to its neighbour


class Clock:
    """Simulated time: it passes when somebody moves it, so an hour takes no longer than a second."""

    def __init__(self) -> None:
        self.now = 0.0

    def say(self, text: str) -> None:
        print(f"{self.now:6.1f} s  {text}")


class Job:
    """What the leaves of one tree share: the words that were asked for, and the path they mean."""

    def __init__(self, grid: str, code: str) -> None:
        self.grid = grid
        self.code = code
        self.nodes: tuple[int, ...] = ()


class Timed(Behaviour):
    """RUNNING for so many simulated seconds, then SUCCESS."""

    def __init__(self, name: str, clock: Clock, seconds: float) -> None:
        super().__init__(name)
        self.clock = clock
        self.seconds = seconds
        self.until = 0.0

    def initialise(self) -> None:  # called when a tick finds the leaf not running yet
        self.clock.say(self.name)
        self.until = self.clock.now + self.seconds

    def update(self) -> Status:  # called by every tick; it answers at once and never waits
        return Status.SUCCESS if self.clock.now >= self.until else Status.RUNNING


class FindPath(Behaviour):
    """SUCCESS with the path in the job; FAILURE, with the reason, where the words mean none."""

    def __init__(self, job: Job) -> None:
        super().__init__("find path")
        self.job = job

    def update(self) -> Status:
        try:
            self.job.nodes = paths.find(self.job.grid, self.job.code)
        except paths.PathError as error:
            self.feedback_message = str(error)
            return Status.FAILURE
        return Status.SUCCESS


class Walk(Behaviour):
    """Along the path of the job, point by point; EDGE_S from each to the next."""

    def __init__(self, clock: Clock, job: Job) -> None:
        super().__init__("walk path")
        self.clock = clock
        self.job = job
        self.reached = 0
        self.started = 0.0

    def initialise(self) -> None:
        self.started, self.reached = self.clock.now, 0
        self.clock.say(f"walk path: node {self.job.nodes[0]}")

    def update(self) -> Status:
        while (self.clock.now - self.started) >= EDGE_S * (self.reached + 1):
            self.reached += 1
            self.clock.say(f"walk path: node {self.job.nodes[self.reached]}")
            if self.reached == len(self.job.nodes) - 1:
                return Status.SUCCESS
        return Status.RUNNING


def build(clock: Clock, job: Job) -> Behaviour:
    """The cycle; `memory` lets a Sequence go on where it was instead of asking every child anew."""
    children = [
        FindPath(job),
        Timed("home", clock, 2.0),
        Walk(clock, job),
        Timed("effector on", clock, 0.5),
        Timed("effector off", clock, 0.5),
    ]
    return Sequence("cycle", memory=True, children=children)


def run(tree: Behaviour, clock: Clock, at_most_s: float = 60.0) -> Status:
    """Tick until the tree has an outcome; RUNNING where it has none in time."""
    until = clock.now + at_most_s
    tree.tick_once()
    while tree.status is Status.RUNNING and clock.now < until:
        clock.now += TICK_S
        tree.tick_once()
    return tree.status


def ask(question: str) -> str:
    """The answer of a person: before the first tick, as no leaf may wait for one."""
    try:
        return input(question)
    except EOFError:  # nobody is there
        return ""


def main() -> None:
    parser = ArgumentParser(description=__doc__)
    parser.add_argument("--grid", help="e.g. malla_A; asked for where it is left out")
    parser.add_argument("--code", help="e.g. 0B; asked for where it is left out")
    parser.add_argument("--picture", metavar="NAME", help="write NAME.svg and NAME.png of the finished tree")
    words = parser.parse_args()
    grid = words.grid or ask("grid (malla_A, malla_B, malla_C)? ")
    code = words.code or ask("code (0A to 2C)? ")
    clock, job = Clock(), Job(grid, code)
    tree = build(clock, job)
    print(ascii_tree(tree))
    outcome = run(tree, clock)
    print(f"\n{ascii_tree(tree, show_status=True)}")
    drawn = [{**row, "name": said(str(row["name"]))} for row in rows(tree, clock.now)]
    for format in ("svg", "png") if words.picture else ():
        Path(f"{words.picture}.{format}").write_bytes(draw(drawn, format))
    raise SystemExit(0 if outcome is Status.SUCCESS else 1)


if __name__ == "__main__":
    spoken(main)
