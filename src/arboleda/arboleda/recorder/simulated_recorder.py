"""Record of a simulated plant, written step by step, with everything that a real one has."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

from arboleda.engine import Plant
from arboleda.model.plant_files import PlantFiles
from arboleda.model.plant_model import PlantModel
from arboleda.model.recording import Limits
from arboleda.views import twin_view, view

from .ros_log import RosLog
from .steps import Step
from .tape import SECOND, RecordingPlant
from .view_log import ViewSnapshot
from .writing import Writing


class RecordNotWritten(BaseException):
    """Error: the record cannot be written, as `error` says; an Exception would be blamed on the plant."""

    def __init__(self, error: OSError) -> None:
        self.error = error


class SimulatedRecorder:
    """Makes the plants of a world (`World(make_plant=...)`), each start with a record of its own in `folder`.

    A start that never made a step has none. `began_ns` is what the clock on the wall says where the world's
    time is 0. RecordNotWritten leaves a step that cannot be written.
    """

    def __init__(self, folder: Path, files: PlantFiles, limits: Limits, began_ns: int = 0) -> None:
        self._folder = folder
        self._files = files
        self._limits = limits
        self._began_ns = began_ns
        self._now_ns = began_ns
        self._shown = -1
        self._plant: RecordingPlant | None = None
        self._writing: Writing | None = None

    def plant(self, model: PlantModel, **made_of: Any) -> Plant:
        """A plant for a start that begins now; the record of the start before ends."""
        self.close()
        self._now_ns, self._shown = self._began_ns + round(made_of["now"] * SECOND), -1
        make = partial(RecordingPlant, tell=self._stepped, files=self._files, began_ns=self._began_ns)
        self._plant = make(model, **made_of)
        return self._plant

    def close(self) -> None:
        """End the record. Idempotent."""
        if self._writing is not None:
            self._writing.close()
            self._writing = None

    def _stepped(self, step: Step) -> None:
        """Write a step, and the views that screens would have after it."""
        plant = self._plant
        assert plant is not None
        try:
            writing = self._writing or self._opened(plant)
            self._now_ns = step.unix_ns
            self._put(writing, step)
            if plant.version != self._shown:
                self._shown = plant.version
                self._put(
                    writing, ViewSnapshot(step.unix_ns, view.snapshot(plant), twin_view.positions(plant))
                )
        except OSError as error:
            raise RecordNotWritten(error) from error

    def _opened(self, plant: RecordingPlant) -> Writing:
        logs = [RosLog(plant.model)]
        self._writing = Writing(
            self._folder, plant.beginning, self._limits, logs, unix_ns=lambda: self._now_ns
        )
        self._writing.open()
        return self._writing

    def _put(self, writing: Writing, item: Step | ViewSnapshot) -> None:
        for _ in writing.put(item):
            pass
        writing.tend()
