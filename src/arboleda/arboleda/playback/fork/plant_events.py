"""What a plant did, as a row of things that can be held beside those of another run; pure."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import zip_longest
from typing import Any

from arboleda.model.commands import LABELS
from arboleda.recorder.plain_data import TYPE

Words = Callable[[Any], str]
UNTOLD = frozenset({TYPE, "robot", *LABELS})  # of a command: its line says them, or nobody compares them
TASK = "task "
NUMBERS = 4  # digits of a number


@dataclass(frozen=True, kw_only=True)
class PlantEvent:
    """Something that a plant did at a time of its clock.

    `stream`: whose row it stands in, as a robot or a task, and of a task its `cell`; `what` is compared,
    `said` is for people.
    """

    at: float
    stream: str
    what: str
    said: str
    cell: str | None = None


@dataclass(frozen=True, kw_only=True)
class Pair:
    """The same in both runs, or what only one of them did."""

    recorded: PlantEvent | None
    fork: PlantEvent | None

    @property
    def at(self) -> float:
        return min(each.at for each in (self.recorded, self.fork) if each is not None)

    @property
    def either(self) -> PlantEvent:
        found = self.recorded or self.fork
        assert found is not None
        return found

    @property
    def same(self) -> bool:
        return None not in (self.recorded, self.fork)


def happenings(at: float, messages: Iterable[Mapping[str, Any]], words: Words) -> Iterator[PlantEvent]:
    """What messages, as plain data, say that the plant did: commands, changes of tasks, answers to operators.

    `words` makes a sentence of one that is plain data.
    """
    for row in messages:
        if row[TYPE] == "TaskChanged" and row["task"]:
            why = words(row.get("sentence"))
            said = f"{row['state']} {row['text']} (id {row['task']})" + (f": {why}" if why else "")
            what = f"{row['state']} {row.get('reason', '')}"
            yield PlantEvent(at=at, stream=f"{TASK}{row['task']}", what=what, said=said, cell=row["cell"])
        elif row[TYPE] == "OperatorAnswer":
            why = words(row.get("refusal"))
            said = f"{row['verb']} {row['scope']}" + (f" is refused: {why}" if why else " is done")
            what = f"refused {(row.get('refusal') or {}).get('key')}"
            yield PlantEvent(at=at, stream=f"{row['verb']} {row['scope']}", what=what, said=said)
        elif "robot" in row and "id" in row:
            yield _command(at, row)


def _command(at: float, row: Mapping[str, Any]) -> PlantEvent:
    values = {key: value for key, value in row.items() if key not in UNTOLD}
    shown = " ".join(f"{key}={_short(value)}" for key, value in values.items())
    what = json.dumps([row[TYPE], values], sort_keys=True)
    said = f"{row['robot']} {row[TYPE]} {shown}".strip()
    return PlantEvent(at=at, stream=row["robot"], what=what, said=said)


def _short(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.{NUMBERS}g}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_short, value)) + "]"
    return str(value)


def beside(recorded: Iterable[PlantEvent], fork: Iterable[PlantEvent], until: float) -> list[Pair]:
    """Both runs beside each other, in the order of their times.

    In each stream they are the same up to the first that is another one; when they happened is no part of it.
    What is only in the fork, and later than `until`, the record may have had no time for: it is left out.
    """
    ours, theirs = _streams(recorded), _streams(fork)
    pairs: list[Pair] = []
    for stream in {**ours, **theirs}:
        pairs += _beside(ours.get(stream, []), theirs.get(stream, []), until)
    return sorted(pairs, key=lambda pair: pair.at)


def _streams(happened: Iterable[PlantEvent]) -> dict[str, list[PlantEvent]]:
    streams: dict[str, list[PlantEvent]] = {}
    for each in happened:
        streams.setdefault(each.stream, []).append(each)
    return streams


def _beside(recorded: list[PlantEvent], fork: list[PlantEvent], until: float) -> Iterator[Pair]:
    same = True
    for ours, theirs in zip_longest(recorded, fork):
        if same and ours is None and theirs.at > until:
            return
        same = same and ours is not None and theirs is not None and ours.what == theirs.what
        if same:
            yield Pair(recorded=ours, fork=theirs)
            continue
        for pair in (Pair(recorded=ours, fork=None), Pair(recorded=None, fork=theirs)):
            if pair.recorded or pair.fork:
                yield pair
