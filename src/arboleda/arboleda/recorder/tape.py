"""Record of a simulated plant: each step goes to a listener, or is kept in memory."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import Any

from arboleda import __version__
from arboleda.engine import Plant
from arboleda.model.messages import Event
from arboleda.model.plant_files import NO_FILES, PlantFiles
from arboleda.model.plant_model import PlantModel

from .preamble import Beginning
from .state import state_of
from .steps import RecordedStep, Step, hash_of, outcome

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
