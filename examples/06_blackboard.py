"""Lesson 6: leaves that share memory by a blackboard, and what goes wrong when all cells share one."""

from __future__ import annotations

from importlib import import_module

from py_trees.behaviour import Behaviour
from py_trees.blackboard import Blackboard
from py_trees.common import Access, Status
from py_trees.composites import Sequence

from arboleda_class.lessons import spoken

paths = import_module("01_paths")


class FindPath(Behaviour):
    """Writes the path to the blackboard; FAILURE where the words mean none."""

    def __init__(self, cell: str, code: str, namespace: str | None) -> None:
        super().__init__(f"{cell}: find {code}")
        self.code = code
        self.board = self.attach_blackboard_client(name=self.name, namespace=namespace)
        self.board.register_key(key="path", access=Access.WRITE)

    def update(self) -> Status:
        try:
            self.board.path = paths.find("malla_A", self.code)
        except paths.PathError as error:
            print(f"  {self.name}: {error}")
            return Status.FAILURE
        print(f"  {self.name}: wrote {self.board.path}")
        return Status.SUCCESS


class Walk(Behaviour):
    """Reads the path from the blackboard; it does not know who wrote it, or when."""

    def __init__(self, cell: str, namespace: str | None) -> None:
        super().__init__(f"{cell}: walk")
        self.board = self.attach_blackboard_client(name=self.name, namespace=namespace)
        self.board.register_key(key="path", access=Access.READ)

    def update(self) -> Status:
        print(f"  {self.name}: {' -> '.join(map(str, self.board.path))}")
        return Status.SUCCESS


class Pause(Behaviour):
    """RUNNING for one tick, so that another tree gets its turn."""

    def initialise(self) -> None:
        self.ticked = False

    def update(self) -> Status:
        ticked, self.ticked = self.ticked, True
        return Status.SUCCESS if ticked else Status.RUNNING


def tree(cell: str, code: str, namespace: str | None) -> Behaviour:
    children = [FindPath(cell, code, namespace), Pause(f"{cell}: pause"), Walk(cell, namespace)]
    return Sequence(cell, memory=True, children=children)


def tick_in_turn(*trees: Behaviour) -> None:
    """What a loop over several cells does: one tick each, again and again."""
    for each in trees:
        each.tick_once()
    while any(each.status is Status.RUNNING for each in trees):
        for each in trees:
            if each.status is Status.RUNNING:
                each.tick_once()


def show_overwritten() -> None:
    print("Two cells, one key:")
    tick_in_turn(tree("sis_a", "0A", None), tree("sis_b", "2C", None))


def show_left_over() -> None:
    print("\nA walk that finds what another task left behind:")
    tick_in_turn(Walk("sis_c", None))


def show_namespaces() -> None:
    print("\nA namespace per cell:")
    Blackboard.clear()
    tick_in_turn(tree("sis_a", "0A", "sis_a"), tree("sis_b", "2C", "sis_b"))
    print(f"  on the board: {Blackboard.storage}")


def show_declared() -> None:
    print("\nA key that was not declared, and one that nobody wrote:")
    walk = Walk("sis_d", "sis_d")
    for key in ("station", "path"):
        try:
            getattr(walk.board, key)
        except (AttributeError, KeyError) as error:
            print(f"  {key}: {type(error).__name__}")


class Job:
    """The other way: an object that is handed to the leaves of one tree and to nobody else."""

    def __init__(self) -> None:
        self.path: tuple[int, ...] | None = None


def show_handed_over() -> None:
    print("\nAn object per task:")
    jobs = {"sis_a": Job(), "sis_b": Job()}
    jobs["sis_a"].path, jobs["sis_b"].path = paths.find("malla_A", "0A"), paths.find("malla_B", "2C")
    print(f"  sis_a: {jobs['sis_a'].path}; sis_b: {jobs['sis_b'].path}; a new task: {Job().path}")


def main() -> None:
    for show in (show_overwritten, show_left_over, show_namespaces, show_declared, show_handed_over):
        show()


if __name__ == "__main__":
    spoken(main)
