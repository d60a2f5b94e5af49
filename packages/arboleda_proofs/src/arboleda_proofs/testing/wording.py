"""Wording of a failed test: the sentence, then what happened last."""

from __future__ import annotations

import re
from collections.abc import Iterable

from arboleda.model.counting import counted
from arboleda.views import view
from arboleda_proofs.campaigns.words import fault_said
from arboleda_proofs.simulator.invariants import Invariant
from arboleda_proofs.simulator.judged_world import BrokenInvariant, JudgedWorld
from arboleda_proofs.simulator.run import Result

from .desk import Handle
from .seeds import Seeds

LAST = 40  # lines of the timeline
LONG_NUMBER = re.compile(r"-?\d+\.\d{5,}(?:e-?\d+)?")


def breach(broken: BrokenInvariant, watched: JudgedWorld) -> str:
    """The text for a broken invariant: its rule, and what led to it."""
    return "\n".join(
        [_broken(broken, watched.seconds, watched.invariants), "", *timeline(watched.trace.lines)]
    )


def seed(result: Result, seeds: Seeds, injected: int) -> str:
    """The text for a seed that broke an invariant: the faults that are enough for it, and what led to it."""
    assert result.broken is not None
    again = f"sim.seeds(1, first={result.seed}, cycles={seeds.cycles}, faults={seeds.level!r})"
    few = len(result.faults)
    enough = [f"{few} of {counted(injected, 'fault')} {'is' if few == 1 else 'are'} enough:"] if few else []
    listed = [f"{fault.at:10.3f}  {fault_said(fault)}" for fault in result.faults]
    return "\n".join(
        [
            f"seed {result.seed}: {_broken(result.broken, result.seconds, seeds.invariants)}",
            *enough,
            *listed,
            f"to see it again: {again}",
            "",
            *timeline(result.lines),
        ]
    )


def never(seconds: float, tasks: Iterable[Handle], watched: JudgedWorld) -> str:
    """The text for a test that waited in vain, with the present state of its tasks and the cells."""
    first = f"what the test waits for did not come true in {seconds:g} s"
    return "\n".join([first, *standing(tasks, watched), "", *timeline(watched.trace.lines)])


def standing(tasks: Iterable[Handle], watched: JudgedWorld) -> list[str]:
    """One line per task of the test and per cell."""
    lines = [f"task {task.text!r}: {_joined(task.state, task.reason, task.sentence)}" for task in tasks]
    for cell in view.snapshot(watched.world.plant)["cells"]:
        why = cell["held_by"] or cell["waiting_for"] or cell["not_ready"]
        lines.append(f"cell {cell['name']}: {_joined(cell['state'], cell['step'], why)}")
    return lines


def timeline(lines: list[str]) -> list[str]:
    """The last of the lines, under a heading."""
    shown = [LONG_NUMBER.sub(_rounded, line) for line in lines[-LAST:]]
    older = f"; sim.timeline() has {len(lines)}" if len(lines) > len(shown) else ""
    return [f"the last {counted(len(shown), 'thing')} that happened, with the time in s{older}:", *shown]


def _broken(broken: BrokenInvariant, seconds: float, invariants: Iterable[Invariant]) -> str:
    rules = {each.name: " ".join(each.sentence.split()) for each in invariants}
    rule = f"\nmust hold: {rules[broken.invariant]}" if broken.invariant in rules else ""
    return f"{broken.invariant} is broken at {seconds:.3f} s: {broken.sentence}{rule}"


def _rounded(number: re.Match[str]) -> str:
    return f"{float(number[0]):.4f}"


def _joined(*words: object) -> str:
    return ", ".join(str(word) for word in words if word)
