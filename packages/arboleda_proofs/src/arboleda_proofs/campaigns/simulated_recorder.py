"""Record of a simulated plant, written step by step as a real one has it, or kept in memory."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

from arboleda import __version__
from arboleda.engine import Plant
from arboleda.model.messages import Event
from arboleda.model.plant_files import NO_FILES, PlantFiles
from arboleda.model.plant_model import PlantModel
from arboleda.model.recording import Limits
from arboleda.recorder.preamble import Beginning
from arboleda.recorder.state import state_of
from arboleda.recorder.steps import RecordedStep, Step, hash_of, outcome
from arboleda.recorder.view_log import ViewSnapshot
from arboleda.recorder.writing import Writing, ros_logs
from arboleda.views import twin_view, view

SECOND = 1_000_000_000


class RecordingPlant(Plant):
    """Simulated plant that reports each of its steps, with its events and results, to `tell`.

    `beginning` is the first message of a record of it; `began_ns` the Unix time at which its own clock is 0.
    """

    def __init__(
        self,
        model: PlantModel,
        *,
        tell: Callable[[Step], None],
        files: PlantFiles = NO_FILES,
        began_ns: int = 0,
        **made_of: Any,
    ) -> None:
        super().__init__(model, **made_of)
        self.beginning = _began(model, files, **made_of)
        self._tell = tell
        self._began_ns = began_ns
        self._turn = 0

    def step(self, now: float, events: Iterable[Event]) -> list[Any]:
        events = tuple(events)
        messages = super().step(now, events)
        self._turn += 1
        unix_ns = self._began_ns + round(now * SECOND)
        self._tell(Step(unix_ns, now, events, tuple(messages), state_of(self, self._turn)))
        return messages


class TapedPlant(RecordingPlant):
    """Simulated plant that keeps its steps in memory."""

    def __init__(self, model: PlantModel, *, files: PlantFiles = NO_FILES, **made_of: Any) -> None:
        self.tape: list[Step] = []
        super().__init__(model, tell=self.tape.append, files=files, **made_of)


def recorded(tape: Iterable[Step]) -> Iterator[RecordedStep]:
    """The steps of a tape, as if read from a file; their Unix time is the plant's own."""
    for step in tape:
        result = outcome(step.messages, step.state)
        yield RecordedStep(step.unix_ns, step.now, tuple(step.events), result, hash_of(result))


def _began(model: PlantModel, files: PlantFiles, **made_of: Any) -> Beginning:
    return Beginning(
        plant=model.name,
        version=__version__,
        epoch=made_of["epoch"],
        now=made_of["now"],
        rate=1.0,
        virtual=False,
        memory={fact: dict(kept) for fact, kept in (made_of.get("memory") or {}).items()},
        kept=tuple(made_of.get("kept", ())),
        files=files,
        simulated=True,
    )


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
        logs = ros_logs(plant.model)
        self._writing = Writing(
            self._folder, plant.beginning, self._limits, logs, unix_ns=lambda: self._now_ns
        )
        self._writing.open()
        return self._writing

    def _put(self, writing: Writing, item: Step | ViewSnapshot) -> None:
        for _ in writing.put(item):
            pass
        writing.tend()
