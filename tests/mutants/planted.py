"""Further bugs that others planted and nobody found; most of theirs are an invariant's own mutant."""

from __future__ import annotations

from arboleda.core import evidence
from arboleda.core.cell import CellRun
from arboleda.core.intake import Intake
from arboleda.core.tree_run import TreeRun

from .mutant import SHARED, edit, mutant

PLANTED = (
    mutant(
        "ends_are_proven",
        "A position from before the command counts at joints.",
        edit(evidence._look_at_goal, "if place is None and not _tells(report, entry.sets):", "if False:"),
        seeds=SHARED,
        weather={"operator_hold": 30.0, "operator_resume": 60.0, "loss": 10.0},
    ),
    mutant(
        "proofs_end_commands",
        "A device fault fails only motions.",
        edit(
            evidence._device,
            "if report.state is MotionState.FAULT:",
            "if report.state is MotionState.FAULT and entry.is_work:",
        ),
        weather={"driver_alarm": 60.0},
        likely=28,
    ),
    mutant(
        "verbs_do_what_they_say",
        "A stop does not cancel homing and release.",
        edit(CellRun.stop, "self.context.cancel_all()", ""),
        edit(TreeRun.drop, "self._context.cancel_all()", ""),
        weather={"operator_stop": 60.0, "operator_home": 60.0, "operator_release": 60.0, "reboot": 10.0},
    ),
    mutant(
        "accepted_tasks_are_kept",
        "The oldest task is forgotten though it runs.",
        edit(Intake.remember, "if known.ended_at is not None", ""),
        weather={"flood_of_tasks": 3.0},
    ),
)
