"""A plant that starts again on what the one before it had kept, in a rig."""

from __future__ import annotations

from typing import Any

from arboleda.core.plant import Plant
from arboleda.model.messages import Fact, Failure, Heartbeat, KeptTask, TaskChanged, TaskState
from arboleda.model.plant_model import PlantModel
from arboleda.rig.world import PLANT
from arboleda.testing import Rig

ENDED = (TaskState.DONE, TaskState.FAILED, TaskState.CANCELLED)


def kept(rig: Rig) -> list[KeptTask]:
    """The rows of the tasks, as they were told."""
    rows: dict[str, TaskChanged] = {each.task: each for each in rig.changes if each.task}
    return [
        KeptTask(
            id=each.task,
            text=each.text,
            cell=each.cell or "",
            state=each.state,
            failure=Failure(reason=each.reason, sentence=each.sentence) if each.reason else None,
            ended_at=rig.now if each.state in ENDED else None,
        )
        for each in rows.values()
    ]


def restart(rig: Rig, model: PlantModel | None = None, *, bridge: bool = True, after_s: float = 0.0) -> None:
    """Kill the plant, with its bridge where that is in its process; `after_s` later the next one starts."""
    if after_s:
        rig.stall(PLANT, 2 * after_s)
        if bridge:
            rig.stop_bridge()
        rig.wait(after_s)
    rig.model = model or rig.model
    rig.plant = Plant(
        rig.model, epoch=rig.plant.epoch + 1000, now=rig.now, memory=rig.disk.facts, kept=kept(rig)
    )
    if bridge:
        rig.stop_bridge()
        rig.start_bridge()
    rig.go_on(PLANT)
    rig.wake(PLANT)
    rig.settle()


def crash_without_trail(rig: Rig) -> None:
    """The plant dies, and where its tasks stood was not kept: they have failed."""
    rig.disk.facts.pop(Fact.STEP, None)
    rig.crash()


class Mortal:
    """The plant of a rig, which dies once so many of its messages have left, and says nothing any more."""

    def __init__(self, rig: Rig, messages: int) -> None:
        self.left = messages
        self._step = rig.plant.step
        rig.plant.step = self._dying  # type: ignore[method-assign]

    @property
    def is_dead(self) -> bool:
        return self.left <= 0

    def _dying(self, now: float, events: Any) -> list[Any]:
        out: list[Any] = []
        for message in [] if self.is_dead else self._step(now, events):
            if self.is_dead:
                break
            out.append(message)
            self.left -= not isinstance(message, Heartbeat)
        return out
