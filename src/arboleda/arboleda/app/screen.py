"""What the terminal shows: a live table where it is one, else a line per change."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from rich.console import Console
from rich.live import Live
from rich.table import Table
from rich.text import Text

from arboleda.core.messages import TaskChanged, TaskState

REFRESH_HZ = 8
STYLES = {
    TaskState.QUEUED: "dim",
    TaskState.RUNNING: "cyan",
    TaskState.DONE: "green",
    TaskState.FAILED: "bold red",
    TaskState.CANCELLED: "yellow",
    TaskState.REFUSED: "red",
}


class Screen:
    """Shows `snapshot()` while the `with` block runs, and every change of a task."""

    def __init__(self, console: Console, snapshot: Callable[[], dict[str, Any]]) -> None:
        self.console = console
        self._live = Live(
            console=console,
            get_renderable=lambda: table(snapshot()),
            refresh_per_second=REFRESH_HZ,
            transient=True,
        )
        self._steps: dict[str, str | None] = {}

    def __enter__(self) -> Screen:
        if self.console.is_terminal:
            self._live.start()
        return self

    def __exit__(self, *_: object) -> None:
        if self.console.is_terminal:
            self._live.stop()

    def changed(self, change: TaskChanged) -> None:
        """One line for one change of a task."""
        line = Text(f"{change.state.value:<9} ", style=STYLES[change.state])
        line.append(f"{change.text}", style="bold")
        if change.sentence:
            line.append(f"  {change.sentence}" + (f" ({change.reason.value})" if change.reason else ""))
        self.console.print(line)

    def stepped(self, snapshot: dict[str, Any]) -> None:
        """Without a terminal the table's place is taken by one line per step of a tree."""
        if self.console.is_terminal:
            return
        for cell in snapshot["cells"]:
            if cell["step"] != self._steps.get(cell["name"]) and cell["step"] is not None:
                self.console.print(Text(f"  {cell['name']}: {cell['step']}"))
            self._steps[cell["name"]] = cell["step"]


def table(snapshot: dict[str, Any]) -> Table:
    """Cell, task, step, arm joints, mobile node and elapsed time, one row per cell."""
    robots = {robot["name"]: robot for robot in snapshot["robots"]}
    drawn = Table(title=f"plant {snapshot['plant']}", title_justify="left")
    for heading in ("cell", "task", "step", "arm joints", "effector", "mobile", "elapsed", "queue"):
        drawn.add_column(heading, no_wrap=True)
    for cell in snapshot["cells"]:
        drawn.add_row(*_row(cell, robots[cell["arm"]], robots[cell["mobile"]]))
    return drawn


def _row(cell: dict[str, Any], arm: dict[str, Any], mobile: dict[str, Any]) -> list[Text]:
    task = cell["task"]
    obstacle = arm["obstacle"] or mobile["obstacle"] if task is None else None
    style = {"idle": "", "execute": "cyan"}.get(cell["state"], "red")
    texts = [
        cell["name"],
        task["text"] if task else cell["state"],
        cell["step"] or cell["waiting_for"] or obstacle or "",
        "?" if arm["q"] is None else " ".join(map(position, arm["q"], arm["units"])),
        effector(arm),
        "?" if mobile["node"] is None else f"node {mobile['node']}",
        f"{task['elapsed_s']:5.1f} s" if task else "",
        str(len(cell["queue"])),
    ]
    return [Text(text, style=style) for text in texts]


def position(value: float, unit: str) -> str:
    """A joint position (rad or m) for a person: degrees or millimetres."""
    return f"{math.degrees(value):5.1f}°" if unit == "rad" else f"{value * 1000:3.0f} mm"


def effector(arm: dict[str, Any]) -> str:
    return {None: "?", True: "on", False: "off"}[arm["effector"]]


def summary(results: dict[str, TaskChanged], seconds: dict[str, float]) -> Table:
    """How the asked tasks ended, in the order they were asked for; keys are task ids."""
    drawn = Table(title="summary", title_justify="left")
    for heading in ("task", "outcome", "time", "reason"):
        drawn.add_column(heading)
    for task, change in results.items():
        took = f"{seconds[task]:.1f} s" if task in seconds else ""
        outcome = Text(change.state.value, style=STYLES[change.state])
        drawn.add_row(Text(change.text), outcome, took, Text(change.sentence))
    return drawn
