"""Words for each of the operators' verbs, for the command line, the HTTP API and the documentation."""

from __future__ import annotations

from dataclasses import dataclass

from arboleda.model.messages import Verb


@dataclass(frozen=True, kw_only=True)
class VerbWords:
    """Words on a verb: `brief` is one line; `does` and `refused` are the full text, in Markdown."""

    scopes: tuple[str, ...]
    brief: str
    does: str
    refused: str


PLANT = "plant"  # the scope that is meant where none is named
ABOUT: dict[Verb, VerbWords] = {
    Verb.STOP: VerbWords(
        scopes=(PLANT, "cell", "robot"),
        brief="Stop (software): halt and latch every robot; running tasks fail, effectors keep their "
        "state. No safety function.",
        does="halts and latches every robot of the scope: stop (software), no safety function. A "
        "running task fails (`stopped`), effectors keep their state, the queue pauses. Latches "
        "survive a restart of the plant",
        refused="never for a known name",
    ),
    Verb.CLEAR: VerbWords(
        scopes=(PLANT, "cell", "robot"),
        brief="Take the stop latch off once every online robot is still; moves nothing.",
        does="takes the latches off; nothing moves",
        refused="while an online robot of the scope still moves; where nothing is stopped",
    ),
    Verb.RESET: VerbWords(
        scopes=(PLANT, "cell"),
        brief="After clear, make the cell ready again; moves nothing.",
        does="after `clear`, makes the cell ready; nothing moves, the queue stays paused",
        refused="before `clear`; while a latch is left; while a cell of the scope is clearing",
    ),
    Verb.HOLD: VerbWords(
        scopes=(PLANT, "cell"),
        brief="Halt at once; task, part and zones are kept for resume.",
        does="halts at once; task, part and zones are kept, deadlines pause, the queue pauses",
        refused="where no task runs",
    ),
    Verb.RESUME: VerbWords(
        scopes=(PLANT, "cell"),
        brief="Go on at the step that was held, or with a queue that pauses.",
        does="gives the interrupted step anew (a mobile drives the nodes that are left); without a "
        "task, lets a paused queue go on",
        refused="after a fault: `retry` or `abandon`",
    ),
    Verb.CANCEL: VerbWords(
        scopes=("cell", "task id"),
        brief="End a task as cancelled, a running one once its robots have stopped.",
        does="a waiting task leaves the queue; a running one is halted, the cell recovers, and it is "
        "`cancelled` once the robot has said that it stopped",
        refused="for a task that has ended, or that nobody knows; where no task runs",
    ),
    Verb.RETRY: VerbWords(
        scopes=("cell",),
        brief="After a fault, do the failed step again with a new command.",
        does="after a fault, gives the step that failed anew, with a new command; where the recovery "
        "failed, recovers anew",
        refused="where nothing failed",
    ),
    Verb.ABANDON: VerbWords(
        scopes=("cell",),
        brief="After a fault, end the task as failed and recover: bring the part back, go home.",
        does="ends the task as failed and recovers: the part back to the pick-up, effector off, home; "
        "where the recovery failed, leaves everything as it is",
        refused="where nothing is held",
    ),
    Verb.RELEASE: VerbWords(
        scopes=("cell", "arm"),
        brief="Open the effector where it is; a part that it holds falls.",
        does="switches the effector off where it is; **a part that it holds falls**. Nothing opens with "
        "`--by-hand`: you declare that you have taken the part out, even where the device still says that it "
        "holds it",
        refused="while a task runs or something still moves; for an arm that is offline, in fault or not "
        "homed, but not by hand; by hand where nothing is known to be held",
    ),
    Verb.HOME: VerbWords(
        scopes=("cell", "robot"),
        brief="Run a robot's homing routine.",
        does="runs the homing routine, of a cell without what is only drawn or has no homing. `--by-hand`: "
        "nothing moves, you declare that the robot stands at its reference",
        refused="while its cell works on a task, the robot is latched, in fault, offline or only drawn, "
        "or another robot holds a zone that the arm may cross on its way; while it is being "
        "homed; by hand where the robot reports itself whether it is homed (not with "
        "`assume_homed`), or says that it is not; only by hand below `evidence: ids`",
    ),
    Verb.OVERRIDE: VerbWords(
        scopes=("zone",),
        brief="Free a quarantined zone, where a robot may still stand; this is journalled.",
        does="frees a quarantined zone, where a robot may still stand",
        refused="for a zone that is not quarantined, or whose robot has not given up its work or is being"
        " homed: `stop` its cell first",
    ),
    Verb.UNLOAD: VerbWords(
        scopes=(PLANT, "cell", "station"),
        brief="Say that parts were taken out of the rack, 'sis_a 7' out of one station; moves nothing.",
        does="says that parts were taken out of the rack; they are no longer drawn there, and nothing moves",
        refused="where no part is known to be",
    ),
    Verb.ANSWER: VerbWords(
        scopes=("person and answer",),
        brief="Answer what a task asks a person, e.g. `operator done`.",
        does="answers what a running task asks a person; the task goes on with it",
        refused="where that person is asked nothing, and for an answer that was not offered",
    ),
}
