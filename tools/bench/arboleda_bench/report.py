"""Report of benchmarks: a table for people, JSON for programs."""

from __future__ import annotations

import os
import platform
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any

from rich.table import Table

from arboleda import __version__

from .result import Figure, Result

COLUMNS = ("figure", "ours", "floor", "ratio", "aim", "")


@dataclass(frozen=True, kw_only=True)
class Run:
    """Run of one benchmark: its beginning, the revision of the code, and its result or why there is none.

    `load`: the average number of programs that wanted a core in the minute before.
    """

    name: str
    began: datetime
    load: float
    revision: str
    outcome: Result | str


def table(result: Result) -> Table:
    """The table of one benchmark's figures; a figure that misses its aim is marked."""
    made = Table(box=None, pad_edge=False)
    for column in COLUMNS:
        made.add_column(column, justify="left" if column in ("figure", "aim", "") else "right")
    for figure in result.figures:
        made.add_row(*_cells(figure), style="yellow" if figure.reached is False else "")
    return made


def as_json(runs: Sequence[Run], *, quick: bool) -> dict[str, Any]:
    """The figures as JSON, with the machine on which they were measured."""
    return {
        "arboleda": __version__,
        "date": runs[0].began.date().isoformat(),
        "machine": machine(),
        "quick": quick,
        "benches": {
            each.name: _plain(each, each.outcome) for each in runs if isinstance(each.outcome, Result)
        },
        "not_measured": {each.name: each.outcome for each in runs if isinstance(each.outcome, str)},
    }


def machine() -> dict[str, Any]:
    """The properties of this machine that one needs to compare its figures."""
    return {
        "processor": _processor(),
        "cores": os.cpu_count(),
        "system": f"{platform.system()} {platform.release()}",
        "python": platform.python_version(),
    }


def _cells(figure: Figure) -> tuple[str, ...]:
    ratio = figure.ratio
    return (
        figure.name,
        f"{number(figure.ours)} {figure.unit}".strip(),
        "-" if figure.floor is None else f"{number(figure.floor)} {figure.unit}".strip(),
        "-" if ratio is None else f"{number(ratio)}x",
        str(figure.aim or "-"),
        {True: "reached", False: "falls short", None: ""}[figure.reached],
    )


def number(value: float) -> str:
    """A number with three significant digits, without an exponent."""
    if value == int(value) or abs(value) >= 100:
        return f"{value:.0f}"
    return f"{value:.3g}" if abs(value) >= 0.001 else f"{value:.6f}"


def _plain(run: Run, result: Result) -> dict[str, Any]:
    figures = [
        {
            "name": each.name,
            "unit": each.unit,
            "ours": each.ours,
            "floor": each.floor,
            "ratio": each.ratio,
            "aim": str(each.aim) if each.aim else None,
            "reached": each.reached,
        }
        for each in result.figures
    ]
    began = run.began.isoformat(timespec="seconds")
    return {
        "began": began,
        "load": run.load,
        "revision": run.revision,
        "figures": figures,
        "notes": list(result.notes),
    }


def _processor() -> str:
    """The name of the processor as Linux has it."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.machine()
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()
