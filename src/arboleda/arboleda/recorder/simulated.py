"""The record of a simulated plant: written in its own time, step by step, with all that a real one has."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from arboleda.core.plant import Plant
from arboleda.model.messages import Event
from arboleda.model.plant_model import PlantModel
from arboleda.views import twin_view, view

from .beginning import Limits, PlantFiles
from .ros_log import RosLog
from .state import state_of
from .steps import Step
from .tape import began
from .view_log import Seen
from .writing import Writing

SECOND = 1_000_000_000


class SimulatedRecorder:
    """Makes the plants of a world (`World(make_plant=...)`), each start with a record of its own in `folder`.

    `began_ns` is what the clock on the wall says where the world's time is 0.
    """

    def __init__(self, folder: Path, files: PlantFiles, limits: Limits, began_ns: int = 0) -> None:
        self._folder = folder
        self._files = files
        self._limits = limits
        self._began_ns = began_ns
        self._now = 0.0
        self._shown = self._turn = -1
        self._writing: Writing | None = None

    def plant(self, model: PlantModel, **made_of: Any) -> Plant:
        """The plant of a start that begins now; the record of the one before ends."""
        self.close()
        self._now, self._shown, self._turn = made_of["now"], -1, 0
        beginning = began(model, self._files, **made_of)
        logs = [RosLog(model)]
        self._writing = Writing(self._folder, beginning, self._limits, logs, unix_ns=self._unix_ns)
        self._writing.open()
        return _Recorded(self, model, made_of)

    def stepped(self, plant: Plant, now: float, events: Sequence[Event], messages: Sequence[Any]) -> None:
        """Write a step, and what screens would see after it."""
        self._now, self._turn = now, self._turn + 1
        self._put(Step(self._unix_ns(), now, events, messages, state_of(plant, self._turn)))
        if plant.version != self._shown:
            self._shown = plant.version
            self._put(Seen(self._unix_ns(), view.snapshot(plant), twin_view.positions(plant)))

    def close(self) -> None:
        """End the record. Idempotent."""
        if self._writing is not None:
            self._writing.close()
            self._writing = None

    def _put(self, item: Step | Seen) -> None:
        assert self._writing is not None
        for _ in self._writing.put(item):
            pass
        self._writing.tend()

    def _unix_ns(self) -> int:
        return self._began_ns + round(self._now * SECOND)


class _Recorded(Plant):
    """A plant that tells of each of its steps."""

    def __init__(self, recorder: SimulatedRecorder, model: PlantModel, made_of: dict[str, Any]) -> None:
        super().__init__(model, **made_of)
        self._recorder = recorder

    def step(self, now: float, events: Iterable[Event]) -> list[Any]:
        events = tuple(events)
        messages = super().step(now, events)
        self._recorder.stepped(self, now, events, tuple(messages))
        return messages
