"""A world under watch: the sentences that some invariants yield in it, step by step."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from arboleda.model.messages import Verb
from arboleda.model.plant_model import PlantModel
from arboleda.rig.world import World
from arboleda.testing import shipped
from arboleda_proofs.simulator.invariants import Invariant
from arboleda_proofs.simulator.invariants.invariant import Judges, Look
from arboleda_proofs.simulator.record import Record
from arboleda_proofs.simulator.truth.truth import Truth


class Watched:
    """A world that has been on for half a second; `found`: what was said since, by the invariant."""

    def __init__(
        self, invariants: Iterable[Invariant], model: PlantModel | None = None, **world: Any
    ) -> None:
        self.world = World(model or shipped("sis_a"), **world)
        self.truth, self.record = Truth(self.world), Record(self.world)
        self.look = Look(world=self.world, truth=self.truth, record=self.record)
        self.found: dict[str, list[str]] = {}
        self._judges = Judges(invariants)
        self.world.watchers.append(self._check)
        self.wait(0.5)

    def wait(self, seconds: float, until: Callable[[], bool] = lambda: False) -> None:
        self.world.advance(seconds, until)

    def task(self, text: str, wait_s: float) -> None:
        self.world.request_task(text)
        self.wait(wait_s)

    def verb(self, verb: Verb, scope: str = "", wait_s: float = 1.0) -> None:
        self.world.request_verb(verb, scope)
        self.wait(wait_s)

    def end(self) -> None:
        """Look at what must hold once everything is at rest."""
        self._note(self._judges.at_the_end(self.look))

    def _check(self) -> None:
        self.truth.look()
        self.record.look()
        self._note(self._judges.after_a_step(self.look))

    def _note(self, breaches: Iterable[tuple[str, str]]) -> None:
        for name, sentence in breaches:
            self.found.setdefault(name, []).append(sentence)
