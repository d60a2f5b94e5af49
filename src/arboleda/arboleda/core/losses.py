"""Losses of a held task: acts of an operator after which the task can only be abandoned."""

from __future__ import annotations

from arboleda.model.messages import Failure, Reason
from arboleda.model.sentence import Phrase
from arboleda.resume.walk_back import NO_PART

from .cell import CellRun

LET_GO = Phrase("part.let_go", "{arm} let go of its part on the operator's word")
HOMED_MEANWHILE = Phrase("cell.homed_meanwhile", "{arm} was homed meanwhile")


def let_go(run: CellRun, robot: str) -> None:
    """Note that the operator has an effector opened that held a part of the task."""
    if robot in run.context.parts.holding:
        lost = Failure(reason=Reason.PART_LOST, sentence=LET_GO(arm=robot))
        run.lose(NO_PART(arm=robot), run.trouble or lost)


def uproot(run: CellRun, robot: str) -> None:
    """Note that a robot with poses is homed, and so is not where the task left it."""
    if robot in run.cell.workspaces and run.context.devices.has(robot):
        run.lose(HOMED_MEANWHILE(arm=robot))
