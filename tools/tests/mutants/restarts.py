"""Bugs of a plant that starts on what an earlier one left."""

from __future__ import annotations

from arboleda.core.intake import Intake
from arboleda.core.task_desk import TaskDesk
from arboleda.core.task_queue import TaskQueue
from arboleda.departures.leaving import is_too_late, leaves_unkept
from arboleda.model.task import Task
from arboleda.resume.walk_back import WalkBack

from .mutant import edit, mutant

DIES = {"crash_in_step": 12.0, "plant_crash": 4.0}
FULL = {"full_disk": 8.0, "plant_crash": 2.0}

RESTARTS = (
    mutant(
        "accepted_is_found_again",
        "What is taken back is not remembered by its id.",
        edit(Intake.take_back, "self.remember(task)", "pass"),
        weather=DIES,
    ),
    mutant(
        "asked_again_is_the_same_task",
        "A task that has ended is kept without its text.",
        edit(Task.of.__func__, "text=record.text", 'text=""'),
        weather={**DIES, "double_submit": 20.0},
        likely=12,
    ),
    mutant(
        "ends_once_over_all_starts",
        "A plant that starts tells of all tasks that it knows.",
        edit(TaskDesk.take_back, "if task.state is not was:", "if True:"),
        weather=DIES,
    ),
    mutant(
        "no_step_is_done_twice",
        "A task that was at work begins from its first step.",
        edit(Intake.take_back, "Task.of(record, task_text.parse(", "Task(record.id, task_text.parse("),
        weather=DIES,
    ),
    mutant(
        "tasks_go_on_from_what_was_kept",
        "Nobody looks whether a device has booted since its task was kept.",
        edit(WalkBack._more_commands, "if belief.boot_id != knowledge.boot:", "if False:"),
        weather={**DIES, "reboot": 20.0},
    ),
    mutant(
        "nothing_unkept_leaves",
        "A plant that can keep nothing more goes on telling its robots what to do.",
        edit(leaves_unkept, "ends_motion(message)", "isinstance(message, Command)"),
        weather=FULL,
    ),
    mutant(
        "nothing_late_leaves",
        "What was decided is sent however long the disk took.",
        edit(is_too_late, "now - plant.now > plant.away_after_s", "False"),
        weather={"slow_disk": 12.0},
    ),
    mutant(
        "nothing_moves_after_a_restart",
        "What waited starts again by itself.",
        edit(TaskQueue.take_back, "not self._cell.goes_on", "False"),
        weather=DIES,
    ),
)
PLANTED_RESTARTS = (
    mutant(
        "parts_are_taken_and_put_where_they_can_be",
        "A task that was at work waits again.",
        edit(Intake.take_back, "Task.of(record, task_text.parse(", "Task(record.id, task_text.parse("),
        weather=DIES,
    ),
)
