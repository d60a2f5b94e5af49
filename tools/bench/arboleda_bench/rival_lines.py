"""Lines of `rival`: what a process says to who measures it, and the names of the recipe's steps."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from arboleda.drivers import FollowPath, MoveJoints, SetEffector
from arboleda.plant_file.loader import load

from . import steps

TASK, DONE, END = "task", "done", "end"
KINDS = {FollowPath: "drive", MoveJoints: "move", SetEffector: "switch"}


def begin(kind: str) -> None:
    """Say that a step begins."""
    _say(f"do {kind}")


def end() -> None:
    """Say that the task is over."""
    _say(END)


def recipe() -> list[str]:
    """The kinds of the steps of a task in the plant file that the command line names."""
    (cell,) = load(Path(sys.argv[1])).cells
    return [KINDS[type(step)] for step in steps.storage(cell)]


def _say(line: str) -> None:
    os.write(sys.stdout.fileno(), f"{line}\n".encode())
