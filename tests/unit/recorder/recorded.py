"""Plants with a recorder beside each, as running plants have it, but that time is moved by hand."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import pytest

from arboleda.core.plant import Plant
from arboleda.model.plant_model import PlantModel
from arboleda.recorder import recorder as thread
from arboleda.recorder.files import FOLDER, parts_in
from arboleda.recorder.preamble import Beginning, Limits, PlantFiles
from arboleda.recorder.recorder import Recorder
from arboleda.recorder.ros_log import RosLog
from arboleda.recorder.writing import Writing
from arboleda.simulator import world
from arboleda.testing.plants import shipped
from arboleda.testing.rig import Rig
from arboleda.views import twin_view, view

from ...patience import PATIENCE_S

CONTENTS = {"plant.yaml": b"name: arboleda\n", "lib/own.py": b"\x00\xff"}
FILES = PlantFiles(plant="plant.yaml", contents=CONTENTS)
DEFAULT = Limits()


def with_everything(path: Path, patch: pytest.MonkeyPatch) -> Site:
    """One whose records have all channels, as those of running plants."""
    patch.setattr(thread, "SHARE", 1e9)  # time runs faster here than on clocks
    return Site(path, patch, logs=[RosLog(shipped())])


def beginning_of(model: PlantModel, *, epoch: int = 7, now: float = 0.0, **made_of: Any) -> Beginning:
    return Beginning(
        plant=model.name,
        version="0.1.0",
        epoch=epoch,
        now=now,
        rate=1.0,
        virtual=False,
        memory={fact: dict(kept) for fact, kept in (made_of.get("memory") or {}).items()},
        kept=tuple(made_of.get("kept", ())),
        files=FILES,
    )


class Told(Writing):
    """One that tells the test's thread when it has written what waited, or has given up."""

    wrote: threading.Condition

    def tend(self) -> None:
        super().tend()
        self._tell()

    def drop(self) -> None:
        super().drop()
        self._tell()

    def _tell(self) -> None:
        with self.wrote:
            self.wrote.notify_all()


class Site:
    """A rig of which every start of the plant is recorded; `folder` has the files, once it has ended."""

    def __init__(
        self, path: Path, patch: pytest.MonkeyPatch, limits: Limits = DEFAULT, **options: Any
    ) -> None:
        self.folder = path / FOLDER
        self.model: PlantModel = shipped()
        self.recorders: list[Recorder] = []
        self.seen: list[tuple[int, dict[str, Any], dict[str, Any]]] = []  # when, what screens and twin got
        self._wrote = threading.Condition()
        self._limits = limits
        self._options = options
        patch.setattr(world, "Plant", self._new)
        patch.setattr(
            thread, "PATIENCE_S", PATIENCE_S
        )  # a record is wanted whole here, on a busy machine too
        self.rig = Rig(self.model)

    @property
    def files(self) -> list[Path]:
        return [part.path for part in parts_in(self.folder)]

    def work(self, *texts: str, s: float = 60.0) -> None:
        for text in texts:
            self.rig.submit(text)
        self.rig.wait(s)

    def until(self, condition: Callable[[], object], what: str) -> None:
        """Wait for the recorder's thread."""
        with self._wrote:
            assert self._wrote.wait_for(condition, PATIENCE_S), what

    def end(self) -> None:
        for recorder in self.recorders:
            recorder.stop()

    def _new(self, model: PlantModel, **made_of: Any) -> Plant:
        plant = Plant(model, **made_of)
        beginning = beginning_of(model, **made_of)
        unix_ns = lambda: round(plant.now * 1e9)  # noqa: E731
        options = {"least_free": 0, **self._options}
        writing = Told(self.folder, beginning, self._limits, unix_ns=unix_ns, **options)
        writing.wrote = self._wrote
        recorder = Recorder(writing, unix_ns)
        self.recorders.append(recorder)
        recorder.start()
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
