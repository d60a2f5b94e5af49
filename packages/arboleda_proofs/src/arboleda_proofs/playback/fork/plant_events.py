"""The acts of a plant as a row of happenings that can be compared with those of another run; pure."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import zip_longest
from typing import Any

from arboleda.engine.inspection import LABELS
from arboleda.model.verbs import Verb, as_text
from arboleda.recorder import plain_data

Words = Callable[[Any], str]
UNTOLD = frozenset(
    {plain_data.TYPE, "robot", *LABELS}
)  # keys of a command that its line has anyway, or that are not compared
TASK = "task "
NUMBERS = 4  # digits of a number


@dataclass(frozen=True, kw_only=True)
class PlantEvent:
    """Something that a plant did at a time of its clock.

    `stream` names the row that it stands in: a robot or a task; `cell` is that of a task. `what` is compared,
    `text` is for people.
    """

    at: float
    stream: str
    what: str
    text: str
    cell: str | None = None


@dataclass(frozen=True, kw_only=True)
class Pair:
    """A happening in both runs, or in only one of them."""

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
    """The happenings in messages that are plain data: commands, changes of tasks, answers to operators.

    `words` turns a sentence that is plain data into text.
    """
    for row in messages:
        if row[plain_data.TYPE] == "TaskChanged" and row["task"]:
            why = words(row.get("sentence"))
            sentence = f"{row['state']} {row['text']} (id {row['task']})" + (f": {why}" if why else "")
            what = f"{row['state']} {row.get('reason', '')}"
            yield PlantEvent(at=at, stream=f"{TASK}{row['task']}", what=what, text=sentence, cell=row["cell"])
        elif row[plain_data.TYPE] == "OperatorAnswer":
            why = words(row.get("refusal"))
            arguments = tuple((name, value) for name, value in row.get("arguments", ()))
            request = f"{row['verb']} {as_text(Verb(row['verb']), row['scope'], arguments)}"
            sentence = request + (f" is refused: {why}" if why else " is done")
            what = f"refused {(row.get('refusal') or {}).get('key')}"
            yield PlantEvent(at=at, stream=request, what=what, text=sentence)
        elif "robot" in row and "id" in row:
            yield _command(at, row)


def _command(at: float, row: Mapping[str, Any]) -> PlantEvent:
    values = {key: value for key, value in row.items() if key not in UNTOLD}
    shown = " ".join(f"{key}={_short(value)}" for key, value in values.items())
    what = json.dumps([row[plain_data.TYPE], values], sort_keys=True)
    sentence = f"{row['robot']} {row[plain_data.TYPE]} {shown}".strip()
    return PlantEvent(at=at, stream=row["robot"], what=what, text=sentence)


def _short(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.{NUMBERS}g}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_short, value)) + "]"
    return str(value)


def beside(recorded: Iterable[PlantEvent], fork: Iterable[PlantEvent], until: float) -> list[Pair]:
    """Both runs beside each other, in the order of their times.

    Within a stream both runs are the same up to the first difference; times do not count. Happenings of the
    fork alone that are later than `until` are left out, as the record may have ended before them.
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
