"""Plants with a recorder beside each, as running plants have it, but that time is moved by hand."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pytest

from arboleda.core.plant import Plant
from arboleda.model.plant_model import PlantModel
from arboleda.recorder.beginning import Beginning, Limits, PlantFiles
from arboleda.recorder.files import FOLDER, parts_in
from arboleda.recorder.recorder import Recorder
from arboleda.simulator import world
from arboleda.testing.plants import shipped
from arboleda.testing.rig import Rig

CONTENTS = {"plant.yaml": b"name: arboleda\n", "lib/own.py": b"\x00\xff"}
FILES = PlantFiles(plant="plant.yaml", contents=CONTENTS)
DEFAULT = Limits()


class Site:
    """A rig of which every start of the plant is recorded; `folder` has the files, once it has ended."""

    def __init__(
        self, path: Path, patch: pytest.MonkeyPatch, limits: Limits = DEFAULT, **options: Any
    ) -> None:
        self.folder = path / FOLDER
        self.model: PlantModel = shipped()
        self.recorders: list[Recorder] = []
        self._limits = limits
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

    def _new(self, model: PlantModel, **made_of: Any) -> Plant:
        plant = Plant(model, **made_of)
        beginning = Beginning(
            plant=model.name,
            version="0.1.0",
            epoch=made_of["epoch"],
            now=made_of["now"],
            rate=1.0,
            virtual=False,
            memory={fact: dict(kept) for fact, kept in (made_of.get("memory") or {}).items()},
            kept=tuple(made_of.get("kept", ())),
            files=FILES,
        )
        options = {"unix_ns": lambda: round(plant.now * 1e9), "least_free": 0, **self._options}
        recorder = Recorder(self.folder, beginning, self._limits, **options)
        self.recorders.append(recorder)
        recorder.start()
        step = plant.step

        def recorded(now: float, events: Iterable[Any]) -> list[Any]:
            events = tuple(events)
            messages = step(now, events)
            recorder.stepped(plant, now, events, tuple(messages))
            return messages

        plant.step = recorded  # type: ignore[method-assign]
        return plant
