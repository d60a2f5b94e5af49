"""Numbers, faults and ends of tasks, written for a person."""

from __future__ import annotations

from collections.abc import Collection

from arboleda.model.counting import counted
from arboleda_proofs.simulator.faults import Fault


def seeds(done: Collection[int]) -> str:
    """`20 seeds (1 to 20)`."""
    which = f" ({min(done)} to {max(done)})" if len(done) > 1 else ""
    return counted(len(done), "seed") + which


def short(number: int) -> str:
    """A large number for a narrow place: `812`, `34.2 k`, `5.61 M`."""
    for unit, size in (("G", 10**9), ("M", 10**6), ("k", 10**3)):
        if number >= size:
            return f"{number / size:.3g} {unit}"
    return str(number)


def fault_words(fault: Fault) -> str:
    """The fault with its target and its duration; without its time."""
    much = f"{fault.amount:g}" if fault.amount else ""
    lasting = f"for {fault.seconds:.3f} s" if fault.seconds else ""
    return "  ".join(part for part in (fault.kind, fault.target, fault.word, much, lasting) if part)


def times(least: int, most: int | None = None) -> str:
    """The number of times that something is done: `once`, `3 times`, `2 to 3 times`."""
    if most is not None and most != least:
        return f"{least} to {most} times"
    return "once" if least == 1 else f"{least} times"


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


def task_is_to(ends: Collection[str]) -> str:
    """The sentence on the ends that a task may have, by their words."""
    sentences = {
        "done": "it is to be done",
        "recovered": "it is to be done in another way",
        "held": "it is to be held",
        "failed": "it is to fail",
        "cancelled": "it is to be cancelled",
        "refused": "it is to be refused",
    }
    return " or ".join(sentences[each] for each in ends)
