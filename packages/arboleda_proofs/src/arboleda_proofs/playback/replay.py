"""Replay of a record: the plant as it began, stepped with the recorded events, and compared."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from arboleda.engine import Plant
from arboleda.model.plant_model import PlantModel
from arboleda.model.revision import Versions
from arboleda.recorder.plain_data import TYPE
from arboleda.recorder.preamble import Beginning
from arboleda.recorder.state import state_of
from arboleda.recorder.steps import RecordedStep, hash_of, outcome


@dataclass(frozen=True)
class Difference:
    """First difference of a replay from the record: the field and both values, None for a missing one."""

    field: str
    recorded: Any
    now: Any


@dataclass(frozen=True)
class ReplayedStep:
    """Step of a replay; `number` counts from 1. `difference` is set if it did not do as recorded."""

    number: int
    recorded: RecordedStep
    difference: Difference | None = None


def plant_of(beginning: Beginning, model: PlantModel, versions: Versions | None = None) -> Plant:
    """The plant as it was at the beginning of a record; `versions` are those that it took while it ran."""
    return Plant(
        model,
        epoch=beginning.epoch,
        now=beginning.now,
        memory=beginning.memory,
        kept=beginning.kept,
        versions=versions,
    )


def replayed(plant: Plant, steps: Iterable[RecordedStep]) -> Iterator[ReplayedStep]:
    """Make each step again, up to and including the first that differs; later ones would prove nothing."""
    for number, step in enumerate(steps, start=1):
        try:
            result = outcome(plant.step(step.now, step.events), state_of(plant, number))
        except Exception as error:  # noqa: BLE001 - the plant that was recorded went on: it is a difference
            yield ReplayedStep(number, step, Difference("step", "made", f"{type(error).__name__}: {error}"))
            return
        if hash_of(result) != step.hash:
            yield ReplayedStep(number, step, first_difference(step.result, result))
            return
        yield ReplayedStep(number, step)


def first_difference(recorded: Any, now: Any, field: str = "") -> Difference:
    """The first value that differs; the hash, if only that differs."""
    return next(_differences(recorded, now, field), Difference("hash", "another", "the same values"))


def _differences(recorded: Any, now: Any, field: str) -> Iterator[Difference]:
    if isinstance(recorded, dict) and isinstance(now, dict):
        for key in [*recorded, *(key for key in now if key not in recorded)]:
            inner = f"{field}.{key}" if field else key
            yield from _differences(recorded.get(key), now.get(key), inner)
    elif isinstance(recorded, list) and isinstance(now, list):
        for index in range(max(len(recorded), len(now))):
            before, after = (each[index] if index < len(each) else None for each in (recorded, now))
            yield from _differences(before, after, f"{field}[{index}]{_kind(before, after)}")
    elif repr(recorded) != repr(now):
        yield Difference(field, recorded, now)


def _kind(*pair: Any) -> str:
    """The type that both messages have, in brackets; "" if they differ."""
    kinds = {each.get(TYPE) if isinstance(each, dict) else None for each in pair}
    kind = kinds.pop()
    return f" ({kind})" if kind and not kinds else ""
