"""Lesson 5: a condition that is waited for, a time limit, a retry, and what a retry cannot help."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from importlib import import_module

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.composites import Sequence
from py_trees.decorators import Decorator

from arboleda.engine import RETRYABLE
from arboleda.model.messages import Reason
from arboleda_class.lessons import spoken

lesson = import_module("02_first_tree")

TRIES = 3
HELPS = {"not gripped"}  # causes that another try may mend


class Cell:
    """What the sensors and the motor of a made-up cell do at which simulated time."""

    def __init__(self, *, piece_at_s: float = 0.0, misses: int = 0, motor_fault: bool = False) -> None:
        self.clock = lesson.Clock()
        self.piece_at_s = piece_at_s
        self.misses = misses
        self.motor_fault = motor_fault
        self.cause = ""

    def fail(self, leaf: Behaviour, cause: str) -> Status:
        self.cause = leaf.feedback_message = cause
        self.clock.say(f"{leaf.name}: {cause}")
        return Status.FAILURE


class PieceThere(Behaviour):
    """A condition that is waited for: RUNNING until the sensor sees a piece."""

    def __init__(self, cell: Cell) -> None:
        super().__init__("piece there?")
        self.cell = cell

    def update(self) -> Status:
        if self.cell.clock.now < self.cell.piece_at_s:
            return Status.RUNNING
        self.cell.clock.say("piece there: yes")
        return Status.SUCCESS


class Within(Decorator):
    """Its child, at most so many simulated seconds: py_trees' own Timeout reads the wall clock."""

    def __init__(self, child: Behaviour, cell: Cell, seconds: float, cause: str) -> None:
        super().__init__(f"within {seconds:g} s", child)
        self.cell = cell
        self.seconds = seconds
        self.cause = cause
        self.until = 0.0

    def initialise(self) -> None:
        self.until = self.cell.clock.now + self.seconds

    def update(self) -> Status:
        if self.decorated.status is not Status.RUNNING:
            return self.decorated.status
        if self.cell.clock.now < self.until:
            return Status.RUNNING
        return self.cell.fail(self, self.cause)  # py_trees ends the child that still runs


class Grip(lesson.Timed):
    """Close the effector; it may miss the piece, and a broken motor does nothing at all."""

    def __init__(self, cell: Cell) -> None:
        super().__init__("grip", cell.clock, 0.5)
        self.cell = cell

    def update(self) -> Status:
        if super().update() is Status.RUNNING:
            return Status.RUNNING
        if self.cell.motor_fault:
            return self.cell.fail(self, "motor fault")
        if self.cell.misses:
            self.cell.misses -= 1
            return self.cell.fail(self, "not gripped")
        return Status.SUCCESS


class RetryWhere(Decorator):
    """Its child again after a failure, TRIES times in all, where `helps` says that this may mend it."""

    def __init__(self, child: Behaviour, helps: Callable[[], bool]) -> None:
        super().__init__(f"up to {TRIES} times", child)
        self.helps = helps
        self.tries = 0

    def initialise(self) -> None:
        self.tries = 0

    def update(self) -> Status:
        if self.decorated.status is not Status.FAILURE:
            return self.decorated.status
        self.tries += 1
        return Status.RUNNING if self.tries < TRIES and self.helps() else Status.FAILURE


def build(cell: Cell, helps: Callable[[], bool]) -> Behaviour:
    children = [
        Within(PieceThere(cell), cell, 2.0, "no piece in 2 s"),
        RetryWhere(Grip(cell), helps),
        lesson.Timed("move to station", cell.clock, 1.0),
    ]
    return Sequence("pick", memory=True, children=children)


def cases() -> Iterator[tuple[str, Cell, bool]]:
    """What happens, and whether the retry looks at the cause."""
    yield "The piece comes late, and the first grip misses it:", Cell(piece_at_s=1.5, misses=1), True
    yield "No piece comes:", Cell(piece_at_s=60.0), True
    yield "The motor is broken, and everything is tried again:", Cell(motor_fault=True), False
    yield "The motor is broken, and the retry looks at the cause:", Cell(motor_fault=True), True


def main() -> None:
    for title, cell, looks in cases():
        print(title)
        tree = build(cell, lambda cell=cell, looks=looks: not looks or cell.cause in HELPS)
        outcome = lesson.run(tree, cell.clock)
        tried = cell.cause if outcome is Status.FAILURE else ""
        print(f"  {outcome.value} after {cell.clock.now:g} s{tried and f': {tried}'}\n")
    print("Arboleda gives a command again after:", ", ".join(r.value for r in Reason if r in RETRYABLE))
    print("It does not after:", ", ".join(r.value for r in Reason if r not in RETRYABLE))


if __name__ == "__main__":
    spoken(main)
