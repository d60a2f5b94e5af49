"""Side of `rival`: the recipe as a tree of py_trees that is ticked for each line, and never else."""

from __future__ import annotations

import sys

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.composites import Sequence

from .rival_lines import DONE, begin, end, recipe


class Mail:
    """The last word of the robot."""

    done = False


class Step(Behaviour):
    """Begins a step, then is RUNNING until that is done."""

    def __init__(self, kind: str, mail: Mail) -> None:
        super().__init__(kind)
        self._mail = mail

    def initialise(self) -> None:
        self._mail.done = False
        begin(self.name)

    def update(self) -> Status:
        return Status.SUCCESS if self._mail.done else Status.RUNNING


def main() -> None:
    mail = Mail()
    tree = Sequence("storage", memory=True, children=[Step(kind, mail) for kind in recipe()])
    for line in sys.stdin:
        mail.done = line.rstrip() == DONE
        tree.tick_once()
        if tree.status is Status.SUCCESS:
            end()


if __name__ == "__main__":
    main()
