"""Sentences of the judge to a student: ends of tasks, counts of acts, faults of the plant."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from arboleda.dashboard.wording import REASONS
from arboleda.web.languages import FIRST, contents
from arboleda_proofs.campaigns.words import fault_said
from arboleda_proofs.simulator.faults import Fault

LONG_S = 3600.0  # of a fault that outlasts every trial
BOARD_WORDS = contents(FIRST, REASONS)


def task_is(task: str, end: str) -> str:
    """The sentence that a task is in a state, or has come to an end, by its word."""
    sentences = {
        "queued": f"{task} is queued",
        "running": f"{task} has begun",
        "done": f"{task} is done",
        "recovered": f"{task} is done in another way",
        "held": f"{task} is held",
        "failed": f"{task} has failed",
        "cancelled": f"{task} was cancelled",
        "refused": f"{task} was refused",
        "lost": f"{task} has not come to the plant",
    }
    return sentences.get(end, f"{task} has not ended")


def task_is_to(task: str, ends: Sequence[str]) -> str:
    """The sentence on the ends that a task may have, by their words."""
    return " or ".join(
        _is_to(each, end) for each, end in zip((task, *["it"] * len(ends)), ends, strict=False)
    )


def _is_to(task: str, end: str) -> str:
    sentences = {
        "done": f"{task} is to be done",
        "recovered": f"{task} is to be done in another way",
        "held": f"{task} is to be held",
        "failed": f"{task} is to fail",
        "cancelled": f"{task} is to be cancelled",
        "refused": f"{task} is to be refused",
    }
    return sentences[end]


def often(act: str, times: int, least: int, most: int) -> str:
    """The sentence on an act that is done otherwise than `least` to `most` times; a person is only a name."""
    if " " not in act:
        to_be = f"{act} is to be asked {_times(least, most)}" if most else f"{act} is not to be asked"
        return f"{to_be}, and is asked {_times(times, times)}" if times else f"{to_be}, and never is"
    to_be = f"'{act}' is to be done {_times(least, most)}" if most else f"'{act}' is not to be done"
    return f"{to_be}; it is done {_times(times, times)}" if times else f"{to_be}; it is not done"


def _times(least: int, most: int) -> str:
    """`once`, `3 times`, `2 to 3 times`."""
    if least != most:
        return f"{least} to {most} times"
    return "once" if least == 1 else f"{least} times"


def fault_is(fault: Fault) -> str:
    """The sentence on what befalls the plant; a kind that no exercise has is as `prove` writes it."""
    target = fault.target
    sentences = {
        "delay": "messages come late",
        "driver_alarm": f"the motor driver of {target} gives an alarm",
        "duplicate": "messages come twice",
        "ends_late": f"{target} takes {fault.amount:g} s longer",
        "forgets": f"{target} restarts and forgets what was switched",
        "gives_up": f"{target} gives up what it does",
        "lost_steps": f"an axis of {target} slips",
        "never_ends": f"{target} goes on and on",
        "only_says_done": f"{target} says done and does nothing",
        "opened_device": f"somebody takes out what {target} holds",
        "reboot": f"the board of {target} restarts",
        "refuses": f"{target} refuses its orders",
        "stale_fact": f"{target} goes on telling an old value",
    }
    return sentences.get(fault.kind) or fault_said(fault)


def befell(fault: Fault) -> str:
    """The line of a story on a fault, with its seconds where it ends in the trial."""
    if not fault.seconds or fault.seconds >= LONG_S:
        return f"FAULT: {fault_is(fault)}"
    return f"FAULT for {fault.seconds:g} s: {fault_is(fault)}"


def in_english(text: str) -> str:
    """A sentence with the words of boards, which are Spanish, in English."""
    for word, english in BOARD_WORDS.items():
        text = text.replace(f"({word})", f"({english})")
    return text


def in_story(line: str, translate: Callable[[str], str]) -> str:
    """A line of a story, its time and what happened then, in another language."""
    time, joint, what = line.partition(" s  ")
    return f"{time}{joint}{translate(what)}"
