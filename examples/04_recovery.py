"""Lesson 4: what happens when the work fails: Selector[main, recovery], its trap, and what a task became."""

from __future__ import annotations

from importlib import import_module

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.composites import Selector, Sequence

from arboleda_class.lessons import spoken

lesson = import_module("02_first_tree")


class Task:
    """What becomes of a piece of work; the first cause of a failure counts, later ones are consequences."""

    def __init__(self) -> None:
        self.cause: str | None = None

    def fail(self, cause: str) -> None:
        self.cause = self.cause or cause

    @property
    def outcome(self) -> str:
        return f"failed ({self.cause})" if self.cause else "done"


class Breaks(lesson.Timed):
    """A step that goes wrong when its time is over."""

    def __init__(self, name: str, clock: lesson.Clock, seconds: float, task: Task, cause: str) -> None:
        super().__init__(name, clock, seconds)
        self.task = task
        self.cause = cause

    def update(self) -> Status:
        if super().update() is Status.RUNNING:
            return Status.RUNNING
        self.clock.say(f"{self.name}: {self.cause}")
        self.feedback_message = self.cause
        self.task.fail(self.cause)
        return Status.FAILURE


def build(clock: lesson.Clock, task: Task, *, broken: bool, memory: bool) -> Behaviour:
    """Pick and place, and the way back where it fails; `memory` is that of the Selector."""
    place = ("main: move to station", clock, 1.0)
    main = [
        lesson.Timed("main: effector on", clock, 0.5),
        Breaks(*place, task, "ra1 stopped short") if broken else lesson.Timed(*place),
        lesson.Timed("main: effector off", clock, 0.5),
    ]
    recovery = [
        lesson.Timed("recovery: carry the part back", clock, 1.0),
        lesson.Timed("recovery: effector off", clock, 0.5),
        lesson.Timed("recovery: move home", clock, 1.0),
    ]
    sequences = [
        Sequence("main", memory=True, children=main),
        Sequence("recovery", memory=True, children=recovery),
    ]
    return Selector("storage", memory=memory, children=sequences)


def show(title: str, *, broken: bool, memory: bool) -> None:
    clock, task = lesson.Clock(), Task()
    tree = build(clock, task, broken=broken, memory=memory)
    print(title)
    end = lesson.run(tree, clock, at_most_s=6.0)
    if end is Status.RUNNING:
        print(f"  given up after {clock.now:g} s: the recovery never gets to its end\n")
        tree.stop(Status.INVALID)
        return
    print(
        f"  the tree says {end.value}; main is {tree.children[0].status.value}; the task is {task.outcome}\n"
    )


def main() -> None:
    show("All goes well:", broken=False, memory=True)
    show("A Selector without memory:", broken=True, memory=False)
    show("A Selector with memory:", broken=True, memory=True)


if __name__ == "__main__":
    spoken(main)
