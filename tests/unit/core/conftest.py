from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from arboleda.core.plant import Plant
from arboleda.model.messages import (
    MotionState,
    OperatorRequest,
    Report,
    TaskChanged,
    TaskRequest,
    Uncontested,
    Verb,
)
from arboleda.model.plant_model import Evidence, PlantModel
from arboleda.testing import shipped
from arboleda.testing.storage_layout import StorageLayout


class Hand:
    """One plant driven by hand: every report is typed, every second is moved."""

    def __init__(self, model: PlantModel) -> None:
        self.now = 100.0
        self.plant = Plant(model, epoch=7, now=self.now)
        self.out: list[Any] = []
        self._step([])

    def _step(self, events: list[Any]) -> list[Any]:
        out = self.plant.step(self.now, events)
        self.out += out
        assert self.plant.sleepers() == []
        return out

    def submit(self, text: str, **asked: Any) -> list[Any]:
        return self._step([TaskRequest(at=self.now, text=text, **asked)])

    def operate(self, verb: Verb, scope: str, *, by_hand: bool = False) -> list[Any]:
        return self._step([OperatorRequest(at=self.now, verb=verb, scope=scope, by_hand=by_hand)])

    def tell(self, robot: str, after: float = 0.05, **said: Any) -> list[Any]:
        until = self.now + after
        while self.plant.next_deadline < until:  # the plant beats: one that does not was away
            self.now = max(self.now, self.plant.next_deadline)
            self._step([])
        self.now = until
        return self._step([Report(at=self.now, robot=robot, **said)])

    def uncontested(self, robot: str, *said: MotionState) -> list[Any]:
        """One node is left that speaks for a robot; `said` were states meanwhile."""
        return self._step([Uncontested(at=self.now, robot=robot, said=said)])

    def wait(self, seconds: float) -> list[Any]:
        """Let time pass, deadline by deadline, with nobody saying anything."""
        until, out = self.now + seconds, []
        while self.plant.next_deadline <= until:
            self.now = max(self.now, self.plant.next_deadline)
            out += self._step([])
        self.now = until
        return out

    def awake(self, **standing: tuple[float, ...]) -> None:
        """Have every robot report that it stands still, at home unless `standing` says where."""
        for cell in self.plant.model.cells:
            layout = StorageLayout(cell)
            self._awake(layout.arm.name, q=standing.get(layout.arm.name, layout.home.q))
            self._awake(layout.mobile.name, node=0)

    def _awake(self, robot: str, **where: Any) -> None:
        by_ids = self.plant.model.robots[robot].evidence is Evidence.IDS
        ids = {"boot_id": 11, "homed": True} if by_ids else {}
        self.tell(robot, after=0.0, state=MotionState.STOPPED, epoch=1, plant=7, **where, **ids)

    def commands(self, kind: type) -> list[Any]:
        return [message for message in self.out if isinstance(message, kind)]

    def states(self) -> list[str]:
        return [message.state.value for message in self.commands(TaskChanged)]


@pytest.fixture
def hand() -> Callable[..., Hand]:
    """A hand-driven plant whose robots all prove what `evidence` says, and are as `given`."""
    return lambda evidence, **given: Hand(shipped(evidence=evidence, **given))
