"""Story of a broken invariant: its rule, the observation, the faults, the last seconds."""

from __future__ import annotations

import re

from rich.console import Console
from rich.text import Text

from arboleda.model.counting import counted
from arboleda_proofs.simulator.run import Result

from .plant_notes import notes
from .plants import Plant
from .setting import rules
from .words import fault_said

LINES = 40  # of the timeline
LONG_NUMBER = re.compile(r"-?\d+\.\d{5,}(?:e-?\d+)?")


def breach(console: Console, result: Result, plant: Plant) -> None:
    """Print the broken invariant, its time, its rule and the observation."""
    if result.broken is None:
        return
    name = result.broken.invariant
    _say(
        console,
        f"seed {result.seed} breaks {name} after {result.seconds:.3f} s of plant {plant.name}",
        "bold red",
    )
    _say(console, f"  must hold  {rules(plant).get(name, '')}")
    _say(console, f"  was seen   {result.broken.sentence}")


def faults(console: Console, result: Result, injected: int) -> None:
    """Print the faults that are enough to break the invariant."""
    needed = len(result.faults)
    if not needed:
        _say(console, f"  faults     none of {injected:,} is needed")
        return
    all_of_them = counted(injected, "fault")
    one = f"  faults     1 of {all_of_them} is enough:"
    _say(console, one if needed == 1 else f"  faults     {needed:,} of {all_of_them} are enough:")
    for fault in result.faults:
        _say(console, f"{fault.at:10.3f}  {fault_said(fault)}", "yellow")


def plant(console: Console, needed: Plant) -> None:
    """Print the part of a plant that nobody has on disk that is needed."""
    if not needed.texts:
        return
    for number, (name, text) in enumerate(needed.texts.items()):
        _say(console, f"  {name}" if number else "  plant      as much of its file as is enough:")
        for line in text.splitlines():
            _say(console, f"    {line}", "yellow")
    for note in notes([needed]):
        _say(console, f"  note       {note}")


def timeline(console: Console, result: Result) -> None:
    """Print the last events before the breach."""
    lines = result.lines[-LINES:]
    if not lines:
        return
    _say(console, f"  the last {len(lines)} of the things that happened before it, with the time in s:")
    for line in lines:
        style = "yellow" if line[12:].lower().startswith("fault") else "dim"
        _say(console, _cropped(LONG_NUMBER.sub(_rounded, line), console.width), style)


def _rounded(number: re.Match[str]) -> str:
    return f"{float(number[0]):.4f}"


def _cropped(line: str, width: int) -> str:
    return line if len(line) <= width else f"{line[: width - 3]}..."


def _say(console: Console, line: str, style: str = "") -> None:
    console.print(Text(line, style=style), soft_wrap=True)
