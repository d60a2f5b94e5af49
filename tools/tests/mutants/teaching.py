"""Mutants of cells that are taught by hand."""

from __future__ import annotations

from arboleda.core.cell import CellRun
from arboleda.core.manual_mode import ManualMode
from arboleda.core.teaching import Press, Teaching
from arboleda.kinds.joints.motion import JointMotion

from .mutant import edit, mutant

TEACHERS = {"teach": 6.0}
TEACHING = (
    mutant(
        "nothing_is_told_to_move_in_manual_but_what_is_held",
        "A button counts as held until it is let go of.",
        edit(Teaching.take, "until=jog.at + HOLD_S", "until=jog.at + 60.0"),
        edit(Press.hold, "jog.at + HOLD_S", "jog.at + 60.0"),
        edit(Teaching.look, "press.jog.at + FRESH_S", "press.jog.at + 60.0"),
        weather=TEACHERS,
    ),
    mutant(
        "no_task_begins_in_manual",
        "A cell that is taught goes on with its queue.",
        edit(CellRun.not_ready, "if self.manual.teaching is not None:", "if False:"),
        edit(ManualMode.begin, "self._queue.paused = True", "self._queue.paused = False"),
        weather=TEACHERS,
    ),
    mutant(
        "a_lost_teacher_stops_the_robot",
        "Goals are as far as the teacher wants to go, and nobody halts them.",
        edit(JointMotion.stride, "if part <= 1:", "if min(lengths) >= 0:"),
        edit(Teaching._end_press, "self._context.commands.cancel(press.entry)", "pass"),
        weather={"teach": 2.0},
        cycles=20,
    ),
)
