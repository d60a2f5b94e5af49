"""Further bugs that others planted and nobody found; most of theirs are an invariant's own mutant."""

from __future__ import annotations

from arboleda.core.cell import CellRun
from arboleda.core.intake import Intake
from arboleda.core.verbs.held_cells import _not_yet
from arboleda.departures.leaving import leaves_unkept
from arboleda.dispatch import evidence
from arboleda.model.messages import Course
from arboleda.resume.trail import Knowledge, put_back
from arboleda.resume.walk_back import WalkBack, fate
from arboleda.trees.node_state import command_kept
from arboleda.trees.part_places import Places
from arboleda.trees.tree_run import TreeRun
from arboleda.views import view
from arboleda.views.changes import changed
from arboleda.views.chronicle import Chronicle

from .bodies import PLANTED_PARTS
from .leaders import PLANTED_LEADERS
from .mutant import SHARED, edit, mutant
from .restarts import DIES, FULL, PLANTED_RESTARTS

PLANTED = (
    *PLANTED_LEADERS,
    *PLANTED_PARTS,
    *PLANTED_RESTARTS,
    mutant(
        "tasks_go_to_the_best_cell",
        "A task whose step takes longer than ever counts as nearly done.",
        edit(Course.remaining_s, "min(at + seconds, following)", "min(at + seconds, self.seconds)"),
        any_of=True,
    ),
    mutant(
        "ends_are_proven",
        "A position from before the command counts at joints.",
        edit(evidence._look_at_goal, "if place is None and not _tells(report, entry.sets):", "if False:"),
        seeds=SHARED,
        weather={"operator_hold": 30.0, "operator_resume": 60.0, "loss": 10.0},
        likely=8,
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
        likely=34,
    ),
    mutant(
        "verbs_do_what_they_say",
        "A stop does not cancel homing and release.",
        edit(CellRun.stop, "self.context.commands.cancel_all()", ""),
        edit(TreeRun.drop, "self._context.commands.cancel_all()", ""),
        weather={"operator_stop": 60.0, "operator_home": 60.0, "operator_release": 60.0, "reboot": 10.0},
    ),
    mutant(
        "accepted_tasks_are_kept",
        "The oldest task is forgotten though it runs.",
        edit(Intake.remember, "if task.ended_at is not None", ""),
        weather={"flood_of_tasks": 3.0},
    ),
    mutant(
        "accepted_is_found_again",
        "A task is accepted though it could not be kept.",
        edit(leaves_unkept, "isinstance(message, Heartbeat)", "not isinstance(message, Command)"),
        weather=FULL,
    ),
    mutant(
        "no_step_is_done_twice",
        "What is proven done after a restart is given again.",
        edit(WalkBack.go_on, "finding.fates.get(step)", "None"),
        weather=DIES,
        likely=6,
    ),
    mutant(
        "tasks_go_on_from_what_was_kept",
        "It is not kept that the command of a step is done, as where that ended while its cell was held.",
        edit(command_kept, '"done": entry.state is State.DONE', '"done": False'),
        weather={"operator_hold": 40.0, "operator_resume": 20.0},
        likely=8,
    ),
    mutant(
        "no_step_is_done_twice",
        "A task that is walked back begins at the first step of its sequence.",
        edit(put_back, "next(going, node.children[0])", "node.children[0]"),
        weather=DIES,
    ),
    mutant(
        "no_step_is_done_twice",
        "A board may have taken any commands since where its task stands was kept.",
        edit(Knowledge.explains, "if now == before:", "if True:"),
        weather={**DIES, "power_cut": 12.0, "slow_disk": 12.0},
        likely=28,
    ),
    mutant(
        "nothing_is_dropped",
        "What a board never took counts as done after a restart.",
        edit(fate, "return Fate.UNTAKEN", "return Fate.DONE"),
        weather={**DIES, "loss": 20.0},
        likely=14,
    ),
    mutant(
        "books_of_parts_are_true",
        "Of the parts in a rack only the last one is known.",
        edit(
            Places._move,
            "self._parts[target] = max(parts, 0)",
            "self._parts = {**dict.fromkeys(self._parts, 0), target: max(parts, 0)}",
        ),
        weather="none",
    ),
    mutant(
        "verbs_do_what_they_say",
        "A station keeps its part though somebody takes it out.",
        edit(Places.set, "self._parts |= parts", "pass"),
        weather={"operator_unload": 60.0},
    ),
    mutant(
        "screens_show_what_is",
        "The time line says when an act was seen, not when it was done.",
        edit(Chronicle.see, 'unix_s - (snapshot["at"] - act["at"])', "unix_s"),
        weather={"operator_hold": 10.0},
    ),
    mutant(
        "screens_show_what_is",
        "Who hears only what is new hears nothing of what changes.",
        edit(changed, "before.get(key, missing) != value", "before.get(key, missing) is missing"),
        weather="none",
    ),
    mutant(
        "screens_show_what_is",
        "To resume is not shown as refused.",
        edit(view._refused, "is not None", "is not None and request.verb is not Verb.RESUME"),
        weather="none",
    ),
    mutant(
        "screens_show_what_is",
        "Advice is shown without whom it is for.",
        edit(view._advice, '"scope": advice.scope', '"scope": ""'),
        weather={"operator_hold": 10.0},
    ),
    mutant(
        "screens_show_what_is",
        "A cell whose queue is paused is said to be blocked.",
        edit(view.standing, '"paused" if only_paused else "blocked"', '"blocked"'),
        weather={"operator_stop": 5.0},
    ),
    mutant(
        "verbs_are_refused_rightly",
        "A task is resumed before its devices are heard.",
        edit(_not_yet, "cell.awaits is None", "True"),
        weather={**DIES, "operator_resume": 20.0},
    ),
)
