"""Common words of campaigns that kill plants: options, ends of tasks, times, and what is kept."""

from __future__ import annotations

import json
from argparse import ArgumentParser
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path

from arboleda.store.task_rows import TaskRow
from arboleda_bench.result import percentile
from frame.words import parser

from .deeds import Deed


def options_of(usage: str | None, target: str, what: str, *, seed: str) -> ArgumentParser:
    """The options of a target of make: how many, which ones a seed draws, and how fast the robots are."""
    options = parser(usage, prog=f"make {target}", seed=seed)
    options.add_argument(f"--{what}", type=int, default=1000, help="how many [1000]")
    options.add_argument("--rate", type=float, default=8.0, help="how many times as fast the robots are [8]")
    return options


def states(rows: Iterable[TaskRow]) -> dict[str, int]:
    """Number of tasks by their end."""
    ends = Counter(row.state if row.reason is None else f"{row.state} ({row.reason})" for row in rows)
    return dict(sorted(ends.items()))


def spread(seconds: Sequence[float]) -> str:
    return f"p50 {percentile(seconds, 50):.2f} s, p99 {percentile(seconds, 99):.2f} s"


def keep_deeds(folder: Path, deeds: Iterable[Deed]) -> None:
    (folder / "deeds.jsonl").write_text("".join(f"{json.dumps(deed.data())}\n" for deed in deeds))


def keep_wrong(folder: Path, deeds: Iterable[Deed], changes: Iterable[object]) -> None:
    """Keep what a run with something wrong is looked at by: deeds, and each change of leaders or verb."""
    keep_deeds(folder, deeds)
    (folder / "changes.txt").write_text("".join(f"{each}\n" for each in changes))
    print(f"logs, deeds and changes are in {folder}")
