"""A record that is kept in memory: what simulated plants did, for whatever reads records."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from arboleda import __version__
from arboleda.core.plant import Plant
from arboleda.model.messages import Event
from arboleda.model.plant_model import PlantModel

from .beginning import Beginning, PlantFiles
from .state import state_of
from .steps import Recorded, Step, hash_of, outcome

NO_FILES = PlantFiles(plant="plant.yaml")


def began(model: PlantModel, files: PlantFiles, **made_of: Any) -> Beginning:
    """What the record of a simulated plant begins with."""
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
    )


class TapedPlant(Plant):
    """A plant that keeps what each of its steps was made of and what it did."""

    def __init__(self, model: PlantModel, *, files: PlantFiles = NO_FILES, **made_of: Any) -> None:
        super().__init__(model, **made_of)
        self.tape: list[Step] = []
        self.beginning = began(model, files, **made_of)

    def step(self, now: float, events: Iterable[Event]) -> list[Any]:
        events = tuple(events)
        messages = super().step(now, events)
        state = state_of(self, len(self.tape) + 1)
        self.tape.append(Step(round(now * 1e9), now, events, tuple(messages), state))
        return messages

    def steps(self) -> Iterator[Recorded]:
        """All of them, as they are read from a file; their Unix time is the plant's own."""
        for step in self.tape:
            said = outcome(step.messages, step.state)
            yield Recorded(step.unix_ns, step.now, tuple(step.events), said, hash_of(said))
