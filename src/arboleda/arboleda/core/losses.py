"""Losses of a held task: what leaves it nothing to go on with, so that it can only be abandoned."""

from __future__ import annotations

from typing import TYPE_CHECKING

from arboleda.model.messages import Failure, Reason
from arboleda.model.sentence import Phrase
from arboleda.trees.walk_back import NO_PART

if TYPE_CHECKING:
    from .cell import CellRun

LET_GO = Phrase("part.let_go", "{arm} let go of its part on the operator's word")
HOMED_MEANWHILE = Phrase("cell.homed_meanwhile", "{arm} was homed meanwhile")


def miss_part(run: CellRun) -> None:
    """Note that an effector was opened meanwhile, by whomever."""
    gone = run.context.failures.opened_effector()
    if gone is not None and run.task is not None and not run.stranded:
        run.trouble = gone
        run.stranded = NO_PART(arm=run.context.parts.opened_by or "")
        run.dirty = True


def let_go(run: CellRun, robot: str) -> None:
    """Note that the operator has an effector opened, which had a part of the task."""
    if run.task is not None and robot in run.context.parts.holding:
        run.trouble = run.trouble or Failure(reason=Reason.PART_LOST, sentence=LET_GO(arm=robot))
        run.stranded = NO_PART(arm=robot)


def uproot(run: CellRun, robot: str) -> None:
    """Note that a robot that goes from pose to pose is homed, and so is not where the task left it."""
    if run.task is not None and robot in run.cell.workspaces and run.context.devices.has(robot):
        run.stranded = HOMED_MEANWHILE(arm=robot)
