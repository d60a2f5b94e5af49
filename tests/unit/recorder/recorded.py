"""Plants with a recorder beside each, as running plants have it, but that time is moved by hand."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, Protocol

import pytest

from arboleda.core.plant import Plant
from arboleda.model.plant_files import PlantFiles
from arboleda.model.plant_model import PlantModel
from arboleda.model.recording import Limits
from arboleda.recorder.files import FOLDER, parts_in
from arboleda.recorder.preamble import Beginning
from arboleda.recorder.state import state_of
from arboleda.recorder.steps import Step
from arboleda.recorder.view_log import ViewSnapshot
from arboleda.recorder.writing import Writing, ros_logs
from arboleda.rig import world
from arboleda.rig.rig import Rig
from arboleda.testing.plants import shipped
from arboleda.views import twin_view, view

CONTENTS = {"plant.yaml": b"name: arboleda\n", "lib/own.py": b"\x00\xff"}
FILES = PlantFiles(plant="plant.yaml", contents=CONTENTS)
DEFAULT = Limits()


def with_everything(path: Path, patch: pytest.MonkeyPatch) -> Site:
    """One whose records have all channels, as those of running plants."""
    return Site(path, patch, logs=ros_logs(shipped()))


def beginning_of(
    model: PlantModel,
    *,
    files: PlantFiles = FILES,
    rate: float = 1.0,
    epoch: int = 7,
    now: float = 0.0,
    **made_of: Any,
) -> Beginning:
    return Beginning(
        plant=model.name,
        version="0.1.0",
        epoch=epoch,
        now=now,
        rate=rate,
        virtual=False,
        memory={fact: dict(kept) for fact, kept in (made_of.get("memory") or {}).items()},
        kept=tuple(made_of.get("kept", ())),
        files=files,
    )


class OfAStart(Protocol):
    """What hears of each step of a plant, as a `Recorder` does."""

    def stepped(self, plant: Plant, now: float, events: Sequence[Any], messages: Sequence[Any]) -> None: ...

    def saw(self, snapshot: dict[str, Any], drawn: dict[str, Any]) -> None: ...

    def stop(self) -> None: ...


class AtOnce:
    """A recorder that has written a step before the next one begins."""

    def __init__(self, writing: Writing) -> None:
        self._writing = writing
        self._turn = self._now_ns = 0
        writing.open()

    def stepped(self, plant: Plant, now: float, events: Sequence[Any], messages: Sequence[Any]) -> None:
        self._turn += 1
        self._now_ns = round(now * 1e9)
        self._put(Step(self._now_ns, now, events, messages, state_of(plant, self._turn)))

    def saw(self, snapshot: dict[str, Any], drawn: dict[str, Any]) -> None:
        self._put(ViewSnapshot(self._now_ns, snapshot, drawn))

    def stop(self) -> None:
        self._writing.close()

    def _put(self, item: Step | ViewSnapshot) -> None:
        for _ in self._writing.put(item):
            pass
        self._writing.tend()


class Site:
    """A rig of which every start of the plant is recorded; `folder` has the files."""

    def __init__(
        self,
        path: Path,
        patch: pytest.MonkeyPatch,
        limits: Limits = DEFAULT,
        *,
        files: PlantFiles = FILES,
        rate: float = 1.0,
        **options: Any,
    ) -> None:
        self.folder = path / FOLDER
        self.model: PlantModel = shipped()
        self.recorders: list[Any] = []
        self.seen: list[tuple[int, dict[str, Any], dict[str, Any]]] = []  # when, what screens and twin got
        self._limits = limits
        self._begun_with = {"files": files, "rate": rate}
        self._options = options
        patch.setattr(world, "Plant", self._new)
        self.rig = Rig(self.model)

    @property
    def files(self) -> list[Path]:
        return [part.path for part in parts_in(self.folder)]

    def work(self, *texts: str, s: float = 60.0) -> None:
        for text in texts:
            self.rig.submit(text)
        self.rig.wait(s)

    def end(self) -> None:
        for recorder in self.recorders:
            recorder.stop()

    def recorder(self, plant: Plant, writing: Writing) -> OfAStart:
        """What hears of the steps of this start."""
        return AtOnce(writing)

    def _new(self, model: PlantModel, **made_of: Any) -> Plant:
        plant = Plant(model, **made_of)
        beginning = beginning_of(model, **self._begun_with, **made_of)
        options = {"least_free": 0, "unix_ns": lambda: round(plant.now * 1e9), **self._options}
        recorder = self.recorder(plant, Writing(self.folder, beginning, self._limits, **options))
        self.recorders.append(recorder)
        step, shown = plant.step, -1

        def recorded(now: float, events: Iterable[Any]) -> list[Any]:
            nonlocal shown
            events = tuple(events)
            messages = step(now, events)
            recorder.stepped(plant, now, events, tuple(messages))
            if plant.version != shown:
                shown, pictures = plant.version, (view.snapshot(plant), twin_view.positions(plant))
                self.seen.append((round(now * 1e9), *pictures))
                recorder.saw(*pictures)
            return messages

        plant.step = recorded  # type: ignore[method-assign]
        return plant
