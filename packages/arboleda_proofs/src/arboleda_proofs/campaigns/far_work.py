"""Work of a campaign for other hosts: it travels with its plants' files; workers of Dask do its runs."""

from __future__ import annotations

import pickle
import time
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from io import BytesIO
from typing import Any, Generic

import cloudpickle
import yaml
from distributed import get_worker

from arboleda.extension import ArboledaError
from arboleda.model.plant_files import PlantFiles

from .campaign import R, Runs, SoFar
from .plant_reading import read_from
from .plants import Plant
from .same_code import code, difference, packages
from .workers import collect_rarely

PARTS = ("declared", "model", "files")  # of a plant: they do not travel, but are made anew from its files
MOST = 8  # campaigns for which a worker is ready, and plants that it has read
TELLS_EVERY_S = 1.0
Name = tuple[int, str]  # of a part of a plant: the plant's number, the part


@dataclass(frozen=True, kw_only=True)
class Done(Generic[R]):
    """Results of a portion of runs, how much was simulated for them, and how long that took."""

    results: Sequence[R]
    passed: SoFar
    seconds: float


class Abandoned(BaseException):
    """Raised in a run that nobody waits for any more; an Exception would be blamed on the plant."""


def packed(runs: Runs[Any], plants: Sequence[Plant]) -> bytes:
    """The runs as bytes, with the code that they need and the files of their plants."""
    content = BytesIO()
    packer = _Packer(content, plants)
    packer.dump(runs)
    used = {word.partition(".")[0] for plant in plants for word in _modules(plant.files)}
    ours = code(packages(packer.packages | used))
    return pickle.dumps((ours, [pickle.dumps(plant.files) for plant in plants], content.getvalue()))


def prepare(name: str, work: bytes) -> str:
    """Make this worker ready for the runs of a campaign. Return why it cannot be, or ""."""
    ours, files, content = pickle.loads(work)
    if unlike := difference(ours, code(frozenset(each.partition("/")[0] for each in ours if "/" in each))):
        return unlike
    try:
        plants = [_plant(each) for each in files]
    except ArboledaError as error:
        return f"cannot read the plant: {error}"
    while len(_ready) >= MOST:
        _ready.pop(next(iter(_ready)), None)
    _ready[name] = _Unpacker(BytesIO(content), plants).load()
    collect_rarely()
    return ""


def run(name: str, number: int, seeds: Sequence[int]) -> Done[Any] | None:
    """Do a portion of the runs of a campaign; None where this worker is not ready for that."""
    runs = _ready.get(name)
    if runs is None:
        return None
    telling, began = _Telling(name, number), time.monotonic()
    results = [runs.run(seed, tick=telling) for seed in seeds]
    return Done(results=results, passed=telling.so_far, seconds=time.monotonic() - began)


class _Telling:
    """Tells how much of a portion was simulated so far, and ends it where nobody waits for it any more."""

    def __init__(self, name: str, number: int) -> None:
        self.so_far = SoFar()
        self._name, self._number, self._due = name, number, 0.0
        self._worker = get_worker()
        self._task = self._worker.get_current_task()

    def __call__(self, minutes: int = 1, cycles: int = 0, faults: int = 0, /) -> None:
        self.so_far = self.so_far.and_(minutes, cycles, faults)
        if (now := time.monotonic()) >= self._due:
            self._due = now + TELLS_EVERY_S
            self._worker.log_event(self._name, [self._number, *self.so_far])
            task = self._worker.state.tasks.get(self._task)
            if task is None or task.state == "cancelled":
                raise Abandoned


class _Packer(cloudpickle.Pickler):  # type: ignore[misc]  # it has no types
    """Packs names of the parts of plants in place of the parts; `packages` are those of what it packed."""

    def __init__(self, file: BytesIO, plants: Sequence[Plant]) -> None:
        super().__init__(file)
        self.packages: set[str] = set()
        self._names: dict[int, Name] = {
            id(getattr(plant, part)): (number, part) for number, plant in enumerate(plants) for part in PARTS
        }

    def persistent_id(self, packed: object) -> Name | None:
        if isinstance(packed, type):
            self.packages.add(packed.__module__.partition(".")[0])
        return self._names.get(id(packed))


class _Unpacker(pickle.Unpickler):
    """Puts the parts of plants in place of their names."""

    def __init__(self, file: BytesIO, plants: Sequence[Plant]) -> None:
        super().__init__(file)
        self._plants = plants

    def persistent_load(self, name: Name) -> object:
        number, part = name
        return getattr(self._plants[number], part)


@lru_cache(maxsize=MOST)
def _plant(pickled: bytes) -> Plant:
    files: PlantFiles = pickle.loads(pickled)
    return Plant(declared=read_from(files), files=files)


def _modules(files: PlantFiles) -> Iterator[str]:
    """The installed modules that a plant file uses."""
    with suppress(KeyError, yaml.YAMLError):
        content = yaml.safe_load(files.contents[files.plant])
        yield from (each for each in content.get("uses", ()) if "/" not in each and not each.endswith(".py"))


_ready: dict[str, Runs[Any]] = {}  # by the name of the campaign
