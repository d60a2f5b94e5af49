"""Words for each of the operators' verbs, for the command line, the HTTP API and the documentation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from arboleda.model.verbs import Devices, Scope, Verb


@dataclass(frozen=True, kw_only=True)
class ByHand:
    """Words on a verb that only declares what a person has done; `option` is for the command line."""

    label: str
    page: str
    asks: str
    option: str


@dataclass(frozen=True, kw_only=True)
class VerbWords:
    """Words on a verb: `brief` is one line; `does` and `refused` are the full text, in Markdown.

    On the page it is called `label` and explained by `page`; `asks` is what a person must confirm there
    first, one question after the other, `sure` on the command line. `called` is its name there, where that is
    not its word. `arguments` says what each is.
    """

    label: str
    page: str
    brief: str
    does: str
    refused: str
    asks: tuple[str, ...] = ()
    sure: str = ""
    called: str = ""
    arguments: Mapping[str, str] = field(default_factory=dict)
    by_hand: ByHand | None = None


MAY_MOVE = ("{of}: robots may move. Is everybody clear?",)
ABOUT: dict[Verb, VerbWords] = {
    Verb.STOP: VerbWords(
        label="Stop (software)",
        page="Halts and latches every robot of the choice. Running tasks fail, effectors keep their state.",
        called="stop (software)",
        brief="Stop (software): halt and latch every robot; running tasks fail, effectors keep their "
        "state. No safety function.",
        does="halts and latches every robot of the scope: stop (software), no safety function. A "
        "running task fails (`stopped`), effectors keep their state, the queue pauses. Latches "
        "survive a restart of the plant",
        refused="never for a known name",
    ),
    Verb.CLEAR: VerbWords(
        label="Clear",
        page="Takes the latch of a stop off, once the robots are still. Moves nothing. Then comes reset.",
        brief="Take the stop latch off once every online robot is still; moves nothing.",
        does="takes the latches off; nothing moves",
        refused="while an online robot of the scope still moves; where nothing is stopped",
    ),
    Verb.RESET: VerbWords(
        label="Reset",
        page="Makes a stopped cell idle again, after clear. Moves nothing. Its queue stays paused until "
        "resume.",
        brief="After clear, make the cell ready again; moves nothing.",
        does="after `clear`, makes the cell ready; nothing moves, the queue stays paused",
        refused="before `clear`; while a latch is left; while a cell of the scope is clearing",
    ),
    Verb.HOLD: VerbWords(
        label="Hold",
        page="Halts at once. Task, part and zones are kept for resume.",
        brief="Halt at once; task, part and zones are kept for resume.",
        does="halts at once; task, part and zones are kept, deadlines pause, the queue pauses",
        refused="where no task runs",
    ),
    Verb.RESUME: VerbWords(
        label="Resume",
        page="Goes on with the step that was held, or lets a paused queue run. Robots may move.",
        asks=MAY_MOVE,
        brief="Go on at the step that was held, or with a queue that pauses.",
        does="gives the interrupted step anew (a mobile drives the nodes that are left); without a "
        "task, lets a paused queue go on",
        refused="after a fault: `retry` or `abandon`",
    ),
    Verb.CANCEL: VerbWords(
        label="Cancel task",
        page="Ends the task as cancelled. A running one is halted, its part is carried back.",
        asks=MAY_MOVE,
        brief="End a task as cancelled, a running one once its robots have stopped.",
        does="a waiting task leaves the queue; a running one is halted, the cell recovers, and it is "
        "`cancelled` once the robot has said that it stopped",
        refused="for a task that has ended, or that nobody knows; where no task runs",
    ),
    Verb.RETRY: VerbWords(
        label="Retry step",
        page="Does the failed step again with a new command. Robots move. Its queue stays paused until "
        "resume.",
        asks=MAY_MOVE,
        brief="After a fault, do the failed step again; the queue stays paused until resume.",
        does="after a fault, gives the step that failed anew, with a new command; where the recovery "
        "failed, recovers anew; the queue stays paused until `resume`",
        refused="where nothing failed",
    ),
    Verb.ABANDON: VerbWords(
        label="Abandon task",
        page="Ends the task as failed and recovers, the part goes back and the arm home. Without a task it "
        "leaves all as it is.",
        asks=MAY_MOVE,
        brief="After a fault, end the task as failed and recover: bring the part back, go home.",
        does="ends the task as failed and recovers: the part back to the pick-up, effector off, home; "
        "where the recovery failed, leaves everything as it is",
        refused="where nothing is held",
    ),
    Verb.RELEASE: VerbWords(
        label="Release part",
        page="Opens the effector where it is. A part that it holds falls.",
        asks=("A part that the arm holds will fall. Open the effector of {of}?",),
        by_hand=ByHand(
            label="Part taken out by hand",
            page="Opens nothing. You declare that you have taken the part out.",
            asks="Have you taken the part out of {of}? The plant will believe it.",
            option="Open nothing: you declare that you have taken the part out.",
        ),
        brief="Open the effector where it is; a part that it holds falls.",
        does="switches the effector off where it is; **a part that it holds falls**. Nothing opens with "
        "`--by-hand`: you declare that you have taken the part out, even where the device still says that it "
        "holds it",
        refused="while a task runs or something still moves; for an arm that is offline, in fault or not "
        "homed, but not by hand; by hand where nothing is known to be held",
    ),
    Verb.HOME: VerbWords(
        label="Home",
        page="Runs the homing routine. The robot moves.",
        asks=("{of} will move to find its reference. Is the way free?",),
        by_hand=ByHand(
            label="Homed by hand",
            page="Moves nothing. You declare that the robot stands at its reference, a mobile robot at home.",
            asks="Does {of} stand at its reference: a mobile robot at home, a machine without switches at "
            "its zero? The plant will believe it.",
            option="Move nothing: you declare that the robot stands at its reference, "
            "a mobile robot at home.",
        ),
        brief="Run a robot's homing routine.",
        does="runs the homing routine, of a cell without what is only drawn or has no homing. `--by-hand`: "
        "nothing moves, you declare that the robot stands at its reference, a mobile robot at its `home`",
        refused="while its cell works on a task, the robot is latched, in fault, offline, only drawn or "
        "being homed, or another robot holds a zone that the arm may cross on its way. By hand it is "
        "refused where the robot reports itself whether it is homed (not with `assume_homed`), or says that "
        "it is not. Below `evidence: ids` and without switches, a robot is homed by hand only",
    ),
    Verb.DO: VerbWords(
        label="Do",
        page="Has a device do one of its own verbs, as opening a door. It moves.",
        arguments={"work": "One of its verbs, and a value for each of its parameters."},
        brief="Have a device do one of its own verbs, e.g. `mill open`; it moves.",
        does="has a device of a cell that rests do one of its own verbs, as the plant file declares it",
        refused="while its cell works or is taught, the device takes no command, a need of the verb is not "
        "met, or a robot is in the zone into which it leads. What asks something or holds a part is refused "
        "always",
    ),
    Verb.OVERRIDE: VerbWords(
        label="Override",
        page="Frees a quarantined zone, where a robot may still stand.",
        asks=(
            "A robot may still stand in {of}. Have you seen with your own eyes that it is free?",
            "Free {of} now? Other robots may drive into it at once. This is written into the journal with "
            "your act.",
        ),
        sure="A robot may still stand in {scope}. Have you seen that it is free?",
        brief="Free a quarantined zone, where a robot may still stand; this is journalled.",
        does="frees a quarantined zone, where a robot may still stand",
        refused="for a zone that is not quarantined, or whose robot has not given up its work or is being"
        " homed: `stop` its cell first",
    ),
    Verb.UNLOAD: VerbWords(
        label="Parts taken out",
        page="Parts were taken out of places or the rack: the plant forgets them. Moves nothing.",
        arguments={
            "place": "Only this place.",
            "station": "Only the station with this number.",
        },
        brief="Say that parts were taken out of all places and the rack, or of one place or station; moves "
        "nothing.",
        does="says that parts were taken out of places or the rack; they are no longer drawn there, and "
        "nothing moves",
        refused="where no part is known to be",
    ),
    Verb.LOAD: VerbWords(
        label="Parts put there",
        page="Parts were put at a place by hand. Moves nothing.",
        arguments={"place": "The place.", "parts": "How many are there; without it as many as it holds."},
        brief="Say that parts were put at a place of a cell, as in `lab nest`; moves nothing.",
        does="says that parts were put at a place by hand: as many as it holds, or the number that is told; "
        "nothing moves",
        refused="for what is no place of the cell, and for more than it holds",
    ),
    Verb.ANSWER: VerbWords(
        label="Answer",
        page="Answers what a running task asks a person. The task goes on with it.",
        arguments={
            "answer": "One of the answers that are offered.",
            "question": "Only if this is still what is asked, by its id.",
        },
        brief="Answer what a task asks a person, e.g. `operator done`.",
        does="answers what a running task asks a person; the task goes on with it",
        refused="where that person is asked nothing, and for an answer that was not offered",
    ),
    Verb.TEACH: VerbWords(
        label="Teach",
        page="Begins the manual mode of a cell for one person: its queue pauses, no task starts, and nothing "
        "moves but what that person holds.",
        arguments={"teacher": "The name of who teaches, which all screens show."},
        brief="Begin to teach a cell by hand, as in `sis_a ana`; its queue pauses.",
        does="begins the manual mode of a cell for one person: its queue pauses, no task starts, its zones "
        "are held, and nothing moves but what that person holds. It ends by `automatic`, by a stop, or when "
        "nobody touches it for some minutes",
        refused="while a task runs or is held, something still moves, somebody else teaches, a robot is not "
        "heard, or a robot of another cell is where one of this cell may get",
    ),
    Verb.AUTOMATIC: VerbWords(
        label="End teaching",
        page="Ends the manual mode of a cell; what moves is halted. Its queue stays paused until resume.",
        brief="End the teaching of a cell; its queue stays paused until resume.",
        does="ends the manual mode of a cell: what moves is halted, the queue stays paused until `resume`",
        refused="for a cell that nobody teaches",
    ),
}


SCOPES = {
    Scope.PLANT: "the plant",
    Scope.CELL: "a cell",
    Scope.TASK: "a task",
    Scope.ZONE: "a zone",
    Scope.PERSON: "a person",
}


def scope_words(verb: Verb) -> tuple[str, ...]:
    """The scopes of a verb, in words."""
    robot = "an arm" if verb.row.devices is Devices.HOLDERS else "a robot"
    words = {**SCOPES, Scope.ROBOT: robot}
    return tuple(words[scope] for scope in verb.row.scopes)


def argument_names(verb: Verb) -> tuple[str, ...]:
    """The arguments of a verb beside its scope, over HTTP."""
    return (*(["by_hand"] if verb.row.by_hand else []), *(each.name for each in verb.arguments))


def page_words() -> dict[str, dict[str, str]]:
    """The page's words on verbs, in English, as in the file of a language."""
    words: dict[str, dict[str, str]] = {"verb": {}, "does": {}, "asks": {}}
    for verb, about in ABOUT.items():
        words["verb"][verb.value], words["does"][verb.value] = about.label, about.page
        words["asks"] |= dict(zip((verb.value, f"{verb.value}_again"), about.asks, strict=False))
        if about.by_hand is not None:
            name = f"{verb.value}_by_hand"
            words["verb"][name], words["does"][name] = about.by_hand.label, about.by_hand.page
            words["asks"][name] = about.by_hand.asks
    return words
